#include "udar/mesh/blocks.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/mesh/test_meshes.hpp"
#include "udar/mesh/generators.hpp"
#include "udar/mesh/renumber.hpp"

using namespace udar;

namespace {

using Triangle = std::array<Index, 3>;

/// A row of triangles, each of which shares a side with the next one; their first corners differ.
Mesh strip(Index count) {
  Mesh mesh;
  for (Index i = 0; i < count + 2; ++i) {
    mesh.nodes.push_back({0.5 * i, static_cast<double>(i % 2)});
    mesh.node_numbers.push_back(i);
  }
  for (Index t = 0; t < count; ++t) {
    Triangle corners{t, t + 2 - t % 2, t + 1 + t % 2};
    std::rotate(corners.begin(), corners.begin() + t % 3, corners.end());
    mesh.triangles.push_back(corners);
    mesh.triangle_numbers.push_back(1000 + t);
  }
  return mesh;
}

/// Triangles that share no node.
Mesh scattered(Index count) {
  Mesh mesh;
  for (Index t = 0; t < count; ++t) {
    const double x = t;
    mesh.nodes.insert(mesh.nodes.end(), {{x, 0}, {x + 0.5, 0}, {x, 0.5}});
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    mesh.triangle_numbers.push_back(t);
  }
  return mesh;
}

bool turned_alike(Triangle a, const Triangle& b) {
  for (int k = 0; k < 3; ++k) {
    if (a == b) return true;
    std::rotate(a.begin(), a.begin() + 1, a.end());
  }
  return false;
}

/// Each triangle is there once, under its number, with its corners in the same sense.
void check_triangles(const Mesh& before, const Mesh& after) {
  REQUIRE(after.triangles.size() == before.triangles.size());
  REQUIRE(after.triangle_numbers.size() == before.triangles.size());
  std::vector<std::pair<Index, Triangle>> expected, found;
  for (std::size_t t = 0; t < before.triangles.size(); ++t) {
    expected.push_back({before.triangle_numbers[t], before.triangles[t]});
    found.push_back({after.triangle_numbers[t], after.triangles[t]});
  }
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  for (std::size_t t = 0; t < expected.size(); ++t) {
    CHECK(found[t].first == expected[t].first);
    CHECK(turned_alike(found[t].second, expected[t].second));
  }
}

/// Blocks follow one another without a gap, in whole vectors, and only the last one is padded.
void check_blocks(const MeshBlocks& cut, Index count) {
  Index element = 0, quad = 0;
  for (const ElementBlock& block : cut.blocks) {
    CHECK(block.begin == element);
    CHECK(block.quads == quad);
    CHECK(block.begin < count);
    CHECK(block.end - block.begin <= elements_per_block);
    CHECK(block.quad_count() % lanes == 0);
    if (block.paired) {
      CHECK((block.end - block.begin) % (2 * lanes) == 0);
      CHECK(block.end <= count);
    }
    element = block.end;
    quad += block.quad_count();
  }
  CHECK(element == (count + lanes - 1) / lanes * lanes);
  CHECK(cut.quads.size() == quad);
}

/// Quads have the corners of their triangles as `ElementBlock` says.
void check_quads(const MeshBlocks& cut, const Mesh& mesh) {
  for (const ElementBlock& block : cut.blocks) {
    for (Index q = 0; q < block.quad_count(); ++q) {
      const Quad& quad = cut.quads[block.quads + q];
      const auto& [a, b, c, d] = quad;
      if (block.begin + q >= mesh.triangles.size()) {
        CHECK(quad == Quad{none, none, none, none});
        continue;
      }
      CHECK(mesh.triangles[block.begin + q] == Triangle{a, b, c});
      if (block.paired) {
        CHECK(mesh.triangles[block.begin + block.quad_count() + q] == Triangle{a, d, b});
      } else {
        CHECK(d == a);
      }
    }
  }
}

/// Cuts the mesh, checks everything that holds for any mesh, and returns how many elements are in paired blocks.
Index paired_elements(const Mesh& before) {
  Mesh after = before;
  const MeshBlocks cut = cut_blocks(after);
  CHECK(after.nodes.size() == before.nodes.size());
  check_triangles(before, after);
  check_blocks(cut, static_cast<Index>(before.triangles.size()));
  check_quads(cut, after);
  Index paired = 0;
  for (const ElementBlock& block : cut.blocks) paired += block.paired ? block.end - block.begin : 0;
  return paired;
}

Mesh without_triangle(Mesh mesh, Index t) {
  mesh.triangles.erase(mesh.triangles.begin() + t);
  mesh.triangle_numbers.erase(mesh.triangle_numbers.begin() + t);
  return mesh;
}

}  // namespace

TEST_CASE("strips of any length: whole vectors of pairs, the rest alone") {
  for (Index count = 1; count <= 40; ++count) {
    CAPTURE(count);
    CHECK(paired_elements(strip(count)) == count / 2 / lanes * lanes * 2);
  }
  for (const Index count : {255U, 256U, 257U, 511U, 527U, 528U, 529U, 5000U}) {
    CAPTURE(count);
    CHECK(paired_elements(strip(count)) == count / 2 / lanes * lanes * 2);
  }
}

TEST_CASE("triangles that share no side have no pair") {
  for (const Index count : {1U, 7U, 8U, 9U, 255U, 256U, 257U, 700U}) {
    CAPTURE(count);
    CHECK(paired_elements(scattered(count)) == 0);
  }
}

TEST_CASE("no triangle, no block") {
  Mesh mesh;
  const MeshBlocks cut = cut_blocks(mesh);
  CHECK(cut.blocks.empty());
  CHECK(cut.quads.empty());
}

TEST_CASE("triangles on the same side of the side they share are no pair") {
  Mesh mesh{.nodes = {{0, 0}, {1, 0}, {0, 1}, {0, 2}}, .triangles = {}};
  for (Index t = 0; t < 16; ++t) {
    mesh.triangles.push_back(t % 2 == 0 ? Triangle{0, 1, 2} : Triangle{0, 1, 3});
    mesh.triangle_numbers.push_back(t);
  }
  CHECK(paired_elements(mesh) == 0);
}

TEST_CASE("pairs and single triangles of real meshes") {
  using Diagonals = RectangleMesh::Diagonals;
  for (const Diagonals cut : {Diagonals::right, Diagonals::alternating, Diagonals::crossed}) {
    const Mesh mesh = renumber(generate(RectangleMesh{.size = {4, 1}, .element_size = 0.05, .diagonals = cut}));
    CHECK(paired_elements(mesh) == mesh.triangles.size());
  }
  const MeshShape ring = RingMesh{.outer_radius = 1, .inner_radius = 0.5, .element_size = 0.04};
  const MeshShape disc = DiscMesh{.radius = 1, .element_size = 0.04};
  for (const Mesh& mesh :
       {renumber(generate(ring)), renumber(generate(disc)),
        renumber(unstructured({.size = {3, 2}, .element_size = 0.1})), generate(disc), shuffled(generate(disc))}) {
    paired_elements(mesh);
    // An odd number of triangles, in the sweep's order and out of it.
    const auto middle = static_cast<Index>(mesh.triangles.size() / 2);
    paired_elements(without_triangle(mesh, middle));
    paired_elements(without_triangle(mesh, 0));
  }
}

TEST_CASE("single triangles among pairs do not wait for the end of a long mesh") {
  // Strips of three: one pair and one single each. A node is summed when its last element is done, so the singles of
  // the first thousand triangles must not stand behind those of the last.
  Mesh mesh;
  for (Index s = 0; s < 2000; ++s) {
    const Mesh piece = strip(3);
    const auto first = static_cast<Index>(mesh.nodes.size());
    mesh.nodes.insert(mesh.nodes.end(), piece.nodes.begin(), piece.nodes.end());
    for (const Triangle& t : piece.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  mesh.triangle_numbers.resize(mesh.triangles.size());
  std::iota(mesh.triangle_numbers.begin(), mesh.triangle_numbers.end(), Index{0});
  CHECK(paired_elements(mesh) == 2000U * 2);
  cut_blocks(mesh);
  Index farthest = 0;
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    const Index number = mesh.triangle_numbers[t];
    farthest = std::max(farthest, number > t ? number - t : t - number);
  }
  // A paired block takes 128 pieces of three triangles; what is single stands right behind it, but for half a vector.
  CHECK(farthest <= elements_per_block / 2 * 3 + lanes);
}

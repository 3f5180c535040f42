#include "udar/mesh/renumber.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/mesh/test_meshes.hpp"
#include "udar/mesh/generators.hpp"

using namespace udar;
using Diagonals = RectangleMesh::Diagonals;

namespace {

/// The longest stretch from the first to the last triangle that uses a node: what a step that passes through the mesh
/// once must keep.
std::size_t front(const Mesh& mesh) {
  std::vector<std::size_t> first(mesh.nodes.size(), mesh.triangles.size());
  std::size_t longest = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const Index node : mesh.triangles[t]) {
      first[node] = std::min(first[node], t);
      longest = std::max(longest, t - first[node]);
    }
  }
  return longest;
}

/// Couples of neighbouring nodes (a cache line holds two) that 32 triangles in a row touch, on average.
double lines_per_window(const Mesh& mesh) {
  constexpr std::size_t window = 32;
  std::size_t touched = 0;
  for (std::size_t first = 0; first < mesh.triangles.size(); first += window) {
    std::vector<Index> lines;
    for (std::size_t t = first; t < std::min(first + window, mesh.triangles.size()); ++t) {
      for (const Index node : mesh.triangles[t]) lines.push_back(node / 2);
    }
    std::sort(lines.begin(), lines.end());
    touched += static_cast<std::size_t>(std::unique(lines.begin(), lines.end()) - lines.begin());
  }
  return static_cast<double>(touched * window) / static_cast<double>(mesh.triangles.size());
}

/// Both meshes, apart from each other, as one.
Mesh together(Mesh mesh, const Mesh& other) {
  const auto shift = static_cast<Index>(mesh.nodes.size());
  mesh.nodes.insert(mesh.nodes.end(), other.nodes.begin(), other.nodes.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + shift, b + shift, c + shift});
  mesh.sides.clear();
  mesh.node_numbers.resize(mesh.nodes.size());
  std::iota(mesh.node_numbers.begin(), mesh.node_numbers.end(), Index{0});
  mesh.triangle_numbers.resize(mesh.triangles.size());
  std::iota(mesh.triangle_numbers.begin(), mesh.triangle_numbers.end(), Index{0});
  return mesh;
}

}  // namespace

TEST_CASE("renumbering changes numbers and nothing else") {
  const Mesh old = shuffled(generate(RectangleMesh{.size = {4, 1}, .element_size = 0.1}));
  const Mesh mesh = renumber(old);
  check_mesh(mesh);
  REQUIRE(mesh.nodes.size() == old.nodes.size());
  REQUIRE(mesh.triangles.size() == old.triangles.size());
  std::vector<Index> old_node(mesh.nodes.size());  // by the number that both keep
  for (Index i = 0; i < old.nodes.size(); ++i) old_node[old.node_numbers[i]] = i;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) CHECK(mesh.nodes[i] == old.nodes[old_node[mesh.node_numbers[i]]]);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      CHECK(old_node[mesh.node_numbers[mesh.triangles[t][k]]] == old.triangles[mesh.triangle_numbers[t]][k]);
    }
  }
  REQUIRE(mesh.sides.size() == 4);
  for (const Edge e : mesh.sides[2].edges) CHECK(mesh.nodes[e.a].y == 1);
}

TEST_CASE("renumbering is repeatable") {
  const Mesh mesh = generate(DiscMesh{.radius = 1, .element_size = 0.1});
  CHECK(renumber(mesh).triangles == renumber(mesh).triangles);
}

TEST_CASE("the halves of every cell stay together") {
  for (const Diagonals cut : {Diagonals::right, Diagonals::left, Diagonals::alternating, Diagonals::crossed}) {
    const Mesh mesh =
        renumber(shuffled(generate(RectangleMesh{.size = {5, 3}, .element_size = 0.1, .diagonals = cut})));
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 2) {
      CHECK(shared_nodes(mesh.triangles[t], mesh.triangles[t + 1]) == 2);
    }
  }
}

TEST_CASE("a rectangle is swept column by column along its longer side") {
  // A node between two columns of n cells is first used by the cell below it in one and last by that above it in the
  // other: n + 1 cells later, of two triangles each. In crossed cuts two columns of four triangles is the theory's
  // bound.
  const std::size_t n = 20;
  for (const Vec2 size : {Vec2{8, 2}, Vec2{2, 8}, Vec2{2, 2}}) {
    for (const double turn : {0.0, 0.4, 2.0}) {
      const auto cut = [&](Diagonals diagonals) {
        return generate(
            RectangleMesh{.size = size, .at = {3, -7}, .turn = turn, .element_size = 0.1, .diagonals = diagonals});
      };
      for (const Diagonals plain : {Diagonals::right, Diagonals::left, Diagonals::alternating}) {
        CHECK(front(renumber(cut(plain))) <= 2 * (n + 1) + 1);
      }
      CHECK(front(renumber(cut(Diagonals::crossed))) < 2 * 4 * n);
    }
  }
}

TEST_CASE("the front does not depend on how the mesh was numbered") {
  for (const Mesh& mesh :
       {generate(RectangleMesh{.size = {8, 2}, .element_size = 0.1, .diagonals = Diagonals::crossed}),
        generate(DiscMesh{.radius = 2, .element_size = 0.1}), unstructured({.size = {8, 2}, .element_size = 0.1})}) {
    const auto width = static_cast<double>(front(renumber(mesh)));
    for (const unsigned seed : {1U, 2U, 3U}) {
      CHECK(static_cast<double>(front(renumber(shuffled(mesh, seed)))) == doctest::Approx(width).epsilon(0.05));
    }
  }
}

TEST_CASE("the front of a mesh without columns is short") {
  // A node lies between two neighbouring strips of pairs, and a strip is hardly wider than a column.
  CHECK(front(renumber(unstructured({.size = {8, 2}, .element_size = 0.1}))) < 2.5 * 40);
  // The longest column of a disc of 40 rings crosses 80 of them; a ring has two arms of 10 cells.
  CHECK(front(renumber(generate(DiscMesh{.radius = 4, .element_size = 0.1}))) < 2.5 * 160);
  CHECK(front(renumber(generate(RingMesh{.outer_radius = 5, .inner_radius = 4, .element_size = 0.1}))) < 3 * 2 * 20);
  // Elements grow twentyfold from the one end to the other.
  Mesh graded = generate(RectangleMesh{.size = {8, 2}, .element_size = 0.1});
  for (Vec2& p : graded.nodes) p = (1 + 19 * p.x / 8) * Vec2{p.x / 4, p.y};
  CHECK(front(renumber(shuffled(graded))) < 2.5 * 40);
}

TEST_CASE("a body in several pieces is swept piece by piece") {
  const Mesh mesh =
      shuffled(together(generate(RectangleMesh{.size = {8, 2}, .element_size = 0.1}),
                        generate(RectangleMesh{.size = {6, 1}, .at = {1, 5}, .turn = 0.3, .element_size = 0.1})));
  const Mesh swept = renumber(mesh);
  check_mesh(swept);
  CHECK(swept.triangles.size() == mesh.triangles.size());
  CHECK(front(swept) <= 2 * 40);
}

TEST_CASE("neighbours in space are neighbours in memory") {
  // 16 cells of a column have two runs of 17 nodes: 18 lines. A random numbering has a line for nearly every use.
  const Mesh mesh = generate(RectangleMesh{.size = {16, 16}, .element_size = 0.1});
  CHECK(lines_per_window(renumber(shuffled(mesh))) < 20);
  CHECK(lines_per_window(shuffled(mesh)) > 80);
  CHECK(lines_per_window(renumber(unstructured({.size = {8, 4}, .element_size = 0.1}))) < 30);
}

TEST_CASE("corners of a node ascend and are complete") {
  const Mesh mesh = generate(RectangleMesh{.size = {1, 1}, .element_size = 0.25});
  const NodeCorners map = node_corners(mesh.nodes.size(), mesh.triangles);
  CHECK(map.corners.size() == 3 * mesh.triangles.size());
  for (Index node = 0; node < mesh.nodes.size(); ++node) {
    const auto corners = map.of(node);
    CHECK(std::is_sorted(corners.begin(), corners.end()));
    for (const auto corner : corners) CHECK(mesh.triangles[corner / 3][corner % 3] == node);
  }
}

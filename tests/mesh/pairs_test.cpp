#include "udar/mesh/pairs.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/mesh/test_meshes.hpp"
#include "udar/mesh/generators.hpp"

using namespace udar;

namespace {

std::vector<Index> pairs_of(const Mesh& mesh) {
  return pair_triangles(mesh, neighbours(mesh.triangles, node_corners(mesh.nodes.size(), mesh.triangles)));
}

/// Share of triangles without a partner; every other one must be its partner's partner and share a side with it.
double single_share(const Mesh& mesh) {
  const std::vector<Index> partner = pairs_of(mesh);
  REQUIRE(partner.size() == mesh.triangles.size());
  std::size_t single = 0;
  for (Index t = 0; t < partner.size(); ++t) {
    if (partner[t] == t) {
      ++single;
    } else {
      CHECK(partner[partner[t]] == t);
      CHECK(shared_nodes(mesh.triangles[t], mesh.triangles[partner[t]]) == 2);
    }
  }
  return static_cast<double>(single) / static_cast<double>(partner.size());
}

}  // namespace

TEST_CASE("the halves of a cell are a pair") {
  using Diagonals = RectangleMesh::Diagonals;
  for (const Diagonals cut : {Diagonals::right, Diagonals::left, Diagonals::alternating}) {
    const auto partner = pairs_of(generate(RectangleMesh{.size = {0.7, 0.5}, .element_size = 0.1, .diagonals = cut}));
    for (Index t = 0; t < partner.size(); ++t) CHECK(partner[t] == (t ^ 1U));
  }
}

TEST_CASE("a path frees the neighbours of triangles that would stay single") {
  // Four triangles in a row; the middle two share the longest side of both, which would leave the outer two alone.
  const Mesh mesh{.nodes = {{0, 0}, {1, 0}, {2, 1}, {1, 1}, {0, 0.9}, {2, 0.1}},
                  .triangles = {{0, 3, 4}, {0, 2, 3}, {0, 1, 2}, {1, 5, 2}}};
  check_mesh(mesh);
  CHECK(pairs_of(mesh) == std::vector<Index>{1, 0, 3, 2});
}

TEST_CASE("triangles without a neighbour stay single") {
  const Mesh mesh{.nodes = {{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}}, .triangles = {{0, 1, 2}, {0, 3, 4}}};
  CHECK(pairs_of(mesh) == std::vector<Index>{0, 1});
}

TEST_CASE("few triangles of any mesh stay single") {
  // Free neighbours alone would leave 7 % of the unstructured mesh.
  CHECK(single_share(unstructured({.size = {12, 4}, .element_size = 0.1})) < 0.001);
  CHECK(single_share(generate(
            RectangleMesh{.size = {12, 4}, .element_size = 0.1, .diagonals = RectangleMesh::Diagonals::crossed})) == 0);
  CHECK(single_share(generate(DiscMesh{.radius = 1, .element_size = 0.02})) < 0.01);
}

TEST_CASE("which triangles make a pair does not depend on their numbers") {
  const Mesh mesh = unstructured({.size = {6, 4}, .element_size = 0.1});
  const Mesh other = shuffled(mesh);
  const auto centres = [](const Mesh& m) {
    const std::vector<Index> partner = pairs_of(m);
    std::vector<std::pair<double, double>> sums;
    for (Index t = 0; t < partner.size(); ++t) {
      Vec2 sum;
      for (const Index s : {std::min(t, partner[t]), std::max(t, partner[t])}) {
        for (const Index node : m.triangles[s]) sum += m.nodes[node];
      }
      sums.push_back({std::round(1e9 * sum.x), std::round(1e9 * sum.y)});  // sums in another order round otherwise
    }
    std::sort(sums.begin(), sums.end());
    return sums;
  };
  CHECK(centres(mesh) == centres(other));
}

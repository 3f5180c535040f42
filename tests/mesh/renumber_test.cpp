#include "udar/mesh/renumber.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "udar/mesh/boundary.hpp"
#include "udar/mesh/generators.hpp"
#include "udar/mesh/node_corners.hpp"

using namespace udar;

namespace {

/// The mesh with nodes and triangles in random order.
Mesh shuffled(const Mesh& mesh) {
  std::mt19937 random(1);
  Mesh out = mesh;
  std::vector<Index> place(mesh.nodes.size());
  std::iota(place.begin(), place.end(), Index{0});
  std::shuffle(place.begin(), place.end(), random);
  for (std::size_t i = 0; i < place.size(); ++i) {
    out.nodes[place[i]] = mesh.nodes[i];
    out.node_numbers[place[i]] = mesh.node_numbers[i];
  }
  for (auto& triangle : out.triangles) {
    for (Index& node : triangle) node = place[node];
  }
  for (NamedEdges& side : out.sides) {
    for (Edge& e : side.edges) e = {place[e.a], place[e.b]};
  }
  std::shuffle(out.triangles.begin(), out.triangles.end(), random);
  return out;
}

/// Nodes touched by a window of triangles: what must stay in the cache.
double nodes_per_window(const Mesh& mesh) {
  constexpr std::size_t window = 512;
  std::size_t touched = 0;
  for (std::size_t first = 0; first < mesh.triangles.size(); first += window) {
    std::vector<Index> nodes;
    for (std::size_t t = first; t < std::min(first + window, mesh.triangles.size()); ++t) {
      nodes.insert(nodes.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
    }
    std::sort(nodes.begin(), nodes.end());
    touched += static_cast<std::size_t>(std::unique(nodes.begin(), nodes.end()) - nodes.begin());
  }
  return static_cast<double>(touched * window) / static_cast<double>(mesh.triangles.size());
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
  const Mesh mesh = renumber(shuffled(generate(RectangleMesh{.size = {5, 3}, .element_size = 0.1})));
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 2) {
    int shared = 0;
    for (const Index node : mesh.triangles[t]) {
      shared += static_cast<int>(std::count(mesh.triangles[t + 1].begin(), mesh.triangles[t + 1].end(), node));
    }
    CHECK(shared == 2);
  }
}

TEST_CASE("neighbours in space are neighbours in memory") {
  // 512 triangles of a compact patch have about 290 nodes, in rows of a long mesh about 514, at random over 1500.
  const Mesh mesh = generate(RectangleMesh{.size = {16, 16}, .element_size = 0.1});
  CHECK(nodes_per_window(renumber(shuffled(mesh))) < 330);
  CHECK(nodes_per_window(shuffled(mesh)) > 1400);
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

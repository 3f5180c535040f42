#include "udar/mesh/boundary.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "udar/base/error.hpp"
#include "udar/mesh/generators.hpp"
#include "udar/mesh/renumber.hpp"

using namespace udar;

namespace {

/// What `check_mesh` says, all in one text; "" where it is content.
std::string complaint(const Mesh& mesh) {
  try {
    check_mesh(mesh);
  } catch (const UserError& error) {
    CHECK(error.code == ExitCode::bad_mesh);
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

Mesh square() { return generate(RectangleMesh{.size = {2, 2}, .element_size = 1}); }

}  // namespace

TEST_CASE("the boundary is walked with the body on the left") {
  const Mesh mesh = square();
  const std::vector<Edge> expected{{0, 1}, {1, 2}, {2, 5}, {5, 8}, {8, 7}, {7, 6}, {6, 3}, {3, 0}};
  CHECK(boundary_edges(mesh) == expected);
}

TEST_CASE("a ring has two loops") {
  const Mesh mesh = generate(RingMesh{.outer_radius = 2, .inner_radius = 1, .element_size = 0.2});
  const std::vector<Edge> edges = boundary_edges(mesh);
  int loops = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i + 1 == edges.size() || edges[i].b != edges[i + 1].a) ++loops;
  }
  CHECK(loops == 2);
  double area = 0;
  for (const Edge e : edges) area += 0.5 * cross(mesh.nodes[e.a], mesh.nodes[e.b]);
  CHECK(area > 0);
}

TEST_CASE("two triangles that touch in a node have all their sides on the boundary") {
  const Mesh mesh{.nodes = {{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}}, .triangles = {{0, 1, 2}, {0, 3, 4}}};
  CHECK(boundary_edges(mesh).size() == 6);
}

TEST_CASE("a renumbered mesh brings its boundary along") {
  for (const MeshShape& shape : {MeshShape(RectangleMesh{.size = {2, 1}, .element_size = 0.25}),
                                 MeshShape(RingMesh{.outer_radius = 2, .inner_radius = 1, .element_size = 0.2})}) {
    const Mesh mesh = renumber(generate(shape));
    CHECK_FALSE(mesh.boundary.empty());
    CHECK(mesh.boundary == boundary_edges(mesh));
  }
}

TEST_CASE("a good mesh passes") { CHECK(complaint(square()) == ""); }

TEST_CASE("every mistake in a mesh is named with its place") {
  SUBCASE("no triangle") { CHECK(contains(complaint(Mesh{}), "no triangle")); }
  SUBCASE("clockwise") {
    Mesh mesh = square();
    std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
    mesh.triangle_numbers[4] = 77;
    CHECK(contains(complaint(mesh), "triangle 77 at (0.333333, 1.33333) m runs clockwise"));
  }
  SUBCASE("no area") {
    Mesh mesh = square();
    mesh.nodes[4] = {0, 0};
    CHECK(contains(complaint(mesh), "has no area"));
    CHECK(contains(complaint(mesh), "more)"));
  }
  SUBCASE("no such node") {
    Mesh mesh = square();
    mesh.triangles[2][1] = 9;
    CHECK(contains(complaint(mesh), "triangle 2 has a corner at node 9, which is not there"));
  }
  SUBCASE("not a number") {
    Mesh mesh = square();
    mesh.nodes[3].y = std::nan("");
    CHECK(contains(complaint(mesh), "node 3"));
  }
  SUBCASE("unused node") {
    Mesh mesh = square();
    mesh.nodes.push_back({5, 6});
    CHECK(contains(complaint(mesh), "node 9 at (5, 6) m belongs to no triangle"));
  }
  SUBCASE("three triangles at an edge") {
    const Mesh mesh{.nodes = {{0, 0}, {1, 0}, {0, 1}, {0, -1}, {0.5, 2}},
                    .triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
    CHECK(contains(complaint(mesh), "triangle 0 at (0.333333, 0.333333) m and triangle 2"));
  }
  SUBCASE("several at once") {
    Mesh mesh = square();
    mesh.nodes.push_back({5, 6});
    std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
    const std::string text = complaint(mesh);
    CHECK(contains(text, "clockwise"));
    CHECK(contains(text, "belongs to no triangle"));
  }
}

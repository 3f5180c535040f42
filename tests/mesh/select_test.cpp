#include "udar/mesh/select.hpp"

#include <doctest/doctest.h>

#include "udar/base/error.hpp"
#include "udar/mesh/generators.hpp"
#include "udar/mesh/renumber.hpp"

using namespace udar;

namespace {

/// 4 x 2 cells of side 1, cut to the upper right; nodes 0-4, 5-9, 10-14 from below.
Mesh plate() {
  return generate(RectangleMesh{.size = {4, 2}, .element_size = 1, .diagonals = RectangleMesh::Diagonals::right});
}

}  // namespace

TEST_CASE("a box holds what lies in or on it") {
  CHECK(nodes_in_box(plate(), {1, 1}, {2, 5}) == std::vector<Index>{6, 7, 11, 12});
  CHECK(nodes_in_box(plate(), {2, 5}, {1, 1}) == std::vector<Index>{6, 7, 11, 12});
  CHECK(nodes_in_box(plate(), {1 + 1e-12, 1}, {1, 1 - 1e-12}) == std::vector<Index>{6});
  CHECK(nodes_in_box(plate(), {0.1, 0.1}, {0.9, 0.9}).empty());
  CHECK(edges_in_box(plate(), {1, 0}, {3, 1}) == std::vector<Edge>{{1, 2}, {2, 3}});
}

TEST_CASE("a line holds what lies within the tolerance") {
  CHECK(nodes_near_line(plate(), {0, 0.001}, {2, 0.001}, 0.01) == std::vector<Index>{0, 1, 2});
  CHECK(nodes_near_line(plate(), {0, 0}, {2, 2}, 0.01) == std::vector<Index>{0, 6, 12});
  CHECK(nodes_near_line(plate(), {3, 1}, {3, 1}, 0.01) == std::vector<Index>{8});
  CHECK(edges_near_line(plate(), {4, 2}, {4, 0}, 0.01) == std::vector<Edge>{{4, 9}, {9, 14}});
  CHECK(edges_near_line(plate(), {1, 0}, {1, 2}, 0.01).empty());  // inner edges are none of the boundary
}

TEST_CASE("the nearest node; on a tie the smaller x, then y") {
  CHECK(nearest_node(plate(), {3.2, 0.9}) == 8);
  CHECK(nearest_node(plate(), {-100, 100}) == 10);
  CHECK(nearest_node(plate(), {1.5, 0.5}) == 1);
  CHECK(nearest_node(plate(), {1.5 + 1e-13, 0.5 + 1e-13}) == 1);
}

TEST_CASE("sides are found by name") {
  CHECK(nodes_of_side(plate(), "left") == std::vector<Index>{0, 5, 10});
  CHECK(edges_of_side(plate(), "right") == std::vector<Edge>{{4, 9}, {9, 14}});
  CHECK_THROWS_WITH_AS(edges_of_side(plate(), "botom"), doctest::Contains("did you mean `bottom`?"), UserError);
  CHECK_THROWS_WITH_AS(edges_of_side(plate(), "xyz"), doctest::Contains("bottom, right, top or left"), UserError);
  CHECK_THROWS_WITH_AS(edges_of_side(Mesh{}, "top"), doctest::Contains("no named side"), UserError);
}

TEST_CASE("a polygon holds what lies in or on it, either way round") {
  CHECK(nodes_in_polygon(plate(), {{0, 0}, {2, 0}, {0, 2}}) == std::vector<Index>{0, 1, 2, 5, 6, 10});
  CHECK(nodes_in_polygon(plate(), {{0, 2}, {2, 0}, {0, 0}}) == std::vector<Index>{0, 1, 2, 5, 6, 10});
  // A hollow one: the notch at the top leaves out (2, 2) and (2, 1).
  const std::vector<Vec2> notched{{-1, -1}, {5, -1}, {5, 3}, {2.5, 3}, {2, 0.5}, {1.5, 3}, {-1, 3}};
  const std::vector<Index> found = nodes_in_polygon(plate(), notched);
  CHECK(found == std::vector<Index>{0, 1, 2, 3, 4, 5, 6, 8, 9, 10, 11, 13, 14});
}

TEST_CASE("the element at a point; on an edge that with the smaller centroid") {
  const Mesh mesh = plate();
  CHECK(element_at(mesh, {2.7, 0.2}) == 4);
  CHECK(element_at(mesh, {0.5, 0.5}) == 1);  // on the diagonal: the upper left one
  CHECK(element_at(mesh, {2, 0.4}) == 2);    // on a vertical line: the left one
  CHECK(element_at(mesh, {0, 0}) == 1);      // in a corner
  CHECK(element_at(mesh, {1, 1}) == 1);      // six candidates
  CHECK(element_at(mesh, {4, 2}) == 15);
  CHECK_THROWS_WITH_AS(element_at(mesh, {5, 0.6}), doctest::Contains("the nearest node of the body is at (4, 1) m"),
                       UserError);
}

TEST_CASE("what is picked by place does not depend on numbering") {
  const Mesh mesh = generate(RectangleMesh{.size = {0.4, 0.1}, .at = {-0.2, 0}, .element_size = 0.0025});
  const Mesh other = renumber(mesh);
  for (const Vec2 p : {Vec2{0, 0.099}, Vec2{0, 0.05}, Vec2{0, 0.001}, Vec2{-0.2, 0.1}, Vec2{0.0125, 0.0125}}) {
    CHECK(other.triangle_numbers[element_at(other, p)] == element_at(mesh, p));
    CHECK(other.node_numbers[nearest_node(other, p)] == nearest_node(mesh, p));
  }
}

TEST_CASE("the shortest side") { CHECK(shortest_side(plate()) == 1); }

#pragma once

#include <string_view>
#include <vector>

#include "udar/base/vec2.hpp"
#include "udar/mesh/mesh.hpp"

namespace udar {

/// Picking nodes, edges and elements of a body by place or name. Nodes come in ascending order, edges in that of
/// `boundary_edges`. "On" forgives rounding: a billionth of the body's size. Nothing found is an empty list; the caller
/// knows what the user had asked for.

/// Nodes in or on the box with two opposite corners `a` and `b` (m).
std::vector<Index> nodes_in_box(const Mesh& mesh, Vec2 a, Vec2 b);
/// Boundary edges with both ends in or on that box.
std::vector<Edge> edges_in_box(const Mesh& mesh, Vec2 a, Vec2 b);

/// Nodes within `tolerance` (m) of the straight line from `a` to `b` (m).
std::vector<Index> nodes_near_line(const Mesh& mesh, Vec2 a, Vec2 b, double tolerance);
/// Boundary edges with both ends within `tolerance` of that line.
std::vector<Edge> edges_near_line(const Mesh& mesh, Vec2 a, Vec2 b, double tolerance);

/// The edges of a named side, in the generator's order. Throws UserError(bad_case) where there is none of that name.
const std::vector<Edge>& edges_of_side(const Mesh& mesh, std::string_view name);
/// The nodes of a named side. Throws as `edges_of_side`.
std::vector<Index> nodes_of_side(const Mesh& mesh, std::string_view name);

/// Nodes inside or on a polygon (even-odd rule; m).
std::vector<Index> nodes_in_polygon(const Mesh& mesh, const std::vector<Vec2>& polygon);

/// The node nearest to `point` (m); of several the one with the smaller x, then y.
Index nearest_node(const Mesh& mesh, Vec2 point);

/// The element that contains `point` (m); on an edge the candidate whose centroid has the smaller x, then y. Throws
/// UserError(bad_case), naming the nearest node, where no element does.
Index element_at(const Mesh& mesh, Vec2 point);

/// The shortest side of any triangle, m: the scale for tolerances.
double shortest_side(const Mesh& mesh);

}  // namespace udar

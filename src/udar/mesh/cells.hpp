#pragma once

#include <string_view>

#include "udar/mesh/mesh.hpp"

namespace udar {

/// What the generators share.

/// The largest number of corners (three a triangle) that a mesh may have: corners are counted in 32 bits.
inline constexpr double most_corners = 2147483648.0;

/// Whole number of cells nearest to length / element_size. Throws UserError(bad_mesh), naming `what` ("width"), where
/// there is not one, a size is not positive and finite, or the number alone makes too many corners.
Index cells_along(double length, double element_size, std::string_view what);

/// Bytes that a run takes at least for each element, its mesh included: large ones took 216 (docs/performance.md).
inline constexpr double least_bytes_per_element = 210;

/// Throws UserError(resources) where so many elements that take so many bytes are more than this machine, or a limit of
/// the process, leaves.
void check_memory_for(double elements, double bytes);

/// Throws UserError(bad_mesh) where so many triangles have too many corners, UserError(resources) where there is not
/// the memory for them.
void check_triangle_count(double triangles);

/// Throws UserError(bad_mesh) where a place or a turn is not a finite number.
void check_placement(Vec2 at, double turn);

/// The point of a circle nearest to `p`.
Vec2 on_circle(Vec2 p, Vec2 centre, double radius);

/// Numbers nodes and triangles as they are.
void number_as_generated(Mesh& mesh);

/// The edges from node to node of `path`, the body on their left.
NamedEdges named_path(std::string_view name, const std::vector<Index>& path);

}  // namespace udar

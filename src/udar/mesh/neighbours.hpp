#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "udar/mesh/mesh.hpp"
#include "udar/mesh/node_corners.hpp"

namespace udar {

/// Stands for "no triangle".
inline constexpr Index none = std::numeric_limits<Index>::max();

/// Corner after `local` round a triangle.
constexpr int next_corner(int local) { return local == 2 ? 0 : local + 1; }

/// For each side of each triangle (side k runs from corner k to the next one) the triangle across it, or `none` on the
/// boundary. All triangles must run counter-clockwise. Linear in their number.
std::vector<std::array<Index, 3>> neighbours(std::span<const std::array<Index, 3>> triangles, const NodeCorners& map);

/// The sides of triangles that have nothing across, in the order of the triangles.
std::vector<Edge> outer_sides(std::span<const std::array<Index, 3>> triangles,
                              std::span<const std::array<Index, 3>> across);

}  // namespace udar

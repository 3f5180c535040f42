#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "udar/base/vec2.hpp"

namespace udar {

using Triangle = std::array<std::int32_t, 3>;
using Loop = std::vector<std::int32_t>;

/// Outer and inner boundaries of the union of `triangles` (counter-clockwise), as closed loops of point numbers. Time
/// is linear.
std::vector<Loop> outline(std::span<const Triangle> triangles);

/// The loops of edges that lie end to end.
std::vector<Loop> loops_of(std::span<const std::array<std::int32_t, 2>> edges);

/// Every edge of the mesh once.
std::vector<std::pair<std::int32_t, std::int32_t>> mesh_edges(std::span<const Triangle> triangles);

/// An upright rectangle; empty until something was added.
struct Extent {
  Vec2 low{1, 1};
  Vec2 high{-1, -1};

  [[nodiscard]] bool empty() const { return low.x > high.x || low.y > high.y; }
  [[nodiscard]] Vec2 size() const { return high - low; }
  [[nodiscard]] Vec2 centre() const { return 0.5 * (low + high); }
  [[nodiscard]] Extent grown(double by) const { return {low - Vec2{by, by}, high + Vec2{by, by}}; }
  [[nodiscard]] bool contains(const Extent& other) const;
  [[nodiscard]] bool overlaps(const Extent& other) const;
  [[nodiscard]] Extent common_with(const Extent& other) const;
  void add(Vec2 point);
  void add(const Extent& other);
};

Extent bounds(std::span<const Vec2> points);

/// The part of `polygon` inside `box` (Sutherland and Hodgman 1974).
std::vector<Vec2> clipped(std::vector<Vec2> polygon, const Extent& box);

}  // namespace udar

#pragma once

#include <cstdint>
#include <vector>

#include "udar/base/vec2.hpp"

namespace udar {

/// The ends of a segment, m.
struct SegmentEnds {
  Vec2 a{};
  Vec2 b{};
};

/// Segments near each point: those of point i are near[begin[i]] to near[begin[i + 1] - 1], in rising order.
struct Neighbours {
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> near;

  [[nodiscard]] bool empty() const { return near.empty(); }
};

/// Every segment that comes within `reach` (m, above 0) of each point, and maybe a few that do not. Both are sorted
/// into the cells of a grid that covers the points; the work is in proportion to their number where segments are of
/// about one length and `reach` is no longer. Does not depend on anything but its arguments. Points must be finite.
Neighbours find_near(const std::vector<Vec2>& points, const std::vector<SegmentEnds>& segments, double reach);

}  // namespace udar

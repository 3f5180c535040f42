#pragma once

#include <cstdint>
#include <vector>

#include "udar/base/vec2.hpp"

namespace udar {

/// Where a point stands to the boundary of an obstacle.
struct Gap {
  double distance = 0;     ///< m, to the nearest point of the boundary; negative inside
  Vec2 normal{};           ///< unit vector out of the obstacle: the gradient of `distance`
  std::uint32_t face = 0;  ///< the smooth piece of boundary that the nearest point lies on
};

/// A line through its points (m); a closed one ends where it begins.
using Polyline = std::vector<Vec2>;

}  // namespace udar

#pragma once

#include "udar/contact/body_touch.hpp"

namespace udar {

/// A corner of an obstacle that digs into the boundary of a body, beyond the nodes beside it: a spring with the energy
///   k w(s) (d - p)^2 / 2
/// d: depth of the corner; p: depth of the deeper end of the segment in the obstacle, 0 where both are outside;
/// w(s) = 16 s^2 (1 - s)^2 along the segment. Nodes have springs of their own: in one, and where the boundary lies flat
/// on the obstacle up to its corner, there is nothing to add. The forces are the gradient of this energy.
struct CornerTouch : BodyTouch {
  Vec2 relief{};               ///< N, on the deeper end, into the obstacle
  std::uint32_t relieved = 0;  ///< that point
  std::uint32_t relieves = 0;  ///< 1 where there is one
};

inline double corner_weight(double along) {
  const double root = 4 * along * (1 - along);
  return root * root;
}

/// Derivative of the weight along the segment.
inline double corner_weight_slope(double along) { return 32 * along * (1 - along) * (1 - 2 * along); }

/// Calls f(point, forces) for all points of the boundary that the corner pushes.
template <class F>
void for_each_force(const std::vector<Segment>& segments, const CornerTouch& touch, F&& f) {
  for_each_force(segments, static_cast<const BodyTouch&>(touch), [&](std::uint32_t point, const TouchForces& forces) {
    if (point != touch.point) f(point, forces);
  });
  if (touch.relieves != 0) f(touch.relieved, TouchForces{.normal = touch.relief});
}

}  // namespace udar

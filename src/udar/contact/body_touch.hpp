#pragma once

#include <array>

#include "udar/contact/foot.hpp"
#include "udar/contact/penalty.hpp"

namespace udar {

/// A point of one body in touch with the boundary of another one, or of its own.
struct BodyTouch {
  std::uint32_t point = 0;
  std::uint32_t segment = 0;  ///< where the nearest point of the boundary is
  std::uint32_t body = 0;     ///< that the segment belongs to
  std::uint32_t unused = 0;
  double along = 0;                 ///< on the segment, 0 to 1
  double lever = 0;                 ///< m, between the points of the boundary that take up the couple of friction
  double stiffness = 0;             ///< N/m, of the normal spring; stays as long as the touch does
  double tangential_stiffness = 0;  ///< N/m
  SpringState springs;              ///< forces are those on the point
};

/// How a point of the boundary shares in a touch.
struct TouchShare {
  std::uint32_t point = 0;
  double weight = 0;  ///< of the opposite of the force; 1 in all
  double couple = 0;  ///< of the pair of normal forces that closes the couple of friction: -1, 0 or 1
};

/// The points of the boundary that take up the force of a touch. Between the ends of a segment these two; in an end
/// that one, and its neighbours for the couple.
struct TouchShares {
  std::array<TouchShare, 3> of{};
  std::size_t count = 0;

  [[nodiscard]] const TouchShare* begin() const { return of.data(); }
  [[nodiscard]] const TouchShare* end() const { return of.data() + count; }
};

inline TouchShares shares_of(const std::vector<Segment>& segments, std::uint32_t number, double along) {
  const Segment& s = segments[number];
  if (along <= 0) return {{{{segments[s.before].a, 0, -1}, {s.a, 1, 0}, {s.b, 0, 1}}}, 3};
  if (along >= 1) return {{{{s.a, 0, -1}, {s.b, 1, 0}, {segments[s.after].b, 0, 1}}}, 3};
  return {{{{s.a, 1 - along, -1}, {s.b, along, 1}, {}}}, 2};
}

/// Forces of a touch on a point, N.
struct TouchForces {
  Vec2 normal{};
  Vec2 friction{};
  Vec2 damping{};

  [[nodiscard]] Vec2 total() const { return normal + friction + damping; }
};

/// Calls f(point, forces) for all points that a touch pushes. They add up to nothing, and so do their moments: the
/// normal forces act along one line; those of friction T, the depth d apart, make a couple d T, which two normal forces
/// d T / lever on the boundary take up.
template <class F>
void for_each_force(const std::vector<Segment>& segments, const BodyTouch& touch, F&& f) {
  const SpringState& s = touch.springs;
  f(touch.point, TouchForces{s.normal_force, s.friction_force, s.damping_force});
  const double friction = dot(s.friction_force, perpendicular(s.normal));
  const Vec2 couple = touch.lever > 0 ? (-s.penetration * friction / touch.lever) * s.normal : Vec2{};
  for (const TouchShare& share : shares_of(segments, touch.segment, touch.along)) {
    f(share.point, TouchForces{-share.weight * s.normal_force, -share.weight * s.friction_force + share.couple * couple,
                               -share.weight * s.damping_force});
  }
}

}  // namespace udar

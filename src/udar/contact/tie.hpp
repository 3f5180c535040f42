#pragma once

#include "udar/contact/foot.hpp"

namespace udar {

/// A point of one body tied to the boundary of another one for ever, where it was at the start.
struct Tie {
  std::uint32_t point = 0;
  std::uint32_t segment = 0;
  double along = 0;      ///< on the segment; may be a little beyond its ends
  double gap = 0;        ///< m, from the boundary, which turns with it
  double stiffness = 0;  ///< N/m, in every direction
};

/// Where a tie is stretched, and the forces on its point and on the ends a and b of the segment, N.
struct TiePull {
  Vec2 stretch{};  ///< m
  Vec2 on_point{};
  Vec2 on_a{};
  Vec2 on_b{};
};

/// Gradient of k e.e / 2 with e = p - (1 - s) a - s b - g n: n, the normal of the segment, turns with it, so that the
/// stretch is the same however all three are moved as one piece, and forces and moments are in balance.
inline TiePull pull(const Tie& tie, Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 along = b - a;
  const double size = length(along);
  const Vec2 normal = (1 / size) * outward(along);
  const Vec2 stretch = p - ((1 - tie.along) * a + tie.along * b) - tie.gap * normal;
  const Vec2 force = tie.stiffness * stretch;
  const Vec2 couple = (tie.gap * dot(force, along) / (size * size)) * normal;
  return {stretch, -force, (1 - tie.along) * force + couple, tie.along * force - couple};
}

}  // namespace udar

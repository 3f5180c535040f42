#pragma once

#include <algorithm>
#include <limits>

#include "udar/base/vec2.hpp"

namespace udar {

/// A rectangle with sides along the axes; it holds nothing until something is put in.
struct Box {
  Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Vec2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  /// Grows to hold `p` too.
  constexpr void include(Vec2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  /// Inside or on the rim.
  [[nodiscard]] constexpr bool holds(Vec2 p) const {
    return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y;
  }
  /// Has it a point in common with another one?
  [[nodiscard]] constexpr bool meets(const Box& b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y;
  }
  /// The smallest box that holds both.
  [[nodiscard]] constexpr Box joined(const Box& b) const {
    return {{std::min(low.x, b.low.x), std::min(low.y, b.low.y)},
            {std::max(high.x, b.high.x), std::max(high.y, b.high.y)}};
  }
  /// The box with `margin` more on every side.
  [[nodiscard]] constexpr Box grown(double margin) const {
    return {low - Vec2{margin, margin}, high + Vec2{margin, margin}};
  }
  [[nodiscard]] constexpr Box shifted(Vec2 by) const { return {low + by, high + by}; }
  [[nodiscard]] constexpr Vec2 size() const { return high - low; }
};

/// The smallest box that holds all `points`.
template <class Points>
constexpr Box bounding_box(const Points& points) {
  Box box;
  for (const Vec2 p : points) box.include(p);
  return box;
}

}  // namespace udar

#pragma once

#include <vector>

#include "udar/base/box.hpp"
#include "udar/contact/gap.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// A circle ready for many questions.
struct PreparedCircle {
  Vec2 centre{};      ///< m
  double radius = 0;  ///< m

  [[nodiscard]] Gap gap(Vec2 p) const {
    const Vec2 from_centre = p - centre;
    const double r = length(from_centre);
    // In the very centre every direction is as good; one must be taken.
    return {r - radius, r > 0 ? (1 / r) * from_centre : Vec2{0, 1}, 0};
  }
  [[nodiscard]] bool holds(Vec2 p) const { return dot(p - centre, p - centre) <= radius * radius; }
  [[nodiscard]] double inner_radius() const { return radius; }
  /// Does the straight way from one place to another, both outside, lead through it?
  [[nodiscard]] bool is_crossed(Vec2 from, Vec2 to) const;
  /// A closed polygon of 96 sides.
  [[nodiscard]] std::vector<Polyline> outline(const Box& view) const;
  [[nodiscard]] Box bounds() const { return {centre - Vec2{radius, radius}, centre + Vec2{radius, radius}}; }
};

/// A round obstacle.
struct Circle {
  static constexpr const char* keyword = "circle";
  static constexpr const char* doc = "disc";

  Vec2 centre{};      ///< m
  double radius = 0;  ///< m

  static std::vector<Parameter<Circle>> parameters() {
    return {{"centre", &Circle::centre, dimension::length, {}, "centre"},
            {"radius", &Circle::radius, dimension::length, limits::positive, "radius"}};
  }
  /// Throws UserError(bad_case) where the radius is not above 0.
  [[nodiscard]] PreparedCircle prepared() const;
};

}  // namespace udar

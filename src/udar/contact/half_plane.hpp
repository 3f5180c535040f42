#pragma once

#include <limits>
#include <vector>

#include "udar/base/box.hpp"
#include "udar/contact/gap.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// A half-plane ready for many questions.
struct PreparedHalfPlane {
  Vec2 point{};       ///< m, on the line
  Vec2 normal{0, 1};  ///< unit vector out of the obstacle

  [[nodiscard]] Gap gap(Vec2 p) const { return {dot(normal, p - point), normal, 0}; }
  [[nodiscard]] bool holds(Vec2 p) const { return dot(normal, p - point) <= 0; }
  [[nodiscard]] double inner_radius() const { return std::numeric_limits<double>::infinity(); }
  /// What is outside before and after did not pass through: it has no other side.
  [[nodiscard]] bool is_crossed(Vec2 /*from*/, Vec2 /*to*/) const { return false; }
  /// The stretch of the line in the view; none where it does not cross the view.
  [[nodiscard]] std::vector<Polyline> outline(const Box& view) const;
  /// The plane on the obstacle's side where the line runs along an axis, else everything.
  [[nodiscard]] Box bounds() const;
};

/// Everything behind a straight line.
struct HalfPlane {
  static constexpr const char* keyword = "half_plane";
  static constexpr const char* doc = "everything behind a straight line";

  Vec2 point{};       ///< m, on the line
  Vec2 normal{0, 1};  ///< out of the obstacle; any length but zero

  static std::vector<Parameter<HalfPlane>> parameters() {
    return {{"point", &HalfPlane::point, dimension::length, {}, "a point of the line"},
            {"normal", &HalfPlane::normal, dimension::number, {}, "direction out of the obstacle", false}};
  }
  /// Throws UserError(bad_case) where the normal has no direction.
  [[nodiscard]] PreparedHalfPlane prepared() const;
};

}  // namespace udar

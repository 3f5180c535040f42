#pragma once

#include <vector>

#include "udar/contact/gap.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// Everything behind a straight line.
struct HalfPlane {
  static constexpr const char* keyword = "half_plane";
  static constexpr const char* doc = "everything behind a straight line";

  Vec2 point{};          ///< m, on the line
  Vec2 normal{0, 1};     ///< out of the obstacle; any length but zero

  static std::vector<Parameter<HalfPlane>> parameters() {
    return {{"point", &HalfPlane::point, dimension::length, {}, "a point of the line"},
            {"normal", &HalfPlane::normal, dimension::number, {}, "direction out of the obstacle", false}};
  }
};

}  // namespace udar

#pragma once

#include <vector>

#include "udar/contact/gap.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

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
};

}  // namespace udar

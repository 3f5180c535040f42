#pragma once

#include <vector>

#include "udar/contact/gap.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// A convex polygon. Its corners may run either way round.
struct Polygon {
  static constexpr const char* keyword = "polygon";
  static constexpr const char* doc = "convex polygon";

  std::vector<Vec2> points;  ///< m, at least three

  static std::vector<Parameter<Polygon>> parameters() {
    return {{"points", &Polygon::points, dimension::length, {}, "corners, in order"}};
  }
};

/// A rectangle with sides along the axes.
struct Rectangle {
  static constexpr const char* keyword = "rectangle";
  static constexpr const char* doc = "rectangle with sides along the axes";

  Vec2 at{};    ///< m, lower left corner
  Vec2 size{};  ///< m

  static std::vector<Parameter<Rectangle>> parameters() {
    return {{"at", &Rectangle::at, dimension::length, {}, "lower left corner"},
            {"size", &Rectangle::size, dimension::length, limits::positive, "width and height"}};
  }
};

}  // namespace udar

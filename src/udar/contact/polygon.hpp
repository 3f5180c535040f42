#pragma once

#include <vector>

#include "udar/base/box.hpp"
#include "udar/contact/gap.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// A convex polygon ready for many questions. Face i runs from corner i to the next one.
struct PreparedPolygon {
  std::vector<Vec2> points;   ///< m, counter-clockwise
  std::vector<Vec2> normals;  ///< unit vectors out of the obstacle, one for each face

  /// The corner that ends face i, m.
  [[nodiscard]] Vec2 after(std::size_t i) const { return points[i + 1 < points.size() ? i + 1 : 0]; }
  /// Inside, the nearest point of the boundary lies on a face; outside, it may be a corner, and the normal points away
  /// from it. Of two faces equally near, the lower one counts.
  [[nodiscard]] Gap gap(Vec2 p) const;
  /// Inside or on the boundary; far cheaper than the gap of a point outside.
  [[nodiscard]] bool holds(Vec2 p) const {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (dot(normals[i], p - points[i]) > 0) return false;
    }
    return true;
  }
  /// Radius of the largest disc in it, m: no point is deeper.
  [[nodiscard]] double inner_radius() const;
  /// Does the straight way from one place to another, both outside, lead through it?
  [[nodiscard]] bool is_crossed(Vec2 from, Vec2 to) const;
  [[nodiscard]] std::vector<Polyline> outline(const Box& view) const;
  [[nodiscard]] Box bounds() const { return bounding_box(points); }
};

/// A convex polygon. Its corners may run either way round.
struct Polygon {
  static constexpr const char* keyword = "polygon";
  static constexpr const char* doc = "convex polygon";

  std::vector<Vec2> points;  ///< m, at least three

  static std::vector<Parameter<Polygon>> parameters() {
    return {{"points", &Polygon::points, dimension::length, {}, "corners, in order"}};
  }
  /// Throws UserError(bad_case) where there are less than three corners, two in one place, a hollow, or no area.
  [[nodiscard]] PreparedPolygon prepared() const;
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
  /// Faces bottom, right, top, left. Throws UserError(bad_case) where a size is not above 0.
  [[nodiscard]] PreparedPolygon prepared() const;
};

}  // namespace udar

#include "udar/contact/polygon.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "udar/base/error.hpp"

namespace udar {
namespace {

/// The deepest a corner may lie before a face of a polygon taken for convex: rounding of what the user typed.
double tolerance(const PreparedPolygon& polygon) {
  const Vec2 size = polygon.bounds().size();
  return 1e-9 * std::max(size.x, size.y);
}

PreparedPolygon with_normals(std::vector<Vec2> points) {
  PreparedPolygon out{std::move(points), {}};
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    const Vec2 along = out.after(i) - out.points[i];
    const double size = length(along);
    if (!(size > tolerance(out) && std::isfinite(size))) {
      throw UserError(ExitCode::bad_case,
                      fmt::format("corners {} and {} of the polygon are in one place or not finite", i + 1,
                                  i + 1 < out.points.size() ? i + 2 : 1),
                      "give every corner once; the polygon closes by itself");
    }
    out.normals.push_back((-1 / size) * perpendicular(along));
  }
  return out;
}

void check_convex(const PreparedPolygon& polygon) {
  for (std::size_t face = 0; face < polygon.points.size(); ++face) {
    for (const Vec2 corner : polygon.points) {
      if (dot(polygon.normals[face], corner - polygon.points[face]) <= tolerance(polygon)) continue;
      throw UserError(ExitCode::bad_case,
                      fmt::format("the polygon is not convex: its corner ({:.6g}, {:.6g}) m lies before another face",
                                  corner.x, corner.y),
                      "give the corners in order round it; make a hollow obstacle of several convex ones");
    }
  }
}

/// Nearest point of the boundary for a point outside.
Gap gap_outside(const PreparedPolygon& polygon, Vec2 p) {
  double nearest = std::numeric_limits<double>::infinity();
  Gap out;
  for (std::size_t i = 0; i < polygon.points.size(); ++i) {
    const Vec2 start = polygon.points[i];
    const Vec2 along = polygon.after(i) - start;
    const double s = dot(p - start, along) / dot(along, along);
    const Vec2 away = p - (start + std::clamp(s, 0.0, 1.0) * along);
    const double square = dot(away, away);
    if (!(square < nearest)) continue;
    nearest = square;
    const bool on_face = s >= 0 && s <= 1;
    const double distance = std::sqrt(square);
    out.face = static_cast<std::uint32_t>(i);
    out.distance = on_face ? dot(polygon.normals[i], p - start) : distance;
    out.normal = on_face || distance == 0 ? polygon.normals[i] : (1 / distance) * away;
  }
  return out;
}

/// Where a concave function of one variable is largest; each look leaves two thirds of the range.
template <class Function>
double place_of_largest(double low, double high, Function function) {
  for (int k = 0; k < 60; ++k) {  // to a part in 1e10
    const double third = (high - low) / 3;
    if (function(low + third) < function(high - third)) {
      low += third;
    } else {
      high -= third;
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

PreparedPolygon Polygon::prepared() const {
  if (points.size() < 3) throw UserError(ExitCode::bad_case, "a polygon needs at least three corners");
  double area = 0;
  for (std::size_t i = 2; i < points.size(); ++i) area += twice_area(points[0], points[i - 1], points[i]);
  std::vector<Vec2> ordered = points;
  if (area < 0) std::reverse(ordered.begin(), ordered.end());
  PreparedPolygon out = with_normals(std::move(ordered));
  check_convex(out);
  const Vec2 size = out.bounds().size();
  if (std::fabs(area) <= tolerance(out) * std::max(size.x, size.y)) {
    throw UserError(ExitCode::bad_case, "the polygon has no area");
  }
  return out;
}

PreparedPolygon Rectangle::prepared() const {
  if (!(size.x > 0 && size.y > 0)) {
    throw UserError(ExitCode::bad_case, "width and height of a rectangle must be above 0");
  }
  return with_normals({at, at + Vec2{size.x, 0}, at + size, at + Vec2{0, size.y}});
}

double PreparedPolygon::inner_radius() const {
  // The depth, least of the distances from lines, is concave; so is the largest depth at the same x.
  const auto depth = [this](double x, double y) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i) least = std::min(least, dot(normals[i], points[i] - Vec2{x, y}));
    return least;
  };
  const Box box = bounds();
  const auto deepest_y = [&](double x) {
    return place_of_largest(box.low.y, box.high.y, [&](double y) { return depth(x, y); });
  };
  const double x = place_of_largest(box.low.x, box.high.x, [&](double at) { return depth(at, deepest_y(at)); });
  return depth(x, deepest_y(x));
}

bool PreparedPolygon::is_crossed(Vec2 from, Vec2 to) const {
  double enters = 0;  // part of the way
  double leaves = 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double before = dot(normals[i], from - points[i]);
    const double after = dot(normals[i], to - points[i]);
    if (before >= 0 && after >= 0) return false;
    if (before > 0) enters = std::max(enters, before / (before - after));
    if (after > 0) leaves = std::min(leaves, before / (before - after));
  }
  return enters < leaves;
}

std::vector<Polyline> PreparedPolygon::outline(const Box& /*view*/) const {
  Polyline line = points;
  line.push_back(points.front());
  return {line};
}

Gap PreparedPolygon::gap(Vec2 p) const {
  double largest = -std::numeric_limits<double>::infinity();
  std::size_t face = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double before_face = dot(normals[i], p - points[i]);
    if (before_face <= largest) continue;
    largest = before_face;
    face = i;
  }
  if (largest > 0) return gap_outside(*this, p);
  return {largest, normals[face], static_cast<std::uint32_t>(face)};
}

}  // namespace udar

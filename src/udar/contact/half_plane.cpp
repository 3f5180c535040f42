#include "udar/contact/half_plane.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "udar/base/error.hpp"

namespace udar {

PreparedHalfPlane HalfPlane::prepared() const {
  const double size = length(normal);
  if (!(size > 0 && std::isfinite(size) && std::isfinite(point.x) && std::isfinite(point.y))) {
    throw UserError(ExitCode::bad_case, "the normal of a half-plane must have a direction, and its point be finite");
  }
  return {point, (1 / size) * normal};
}

std::vector<Polyline> PreparedHalfPlane::outline(const Box& view) const {
  const Vec2 along = -perpendicular(normal);  // the obstacle on the right
  double begin = -std::numeric_limits<double>::infinity();
  double end = -begin;
  // The stretch of the line between low and high in one coordinate.
  const auto clip = [&](double start, double speed, double low, double high) {
    if (speed == 0) {
      if (start < low || start > high) end = begin;
      return;
    }
    const double at_low = (low - start) / speed;
    const double at_high = (high - start) / speed;
    begin = std::max(begin, std::min(at_low, at_high));
    end = std::min(end, std::max(at_low, at_high));
  };
  clip(point.x, along.x, view.low.x, view.high.x);
  clip(point.y, along.y, view.low.y, view.high.y);
  if (!(begin < end)) return {};
  return {{point + begin * along, point + end * along}};
}

Box PreparedHalfPlane::bounds() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box box{{-infinity, -infinity}, {infinity, infinity}};
  if (normal.x == 0) (normal.y > 0 ? box.high : box.low).y = point.y;
  if (normal.y == 0) (normal.x > 0 ? box.high : box.low).x = point.x;
  return box;
}

}  // namespace udar

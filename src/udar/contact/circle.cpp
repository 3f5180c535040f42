#include "udar/contact/circle.hpp"

#include <algorithm>
#include <cmath>

#include "udar/base/error.hpp"

namespace udar {

PreparedCircle Circle::prepared() const {
  if (!(radius > 0 && std::isfinite(radius) && std::isfinite(centre.x) && std::isfinite(centre.y))) {
    throw UserError(ExitCode::bad_case, "the radius of a circle must be above 0, and its centre finite");
  }
  return {centre, radius};
}

bool PreparedCircle::is_crossed(Vec2 from, Vec2 to) const {
  const Vec2 way = to - from;
  const double square = dot(way, way);
  const double nearest = square > 0 ? std::clamp(dot(centre - from, way) / square, 0.0, 1.0) : 0;
  return holds(from + nearest * way);
}

std::vector<Polyline> PreparedCircle::outline(const Box& /*view*/) const {
  constexpr int sides = 96;
  constexpr double whole_turn = 6.283185307179586;
  Polyline line;
  for (int i = 0; i < sides; ++i) line.push_back(centre + turn_by(whole_turn * i / sides) * Vec2{radius, 0});
  line.push_back(line.front());
  return {line};
}

}  // namespace udar

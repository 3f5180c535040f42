#include "udar/report/frame_picture.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "udar/base/error.hpp"

namespace udar {
namespace {

/// The value below which this part of the values lies.
double quantile(std::vector<double>& values, double part) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(std::lround(part * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The smallest round number that is not below `value`; fine enough that colours are not wasted.
double round_number_above(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double digits : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (digits * power >= value * (1 - 1e-9)) return digits * power;
  }
  return 10 * power;
}

/// The box of one body now, m.
Extent box_of_body(const Frame& frame, int body) {
  const std::vector<std::int32_t> bodies = bodies_of_triangles(frame);
  Extent box;
  for (std::size_t t = 0; t < bodies.size(); ++t) {
    if (bodies[t] != body) continue;
    for (const std::int32_t corner : frame.triangles[t]) {
      box.add(bounds({&frame.bodies.points[static_cast<std::size_t>(corner)], 1}));
    }
  }
  return box;
}

/// The middle of the area of one body now, m.
Vec2 middle_of_body(const Frame& frame, int body) {
  const std::vector<std::int32_t> bodies = bodies_of_triangles(frame);
  double area = 0;
  Vec2 moment;
  for (std::size_t t = 0; t < bodies.size(); ++t) {
    if (bodies[t] != body) continue;
    const auto corner = [&](std::size_t k) {
      return frame.bodies.points[static_cast<std::size_t>(frame.triangles[t][k])];
    };
    const double twice = twice_area(corner(0), corner(1), corner(2));
    area += twice;
    moment += twice / 3 * (corner(0) + corner(1) + corner(2));
  }
  return area > 0 ? (1 / area) * moment : box_of_body(frame, body).centre();
}

Picture bare_picture(const Frame& frame) {
  Picture picture;
  picture.points = frame.bodies.points;
  picture.triangles = frame.triangles;
  picture.obstacles = frame.obstacles;
  return picture;
}

}  // namespace

std::pair<double, double> round_range(double low, double high) {
  constexpr double hardly = 0.1;  // less of the other sign is left to the last colour
  const double down = std::max(0.0, -low);
  const double up = std::max(0.0, high);
  if (down == 0 && up == 0) return {0, 1};
  const double most = round_number_above(std::max(down, up));
  if (down < hardly * up) return {0, most};
  if (up < hardly * down) return {-most, 0};
  return {-most, most};
}

void FrameSurvey::add(const Frame& frame) {
  add_values(frame);
  if (view_.view) return;
  if (view_.follow) {
    const Vec2 size = box_of_body(frame, *view_.follow).size();
    largest_ = {std::max(largest_.x, size.x), std::max(largest_.y, size.y)};
  } else {
    shown_.add(view_of(bare_picture(frame)));
  }
}

void FrameSurvey::add_values(const Frame& frame) {
  if (view_.field->of == FieldKind::Of::contact) {
    for (const Vec2 force : node_vectors(frame, view_.field->array)) {
      if (std::isfinite(length(force))) longest_force_ = std::max(longest_force_, length(force));
    }
  }
  if (!view_.field->has_values()) return;
  std::vector<double> values = element_values(frame, *view_.field);
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.empty()) return;
  low_ = std::min(low_, quantile(values, 0.01));
  high_ = std::max(high_, quantile(values, 0.99));
}

Extent FrameSurvey::view_for(const Frame& frame) const {
  if (view_.view) return *view_.view;
  if (!view_.follow) return shown_;
  const Vec2 middle = middle_of_body(frame, *view_.follow);
  const double around = 0.15 * std::max(largest_.x, largest_.y);
  return Extent{middle - 0.5 * largest_, middle + 0.5 * largest_}.grown(around);
}

void FrameSurvey::paint(const Frame& frame, Picture& picture) const {
  const FieldKind& kind = *view_.field;
  if (kind.of == FieldKind::Of::flow) {
    picture.highlight = PictureHighlight{"flows now", flow_flags(frame), "has flowed", "never flowed"};
    return;
  }
  if (kind.of == FieldKind::Of::contact) {
    picture.forces = PictureForces{frame.bodies.points, node_vectors(frame, kind.array), longest_force_};
    return;
  }
  if (!kind.has_values()) return;
  const double largest =
      view_.range ? std::max(std::fabs(view_.range->first), std::fabs(view_.range->second)) : std::max(-low_, high_);
  const HumanUnit unit = view_.unit ? *view_.unit : human_unit(kind.unit, largest);
  // Round in the unit that is shown.
  const auto [low, high] = view_.range ? std::pair{view_.range->first / unit.size, view_.range->second / unit.size}
                                       : round_range(low_ / unit.size, high_ / unit.size);
  PictureField field{.name = std::string(kind.caption),
                     .unit = unit.name,
                     .values = view_.smooth ? node_values(frame, kind) : element_values(frame, kind),
                     .min = low,
                     .max = high};
  for (double& value : field.values) value /= unit.size;
  const bool about_zero = low < 0 && std::fabs(low + high) <= 1e-9 * high;
  field.colours = about_zero ? ColourMap::two_sided : ColourMap::rising;
  field.at_points = view_.smooth;
  picture.field = std::move(field);
}

Picture FrameSurvey::picture_of(const Frame& frame) const {
  Picture picture = bare_picture(frame);
  picture.subtitle = "t = " + human_text(frame.time, "s", 4);
  if (view_.field->of == FieldKind::Of::flow) picture.subtitle += ", " + std::string(view_.field->caption);
  picture.mesh = view_.mesh;
  picture.view = view_for(frame);
  paint(frame, picture);
  return picture;
}

}  // namespace udar

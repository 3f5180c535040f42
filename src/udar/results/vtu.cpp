#include "udar/results/vtu.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "udar/results/run_folder.hpp"

namespace udar {

void VtuGrid::add_cell(VtuCell kind, std::span<const std::int32_t> points_of_cell) {
  corners.insert(corners.end(), points_of_cell.begin(), points_of_cell.end());
  ends.push_back(static_cast<std::int32_t>(corners.size()));
  kinds.push_back(static_cast<std::uint8_t>(kind));
}

void VtuGrid::add_polygon(std::span<const Vec2> outline) {
  std::vector<std::int32_t> numbers;
  for (const Vec2 point : outline) {
    numbers.push_back(static_cast<std::int32_t>(points.size()));
    points.push_back(point);
  }
  add_cell(VtuCell::polygon, numbers);
}

VtuGrid triangle_grid(double time, std::vector<Vec2> points, std::span<const std::array<std::int32_t, 3>> triangles) {
  VtuGrid grid;
  grid.time = time;
  grid.points = std::move(points);
  for (const auto& triangle : triangles) grid.add_cell(VtuCell::triangle, triangle);
  return grid;
}

std::string field_name(std::string_view quantity, std::string_view unit) {
  std::string out(quantity);
  if (!unit.empty()) {
    out += '_';
    for (const char c : unit) out += c == '/' ? std::string("_per_") : c == '^' ? std::string() : std::string(1, c);
  }
  out = safe_name(out);
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c == '.' || c == '-'; }, '_');
  return out;
}

VtuArray scalar_field(std::string_view quantity, std::string_view unit, std::span<const double> values) {
  std::vector<float> out(values.size());
  std::transform(values.begin(), values.end(), out.begin(), as_float);
  return {field_name(quantity, unit), 1, std::move(out)};
}

VtuArray vector_field(std::string_view quantity, std::string_view unit, std::span<const Vec2> values) {
  std::vector<double> flat;
  flat.reserve(3 * values.size());
  for (const Vec2 value : values) flat.insert(flat.end(), {value.x, value.y, 0.0});
  VtuArray field = scalar_field(quantity, unit, flat);
  field.components = 3;
  return field;
}

VtuArray number_field(std::string_view name, std::span<const std::int32_t> values) {
  return {field_name(name, ""), 1, std::vector<std::int32_t>(values.begin(), values.end())};
}

VtuArray flag_field(std::string_view name, std::span<const std::uint8_t> values) {
  return {field_name(name, ""), 1, std::vector<std::uint8_t>(values.begin(), values.end())};
}

}  // namespace udar

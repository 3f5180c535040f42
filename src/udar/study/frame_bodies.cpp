#include "udar/study/frame_bodies.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "udar/base/error.hpp"

namespace udar {
namespace {

std::vector<double> as_numbers(const VtuArray& array) {
  return std::visit([](const auto& values) { return std::vector<double>(values.begin(), values.end()); }, array.values);
}

OutputError missing(const RunFrames& run, const Frame& frame, const std::string& name) {
  return OutputError(
      fmt::format("the frame of `{}` at {} s has no field `{}`\n  = run the case again with this version of Udar",
                  run.files().folder.string(), frame.time, name));
}

/// An array that every frame has. Its length is that of the frame: read_vtu checks it.
const VtuArray& needed(const RunFrames& run, const Frame& frame, const std::vector<VtuArray>& arrays,
                       const std::string& name, int components) {
  const VtuArray* const array = find_array(arrays, name);
  if (array != nullptr && array->components == components) return *array;
  throw missing(run, frame, name);
}

struct RestPlaces {
  std::vector<Vec2> places;  ///< m
  std::vector<double> blur;  ///< m
};

/// A displacement of 32 bits is off by 2^-24 of its size at most, here of both runs and in two directions; places of 64
/// bits come from sums of a few terms of their size.
RestPlaces rest_places(const RunFrames& run, const Frame& frame) {
  const std::vector<double> moved = as_numbers(needed(run, frame, frame.bodies.point_fields, "displacement_m", 3));
  RestPlaces rest;
  for (std::size_t i = 0; i < frame.bodies.points.size(); ++i) {
    const Vec2 displacement{moved[3 * i], moved[3 * i + 1]};
    const Vec2 place = frame.bodies.points[i] - displacement;
    if (!std::isfinite(place.x) || !std::isfinite(place.y)) {
      throw OutputError(
          fmt::format("a node of `{}` has no place in the frame at {} s", run.files().folder.string(), frame.time));
    }
    rest.places.push_back(place);
    rest.blur.push_back(0x1p-22 * length(displacement) + 0x1p-40 * length(frame.bodies.points[i]));
  }
  return rest;
}

FrameBody named_body(const RunFrames& run, const Frame& frame, int number) {
  FrameBody body{.number = number, .name = {}, .rigid = false, .mesh = {}, .box = {}, .blur = 0};
  const auto at = static_cast<std::size_t>(number);
  if (run.files().summary && at < run.files().summary->bodies.size()) body.name = run.files().summary->bodies[at].name;
  body.rigid = at < frame.rigid.size() && frame.rigid[at] != 0;
  return body;
}

}  // namespace

std::vector<FrameBody> bodies_of(const RunFrames& run, const Frame& frame) {
  const VtuArray& array = needed(run, frame, frame.bodies.cell_fields, "body", 1);
  const auto* const numbers = std::get_if<std::vector<std::int32_t>>(&array.values);
  if (numbers == nullptr) throw missing(run, frame, "body");
  const RestPlaces rest = rest_places(run, frame);
  std::map<std::int32_t, FrameBody> bodies;
  for (std::size_t t = 0; t < frame.triangles.size(); ++t) {
    const std::int32_t number = (*numbers)[t];
    const auto [found, is_new] = bodies.try_emplace(number);
    FrameBody& body = found->second;
    if (is_new) body = named_body(run, frame, number);
    body.mesh.nodes.push_back(frame.triangles[t]);
    body.mesh.numbers.push_back(static_cast<std::int32_t>(t));
    std::array<Vec2, 3>& corners = body.mesh.corners.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      const auto node = static_cast<std::size_t>(frame.triangles[t][c]);
      corners[c] = rest.places[node];
      body.box.include(corners[c]);
      body.blur = std::max(body.blur, rest.blur[node]);
    }
  }
  std::vector<FrameBody> all;
  for (auto& entry : bodies) all.push_back(std::move(entry.second));
  return all;
}

std::optional<FrameField> area_field(const VtuArray& array) {
  if (std::holds_alternative<std::vector<std::int32_t>>(array.values)) return std::nullopt;
  if (array.name.starts_with("contact_") || array.components < 1) return std::nullopt;
  FrameField field{array.name, "", static_cast<std::size_t>(array.components), as_numbers(array)};
  constexpr std::array<std::string_view, 5> units{"m/s^2", "m/s", "Pa", "N", "m"};
  for (const std::string_view unit : units) {
    const std::string ending = field_name("", unit);
    if (!field.name.ends_with(ending) || field.name.size() == ending.size()) continue;
    field.name.resize(field.name.size() - ending.size());
    field.unit = unit;
    break;
  }
  return field;
}

const VtuArray* find_array(const std::vector<VtuArray>& arrays, const std::string& name) {
  const auto at = std::find_if(arrays.begin(), arrays.end(), [&](const VtuArray& a) { return a.name == name; });
  return at == arrays.end() ? nullptr : &*at;
}

}  // namespace udar

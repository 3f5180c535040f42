#pragma once

#include <fmt/core.h>

#include <concepts>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "udar/base/error.hpp"
#include "udar/base/vec2.hpp"

namespace udar {

// Structs as JSON and back. One list of names for each struct serves both: a template for_each_member(T&, visit) that
// calls `visit(name, member)` for every member.

using Json = nlohmann::ordered_json;

/// T is `Plain`, const or not: what for_each_member of a struct is made for.
template <class T, class Plain>
concept Is = std::same_as<std::remove_const_t<T>, Plain>;

inline Json json_of(double value) {
  return value;  // NaN and infinities become null in the text
}
inline Json json_of(const Vec2& value) { return Json::array({value.x, value.y}); }
template <class T>
requires std::integral<T> || std::same_as<T, std::string> Json json_of(const T& value) { return value; }
template <class T>
Json json_of(const std::vector<T>& values);
template <class T>
Json json_of(const std::map<std::string, T>& values);
template <class T>
requires requires(T& s) {
  for_each_member(s, [](const char*, auto&) {});
}
Json json_of(const T& value) {
  Json out = Json::object();
  for_each_member(value, [&](const char* name, const auto& member) { out[name] = json_of(member); });
  return out;
}
template <class T>
Json json_of(const std::vector<T>& values) {
  Json out = Json::array();
  for (const T& value : values) out.push_back(json_of(value));
  return out;
}
template <class T>
Json json_of(const std::map<std::string, T>& values) {
  Json out = Json::object();
  for (const auto& [name, value] : values) out[name] = json_of(value);
  return out;
}

inline void check_json(bool right) {
  if (!right) throw OutputError("a list or a table is missing");
}

/// Missing and unknown names are passed over. Throws OutputError, which names the place, where a value of a struct is
/// of another kind or no number that its member holds; Json::exception where what is read is no struct and of another
/// kind.
inline void read_json(const Json& json, double& value) {
  value = json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}
inline void read_json(const Json& json, Vec2& value) {
  read_json(json.at(0), value.x);
  read_json(json.at(1), value.y);
}
template <class T>
requires std::same_as<T, bool> || std::same_as<T, std::string>
void read_json(const Json& json, T& value) { value = json.get<T>(); }
template <std::integral T>
requires(!std::same_as<T, bool>) void read_json(const Json& json, T& value) {
  // Asked for an integer, the library turns any number into one; of 1e75 that is undefined.
  const bool fits = json.is_number_unsigned() ? std::in_range<T>(json.get<std::uint64_t>())
                                              : json.is_number_integer() && std::in_range<T>(json.get<std::int64_t>());
  if (!fits) throw OutputError("a number is not whole or too large");
  value = json.get<T>();
}
template <class T>
void read_json(const Json& json, std::vector<T>& values);
template <class T>
void read_json(const Json& json, std::map<std::string, T>& values);
template <class T>
requires requires(T& s) {
  for_each_member(s, [](const char*, auto&) {});
}
void read_json(const Json& json, T& value) {
  check_json(json.is_object());
  for_each_member(value, [&](const char* name, auto& member) {
    try {
      if (json.contains(name)) read_json(json.at(name), member);
    } catch (const OutputError& error) {
      throw OutputError(fmt::format("{}: {}", name, error.what()));
    } catch (const Json::exception& error) {
      throw OutputError(fmt::format("{}: {}", name, error.what()));
    }
  });
}
template <class T>
void read_json(const Json& json, std::vector<T>& values) {
  check_json(json.is_array());
  for (const Json& item : json) read_json(item, values.emplace_back());
}
template <class T>
void read_json(const Json& json, std::map<std::string, T>& values) {
  check_json(json.is_object());
  for (const auto& [name, item] : json.items()) read_json(item, values[name]);
}

}  // namespace udar

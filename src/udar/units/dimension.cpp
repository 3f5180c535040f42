#include "udar/units/dimension.hpp"

#include <cstdlib>
#include <string_view>
#include <vector>

namespace udar {
namespace {

struct Named {
  Dimension dimension;
  std::string_view name;
  std::string_view unit;
  std::string_view example;
};

constexpr Named named[] = {
    {dimension::number, "a plain number", "", "0.25"},
    {dimension::angle, "an angle", "rad", "\"35 deg\""},
    {dimension::length, "a length", "m", "\"1 cm\""},
    {dimension::time, "a time", "s", "\"2 ms\""},
    {dimension::mass, "a mass", "kg", "\"3 kg\""},
    {dimension::velocity, "a velocity", "m/s", "\"80 m/s\""},
    {dimension::acceleration, "an acceleration", "m/s^2", "\"9.81 m/s^2\""},
    {dimension::rate, "a rate", "1/s", "\"50 1/s\""},
    {dimension::spin, "a spin", "rad/s", "\"20 rad/s\""},
    {dimension::wave_number, "a wave number", "rad/m", "\"15 rad/m\""},
    {dimension::density, "a density", "kg/m^3", "\"7850 kg/m^3\""},
    {dimension::force, "a force", "N", "\"5 kN\""},
    {dimension::stress, "a stress", "Pa", "\"210 GPa\""},
    {dimension::stiffness, "a stiffness", "N/m", "\"2e6 kgf/cm\""},
    {{0, 2, 0}, "an area", "m^2", "\"4 cm^2\""},
    {{0, 3, 0}, "a volume", "m^3", "\"4 cm^3\""},
    {{1, 1, -1}, "a momentum", "N s", "\"3 N s\""},
    {{1, 2, -2}, "an energy", "J", "\"5 kJ\""},
    {{1, 2, -3}, "a power", "W", "\"5 kW\""},
};

const Named* find_named(Dimension dimension) {
  for (const Named& n : named) {
    if (n.dimension == dimension) return &n;
  }
  if (dimension.angle == 0) return nullptr;
  dimension.angle = 0;
  return find_named(dimension);
}

}  // namespace

std::string dimension_name(Dimension dimension) {
  if (const Named* n = find_named(dimension)) return std::string(n->name);
  return "a quantity in " + si_unit(dimension);
}

std::string si_unit(Dimension dimension) {
  if (const Named* n = find_named(dimension)) return std::string(n->unit);
  std::string above;
  std::string below;
  const auto append = [&](std::string_view unit, int exponent) {
    std::string& side = exponent > 0 ? above : below;
    if (exponent == 0) return;
    side += (side.empty() ? "" : " ") + std::string(unit);
    if (std::abs(exponent) != 1) side += "^" + std::to_string(std::abs(exponent));
  };
  append("kg", dimension.mass);
  append("m", dimension.length);
  append("s", dimension.time);
  if (below.empty()) return above;
  if (above.empty()) above = "1";
  return above + "/" + (below.find(' ') == std::string::npos ? below : "(" + below + ")");
}

std::string example_of(Dimension dimension) {
  if (const Named* n = find_named(dimension)) return std::string(n->example);
  return "\"1 " + si_unit(dimension) + "\"";
}

}  // namespace udar

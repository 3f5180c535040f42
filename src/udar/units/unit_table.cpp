#include "udar/units/unit_table.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

namespace udar {
namespace {

struct Prefix {
  char letter;
  Scale scale;
};

constexpr Prefix prefixes[] = {{'G', {1e9, 1}}, {'M', {1e6, 1}},  {'k', {1e3, 1}}, {'h', {100, 1}}, {'d', {1, 10}},
                               {'c', {1, 100}}, {'m', {1, 1000}}, {'u', {1, 1e6}}, {'n', {1, 1e9}}};

struct NamedUnit {
  std::string_view name;
  Scale scale;
  Dimension dimension;
  std::string_view prefixes = "";
};

constexpr Dimension energy{1, 2, -2};
constexpr Dimension power{1, 2, -3};
constexpr Dimension volume{0, 3, 0};
constexpr double pi = std::numbers::pi;

// Frequencies (Hz) are left out on purpose: "5 Hz" for a spin would leave in doubt whether turns or radians are meant.
constexpr NamedUnit units[] = {
    {"m", {1, 1}, dimension::length, "kdcmun"},
    {"in", {254, 1e4}, dimension::length},
    {"ft", {3048, 1e4}, dimension::length},
    {"yd", {9144, 1e4}, dimension::length},
    {"mi", {1609344, 1e3}, dimension::length},
    {"l", {1, 1e3}, volume, "m"},
    {"L", {1, 1e3}, volume, "m"},
    {"s", {1, 1}, dimension::time, "mun"},
    {"min", {60, 1}, dimension::time},
    {"h", {3600, 1}, dimension::time},
    {"g", {1, 1e3}, dimension::mass, "kmu"},
    {"t", {1e3, 1}, dimension::mass},
    {"lb", {45359237, 1e8}, dimension::mass},
    {"lbm", {45359237, 1e8}, dimension::mass},
    {"N", {1, 1}, dimension::force, "GMkmu"},
    {"dyn", {1, 1e5}, dimension::force},
    {"gf", {980665, 1e8}, dimension::force, "k"},
    {"tf", {980665, 100}, dimension::force},
    {"lbf", {45359237.0 * 980665, 1e13}, dimension::force},
    {"kip", {45359237.0 * 980665, 1e10}, dimension::force},
    {"Pa", {1, 1}, dimension::stress, "GMkhm"},
    {"bar", {1e5, 1}, dimension::stress, "km"},
    {"atm", {101325, 1}, dimension::stress},
    {"at", {980665, 10}, dimension::stress},
    {"psi", {45359237.0 * 980665 / 10, 254.0 * 254 * 1e4}, dimension::stress},
    {"ksi", {45359237.0 * 980665 * 100, 254.0 * 254 * 1e4}, dimension::stress},
    {"J", {1, 1}, energy, "GMkm"},
    {"W", {1, 1}, power, "GMkm"},
    {"rad", {1, 1}, dimension::angle, "mu"},
    {"deg", {pi, 180}, dimension::angle},
    {"rev", {2 * pi, 1}, dimension::angle},
    {"rpm", {pi, 30}, dimension::spin},
    {"%", {1, 100}, dimension::number},
};

}  // namespace

Scale operator*(Scale a, Scale b) {
  Scale out{a.numerator * b.numerator, a.denominator * b.denominator};
  constexpr double largest_exact = 0x1p53;
  const auto whole = [](double v) { return v == std::floor(v) && v <= largest_exact; };
  if (!whole(out.numerator) || !whole(out.denominator)) return out;  // pi, or too many factors
  const auto divisor = static_cast<double>(
      std::gcd(static_cast<std::int64_t>(out.numerator), static_cast<std::int64_t>(out.denominator)));
  return {out.numerator / divisor, out.denominator / divisor};
}

std::optional<int> Scale::power_of_ten() const {
  int k = 0;
  double rest = numerator;
  for (; rest > 1 && std::fmod(rest, 10) == 0; rest /= 10) ++k;
  if (rest != 1) return std::nullopt;
  for (rest = denominator; rest > 1 && std::fmod(rest, 10) == 0; rest /= 10) --k;
  if (rest != 1) return std::nullopt;
  return k;
}

std::optional<Unit> find_unit(std::string_view name) {
  for (const NamedUnit& u : units) {
    if (u.name == name) return Unit{u.scale * Scale{}, u.dimension};
  }
  for (const Prefix& p : prefixes) {
    if (name.empty() || name.front() != p.letter) continue;
    for (const NamedUnit& u : units) {
      if (u.name != name.substr(1) || u.prefixes.find(p.letter) == std::string_view::npos) continue;
      return Unit{u.scale * p.scale, u.dimension};
    }
  }
  return std::nullopt;
}

const std::vector<std::string>& unit_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const NamedUnit& u : units) {
      all.emplace_back(u.name);
      for (const char prefix : u.prefixes) all.push_back(prefix + std::string(u.name));
    }
    return all;
  }();
  return names;
}

}  // namespace udar

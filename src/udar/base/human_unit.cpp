#include "udar/base/human_unit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace udar {
namespace {

struct Prefix {
  std::string_view letters;
  int power;
};
// Only every third power: what a scale is read in.
constexpr std::array<Prefix, 7> prefixes{{{"n", -9}, {"µ", -6}, {"m", -3}, {"", 0}, {"k", 3}, {"M", 6}, {"G", 9}}};

/// Units that people say with prefixes, from the smallest power to the largest.
struct Spoken {
  std::string_view unit;
  int least;
  int most;
};
constexpr std::array<Spoken, 7> spoken{
    {{"s", -9, 0}, {"m", -6, 3}, {"Pa", 0, 6}, {"N", -3, 6}, {"J", -3, 9}, {"N s", -3, 6}, {"N m", -3, 6}}};

std::string superscript(int number) {
  constexpr std::array<std::string_view, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = number < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(number))) out += digits[static_cast<std::size_t>(c - '0')];
  return out;
}

}  // namespace

std::string typeset(std::string_view unit) {
  std::string out;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const bool power = unit[i] == '^' && i + 1 < unit.size() && unit[i + 1] >= '0' && unit[i + 1] <= '9';
    if (power) {
      out += superscript(unit[++i] - '0');
    } else {
      out += unit[i];
    }
  }
  return out;
}

HumanUnit human_unit(std::string_view si_unit, double largest) {
  if (!(largest > 0) || !std::isfinite(largest)) return {typeset(si_unit), 1};
  const auto of = std::find_if(spoken.begin(), spoken.end(), [&](const Spoken& s) { return s.unit == si_unit; });
  if (of != spoken.end()) {
    // The largest power that leaves 1 or more.
    int power = of->least;
    while (power + 3 <= of->most && largest >= 0.9999 * std::pow(10, power + 3)) power += 3;
    const auto prefix =
        std::find_if(prefixes.begin(), prefixes.end(), [&](const Prefix& p) { return p.power == power; });
    return {std::string(prefix->letters) + typeset(si_unit), std::pow(10, power)};
  }
  if (largest >= 1e-3 && largest < 1e5) return {typeset(si_unit), 1};
  const int power = 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
  const std::string times = "10" + superscript(power);
  return {si_unit.empty() ? times : times + " " + typeset(si_unit), std::pow(10, power)};
}

std::string human_text(double value, std::string_view si_unit, int digits) {
  const HumanUnit unit = human_unit(si_unit, std::fabs(value));
  const double shown = value / unit.size;
  // No exponent below 10^6: "1230", not "1.23e+03".
  const double size = std::fabs(shown);
  std::string number = fmt::format("{:.{}g}", shown, digits);
  if (number.find('e') != std::string::npos && size >= 1 && size < 1e6) {
    const double last = std::pow(10, std::floor(std::log10(size)) + 1 - digits);
    number = fmt::format("{:.0f}", last * std::round(shown / last));
  }
  if (unit.name.starts_with("10")) number += " ·";
  return unit.name.empty() ? number : number + " " + unit.name;
}

}  // namespace udar

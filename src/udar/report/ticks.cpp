#include "udar/report/ticks.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace udar {
namespace {

/// The smallest of 1, 2, 5 times a power of ten that is not below `value`.
double round_up(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= value * (1 - 1e-9)) return digit * power;
  }
  return 10 * power;
}

/// Sizes whose powers of ten, ranges and sums are numbers.
constexpr double largest = 1e300;
constexpr double smallest = 1e-290;

double bounded(double value) { return std::isnan(value) ? 0 : std::clamp(value, -largest, largest); }

}  // namespace

std::string Ticks::text(double value) const {
  if (logarithmic) return fmt::format("{:.4g}", value);
  if (std::fabs(value) < 1e-9 * step) return "0";
  const double furthest = std::max(std::fabs(values.front()), std::fabs(values.back()));
  if (furthest >= 1e6 || furthest < 1e-4) return fmt::format("{:.4g}", value);
  const int digits = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  std::string number = fmt::format("{:.{}f}", value, digits);
  if (number[0] == '-') number = "−" + number.substr(1);
  return number;
}

Ticks ticks_over(double low, double high, int wanted) {
  low = bounded(low);
  high = bounded(high);
  // What differs by rounding only is one value. Ticks between would be multiples beyond 2^53, where adding 1 changes
  // nothing, and there would be no end of them.
  const double size = std::max(std::fabs(low), std::fabs(high));
  if (!(high - low > std::max(1e-12 * size, smallest))) high = low + (size < smallest ? 1 : size);
  Ticks ticks;
  ticks.step = round_up((high - low) / std::max(1, wanted));
  // Whole multiples, so that no rounding adds up; a hair outside still counts as on the tick.
  const double first = std::floor(low / ticks.step + 1e-9);
  const double last = std::ceil(high / ticks.step - 1e-9);
  for (double k = first; k <= last; ++k) ticks.values.push_back(k * ticks.step);
  return ticks;
}

Ticks ticks_within(double low, double high, int wanted) {
  Ticks ticks = ticks_over(low, high, wanted);
  const double hair = 1e-9 * ticks.step;
  std::erase_if(ticks.values, [&](double v) { return v < low - hair || v > high + hair; });
  if (ticks.values.empty()) ticks.values.push_back(low);
  return ticks;
}

Ticks log_ticks_over(double low, double high) {
  low = std::clamp(low, smallest, largest);
  high = std::clamp(high, smallest, largest);
  if (!(high > low)) high = 10 * low;
  const double first = std::floor(std::log10(low) + 1e-9);
  const double last = std::ceil(std::log10(high) - 1e-9);
  constexpr double few = 3;  // decades
  const double stride = std::max(1.0, std::ceil((last - first) / 8));
  Ticks ticks;
  ticks.logarithmic = true;
  for (double power = first; power < last + stride; power += stride) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      if (digit > 1 && last - first > few) break;
      ticks.values.push_back(digit * std::pow(10, power));
    }
  }
  // Only as far as the next tick outside.
  const double hair = 1e-9;
  while (ticks.values.size() > 2 && ticks.values[1] <= low * (1 + hair)) ticks.values.erase(ticks.values.begin());
  while (ticks.values.size() > 2 && ticks.values[ticks.values.size() - 2] >= high * (1 - hair)) ticks.values.pop_back();
  return ticks;
}

}  // namespace udar

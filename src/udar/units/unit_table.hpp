#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "udar/units/dimension.hpp"

namespace udar {

/// How many SI units one unit is, as a fraction of two numbers without rounding and without common divisor.
struct Scale {
  double numerator = 1;
  double denominator = 1;
  [[nodiscard]] double apply(double value) const { return value * numerator / denominator; }
  /// k where the scale is 10^k.
  [[nodiscard]] std::optional<int> power_of_ten() const;
};

Scale operator*(Scale a, Scale b);

struct Unit {
  Scale scale;
  Dimension dimension;
};

/// The unit called `name` ("kgf", "mm"), with its prefix if it has one.
std::optional<Unit> find_unit(std::string_view name);

/// Every name that find_unit knows, prefixes included.
const std::vector<std::string>& unit_names();

}  // namespace udar

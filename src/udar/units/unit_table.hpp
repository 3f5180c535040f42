#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "udar/units/dimension.hpp"

namespace udar {

/// How many SI units one unit is, as a fraction of two numbers without rounding: 0.25 cm is 0.25 / 100, the double
/// nearest to 0.0025, which 0.25 * 0.01 need not be.
struct Scale {
  double numerator = 1;
  double denominator = 1;
  [[nodiscard]] double apply(double value) const { return value * numerator / denominator; }
};

struct Unit {
  Scale scale;
  Dimension dimension;
};

/// The unit called `name` ("kgf", "mm"), with its prefix if it has one.
std::optional<Unit> find_unit(std::string_view name);

/// Every name that find_unit knows, prefixes included.
const std::vector<std::string>& unit_names();

}  // namespace udar

#pragma once

#include <string>
#include <vector>

namespace udar {

/// Round values along an axis: multiples of 1, 2 or 5 times a power of ten.
struct Ticks {
  double step = 1;
  std::vector<double> values;  ///< rising; the first at or below the range, the last at or above it
  bool logarithmic = false;    ///< each is written as it is: `step` means nothing

  /// The value with as many digits as the step needs.
  [[nodiscard]] std::string text(double value) const;
};

/// Ticks that cover `low` to `high`, `wanted` or somewhat fewer intervals.
Ticks ticks_over(double low, double high, int wanted);
/// Only those within `low` to `high`.
Ticks ticks_within(double low, double high, int wanted);
/// Of a logarithmic axis from `low` to `high`, both positive: powers of ten and, where these are few, 2 and 5 times
/// them; the first at or below the range, the last at or above it.
Ticks log_ticks_over(double low, double high);

}  // namespace udar

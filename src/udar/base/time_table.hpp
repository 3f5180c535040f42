#pragma once

#include <vector>

namespace udar {

/// A value that changes with time: straight lines between the points, or pieces without a jump in velocity or
/// acceleration (C2: s^3 (10 - 15 s + 6 s^2)). Before the first and after the last point the value stays.
struct TimeTable {
  enum class Shape { linear, smooth };
  std::vector<double> times;   ///< s, strictly rising; empty: the value is 0 for ever
  std::vector<double> values;  ///< as many as times; unit of what the table drives
  Shape shape = Shape::linear;

  /// The value at `time` (s).
  [[nodiscard]] double at(double time) const;
  /// A value that never changes.
  static TimeTable constant(double value) { return {{0.0}, {value}, Shape::linear}; }
};

}  // namespace udar

#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace udar {

// Histories compared as curves. Rows of two runs hardly ever have the same times, so each history is taken as what it
// looks like in a plot: straight lines between its rows. All integrals of such curves are exact; nothing is resampled,
// and no weight depends on how many rows there are. docs/diff.md has the formulas.

/// Rows of a history: values over times, s. Both have the same length.
struct HistoryView {
  std::span<const double> times;
  std::span<const double> values;
};

/// A history as a curve: finite rows only, times never falling. Two rows of one time are a jump.
struct Curve {
  std::vector<double> times;  ///< s
  std::vector<double> values;
  std::size_t left_out = 0;  ///< rows that were not finite, or whose time is before the one above

  [[nodiscard]] HistoryView view() const { return {times, values}; }
};

/// The curve through the finite rows, its times minus `shift`, s: the first touch of a run, to lay runs over each
/// other.
Curve curve_of(HistoryView rows, double shift = 0);

/// The part between two times, with rows at both where the curve has them inside. Empty where it is elsewhere.
Curve cut_to(const Curve& curve, double from, double to);

/// Mean of the curve over a window of `window` seconds around each of the times (those of the curve itself where none
/// are given), from the exact integral of the straight lines. At the ends the window is cut to what is there.
Curve moving_average(const Curve& curve, double window, std::span<const double> at = {});

/// All times of both, rising, each once.
std::vector<double> union_of_times(const Curve& a, const Curve& b);

/// How far a curve a is from b over the times that both have; in the unit of the values. NaN where they share no time.
struct HistoryDifference {
  double l2 = std::numeric_limits<double>::quiet_NaN();           ///< sqrt(int (a-b)^2 dt / T)
  double size = std::numeric_limits<double>::quiet_NaN();         ///< sqrt(int b^2 dt / T)
  double size_of_a = std::numeric_limits<double>::quiet_NaN();    ///< sqrt(int a^2 dt / T)
  double max_abs = std::numeric_limits<double>::quiet_NaN();      ///< largest |a-b|
  double time_of_max = std::numeric_limits<double>::quiet_NaN();  ///< s, when it is first as large
  double largest = std::numeric_limits<double>::quiet_NaN();      ///< largest |b|
  double parted = std::numeric_limits<double>::quiet_NaN();  ///< s, first |a-b| > tolerance * largest; NaN: never does
  double from = std::numeric_limits<double>::quiet_NaN();    ///< s, where the time of both begins
  double span = std::numeric_limits<double>::quiet_NaN();    ///< s, its length T
  std::size_t left_out = 0;                                  ///< rows of both that were left out

  [[nodiscard]] bool compared() const { return span > 0; }
};

/// `tolerance` says when they part, as a part of the largest |b|.
HistoryDifference difference(const Curve& a, const Curve& b, double tolerance = 0.01);

/// l2 over size: 0 where both are 0, infinite where only b is 0.
double relative_l2(const HistoryDifference& d);
/// max_abs over largest, likewise.
double relative_max(const HistoryDifference& d);

/// What is done to two histories before they are compared.
struct HistoryComparison {
  double shift_a = 0;                                      ///< s, taken off the times of a
  double shift_b = 0;                                      ///< s
  double window = 0;                                       ///< s, of a moving average of both; 0: none
  double from = -std::numeric_limits<double>::infinity();  ///< s, after the shifts
  double to = std::numeric_limits<double>::infinity();     ///< s
  double tolerance = 0.01;
};

/// Shifts, cuts both to the time they share, averages them at the times of both and compares what lies between `from`
/// and `to`. The cut comes first: else the ends of a shorter history would be averaged over less than those of the
/// other.
HistoryDifference compare_histories(HistoryView a, HistoryView b, const HistoryComparison& how = {});

}  // namespace udar

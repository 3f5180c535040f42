#include "udar/study/history_difference.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

namespace udar {
namespace {

/// The value in the line between rows i and i + 1. Exact at both rows, so that a curve differs by 0 from itself.
double value_in(const Curve& c, std::size_t i, double t) {
  const double t0 = c.times[i];
  const double t1 = c.times[i + 1];
  if (t <= t0) return c.values[i];
  if (t >= t1) return c.values[i + 1];
  const double part = (t - t0) / (t1 - t0);
  return (1 - part) * c.values[i] + part * c.values[i + 1];
}

/// The last line that begins at or before `t`; there are at least two rows.
std::size_t line_at(const Curve& c, double t) {
  const auto after = std::upper_bound(c.times.begin(), c.times.end(), t) - c.times.begin();
  return std::clamp<std::size_t>(static_cast<std::size_t>(after), 1, c.times.size() - 1) - 1;
}

/// Both curves in a time in which both are straight.
struct Piece {
  double t0, t1;
  double a0, a1;
  double b0, b1;
};

/// Goes through the time that both have, from one row of either to the next.
template <class Visit>
void for_each_piece(const Curve& a, const Curve& b, double from, double to, Visit visit) {
  std::size_t i = line_at(a, from);
  std::size_t j = line_at(b, from);
  for (double t = from; t < to;) {
    const double next = std::min({a.times[i + 1], b.times[j + 1], to});
    if (next > t)
      visit(Piece{t, next, value_in(a, i, t), value_in(a, i, next), value_in(b, j, t), value_in(b, j, next)});
    t = std::max(t, next);
    while (i + 2 < a.times.size() && a.times[i + 1] <= t) ++i;
    while (j + 2 < b.times.size() && b.times[j + 1] <= t) ++j;
  }
}

/// The integral of the square of a line over its length, by Simpson's rule, which is exact here.
double square_of_line(double v0, double v1) { return (v0 * v0 + v0 * v1 + v1 * v1) / 3; }

/// When the line from d0 to d1 first leaves -limit..limit; NaN where it stays.
double time_of_leaving(double t0, double t1, double d0, double d1, double limit) {
  if (std::fabs(d0) > limit) return t0;
  if (!(std::fabs(d1) > limit)) return std::numeric_limits<double>::quiet_NaN();
  const double part = (std::copysign(limit, d1) - d0) / (d1 - d0);
  return t0 + (t1 - t0) * std::clamp(part, 0.0, 1.0);
}

/// Integral of the curve from its begin to each row.
std::vector<double> running_integral(const Curve& c) {
  std::vector<double> sums(c.times.size(), 0.0);
  for (std::size_t i = 1; i < sums.size(); ++i) {
    sums[i] = sums[i - 1] + (c.times[i] - c.times[i - 1]) * (0.5 * c.values[i - 1] + 0.5 * c.values[i]);
  }
  return sums;
}

/// Integral of the line i between two times in it.
double integral_in(const Curve& c, std::size_t i, double from, double to) {
  return (to - from) * (0.5 * value_in(c, i, from) + 0.5 * value_in(c, i, to));
}

void note_largest(HistoryDifference& d, double value, double time) {
  if (!(std::fabs(value) > d.max_abs)) return;
  d.max_abs = std::fabs(value);
  d.time_of_max = time;
}

double ratio(double difference, double size) {
  if (difference == 0) return 0;
  return size == 0 ? std::numeric_limits<double>::infinity() : difference / size;
}

}  // namespace

Curve curve_of(HistoryView rows, double shift) {
  assert(rows.times.size() == rows.values.size());
  Curve curve;
  curve.times.reserve(rows.times.size());
  curve.values.reserve(rows.times.size());
  for (std::size_t i = 0; i < rows.times.size(); ++i) {
    const double t = rows.times[i] - shift;
    const bool falls = !curve.times.empty() && t < curve.times.back();
    if (!std::isfinite(t) || !std::isfinite(rows.values[i]) || falls) {
      ++curve.left_out;
      continue;
    }
    curve.times.push_back(t);
    curve.values.push_back(rows.values[i]);
  }
  return curve;
}

Curve cut_to(const Curve& curve, double from, double to) {
  Curve part;
  part.left_out = curve.left_out;
  if (curve.times.size() < 2 || !(from <= to) || from > curve.times.back() || to < curve.times.front()) return part;
  const auto add = [&](double t, double value) {
    part.times.push_back(t);
    part.values.push_back(value);
  };
  const auto first = std::lower_bound(curve.times.begin(), curve.times.end(), from) - curve.times.begin();
  const auto end = std::upper_bound(curve.times.begin(), curve.times.end(), to) - curve.times.begin();
  const auto i = static_cast<std::size_t>(first);
  const auto last = static_cast<std::size_t>(end);
  if (i > 0 && curve.times[i] > from) add(from, value_in(curve, i - 1, from));
  for (std::size_t k = i; k < last; ++k) add(curve.times[k], curve.values[k]);
  if (last < curve.times.size() && last > 0 && to > from && curve.times[last - 1] < to) {
    add(to, value_in(curve, last - 1, to));
  }
  return part;
}

Curve moving_average(const Curve& curve, double window, std::span<const double> at) {
  Curve mean;
  mean.left_out = curve.left_out;
  if (at.empty()) at = curve.times;
  mean.times.assign(at.begin(), at.end());
  mean.values.assign(at.size(), std::numeric_limits<double>::quiet_NaN());
  if (curve.times.size() < 2) {
    if (curve.times.size() == 1) std::fill(mean.values.begin(), mean.values.end(), curve.values.front());
    return mean;
  }
  const std::vector<double> sums = running_integral(curve);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double from = std::clamp(at[k] - window / 2, curve.times.front(), curve.times.back());
    const double to = std::clamp(at[k] + window / 2, curve.times.front(), curve.times.back());
    const std::size_t i = line_at(curve, from);
    const std::size_t j = line_at(curve, to);
    if (!(from < to)) {
      mean.values[k] = value_in(curve, j, to);
      continue;
    }
    // The differences of the running integral stand only for whole lines: a short window loses no digits.
    const double whole = i == j ? integral_in(curve, i, from, to)
                                : integral_in(curve, i, from, curve.times[i + 1]) + (sums[j] - sums[i + 1]) +
                                      integral_in(curve, j, curve.times[j], to);
    mean.values[k] = whole / (to - from);
  }
  return mean;
}

std::vector<double> union_of_times(const Curve& a, const Curve& b) {
  std::vector<double> times;
  times.reserve(a.times.size() + b.times.size());
  std::merge(a.times.begin(), a.times.end(), b.times.begin(), b.times.end(), std::back_inserter(times));
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

HistoryDifference difference(const Curve& a, const Curve& b, double tolerance) {
  HistoryDifference d;
  d.left_out = a.left_out + b.left_out;
  if (a.times.size() < 2 || b.times.size() < 2) return d;
  const double from = std::max(a.times.front(), b.times.front());
  const double to = std::min(a.times.back(), b.times.back());
  if (!(from < to)) return d;
  d.from = from;
  d.span = to - from;
  d.max_abs = 0;
  d.largest = 0;
  double scale = 0;  // squares of what is as large must not overflow, nor vanish
  for_each_piece(a, b, from, to, [&](const Piece& p) {
    scale = std::max({scale, std::fabs(p.a0), std::fabs(p.a1), std::fabs(p.b0), std::fabs(p.b1)});
    d.largest = std::max({d.largest, std::fabs(p.b0), std::fabs(p.b1)});
  });
  if (scale == 0) scale = 1;
  double square_of_d = 0;
  double square_of_a = 0;
  double square_of_b = 0;
  d.time_of_max = from;
  const double limit = tolerance * d.largest;
  for_each_piece(a, b, from, to, [&](const Piece& p) {
    const double d0 = p.a0 - p.b0;
    const double d1 = p.a1 - p.b1;
    const double length = (p.t1 - p.t0) / d.span;
    square_of_d += length * square_of_line(d0 / scale, d1 / scale);
    square_of_a += length * square_of_line(p.a0 / scale, p.a1 / scale);
    square_of_b += length * square_of_line(p.b0 / scale, p.b1 / scale);
    // A straight difference is largest at an end.
    note_largest(d, d0, p.t0);
    note_largest(d, d1, p.t1);
    if (std::isnan(d.parted)) d.parted = time_of_leaving(p.t0, p.t1, d0, d1, limit);
  });
  d.l2 = scale * std::sqrt(square_of_d);
  d.size_of_a = scale * std::sqrt(square_of_a);
  d.size = scale * std::sqrt(square_of_b);
  return d;
}

double relative_l2(const HistoryDifference& d) { return ratio(d.l2, d.size); }
double relative_max(const HistoryDifference& d) { return ratio(d.max_abs, d.largest); }

HistoryDifference compare_histories(HistoryView rows_a, HistoryView rows_b, const HistoryComparison& how) {
  Curve a = curve_of(rows_a, how.shift_a);
  Curve b = curve_of(rows_b, how.shift_b);
  if (how.window > 0 && a.times.size() > 1 && b.times.size() > 1) {
    const double from = std::max(a.times.front(), b.times.front());
    const double to = std::min(a.times.back(), b.times.back());
    a = cut_to(a, from, to);
    b = cut_to(b, from, to);
    const std::vector<double> times = union_of_times(a, b);
    a = moving_average(a, how.window, times);
    b = moving_average(b, how.window, times);
  }
  if (std::isfinite(how.from) || std::isfinite(how.to)) {
    a = cut_to(a, how.from, how.to);
    b = cut_to(b, how.from, how.to);
  }
  return difference(a, b, how.tolerance);
}

}  // namespace udar

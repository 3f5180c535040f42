#include "udar/verification/checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace udar {
namespace {

/// Slope of the straight line through the points (log size, log error) by least squares.
double slope_through(const std::vector<double>& sizes, const std::vector<double>& errors) {
  const auto count = static_cast<double>(sizes.size());
  double mean_x = 0;
  double mean_y = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    mean_x += std::log(sizes[i]) / count;
    mean_y += std::log(errors[i]) / count;
  }
  double products = 0;
  double squares = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double x = std::log(sizes[i]) - mean_x;
    products += x * (std::log(errors[i]) - mean_y);
    squares += x * x;
  }
  return products / squares;
}

constexpr std::size_t most_points = 2000;

/// At most so many points of a line: the first, the extremes and the last of stretches of equal length.
CheckLine thinned(CheckLine line) {
  const std::size_t count = line.x.size();
  if (count <= most_points) return line;
  CheckLine few{.name = line.name, .exact = line.exact, .x = {}, .y = {}};
  const std::size_t stretches = most_points / 4;
  for (std::size_t k = 0; k < stretches; ++k) {
    const std::size_t begin = k * count / stretches;
    const std::size_t end = (k + 1) * count / stretches;
    const auto [least, most] = std::minmax_element(line.y.begin() + static_cast<std::ptrdiff_t>(begin),
                                                   line.y.begin() + static_cast<std::ptrdiff_t>(end));
    std::array<std::size_t, 4> kept{begin, static_cast<std::size_t>(least - line.y.begin()),
                                    static_cast<std::size_t>(most - line.y.begin()), end - 1};
    std::sort(kept.begin(), kept.end());
    for (std::size_t i = 0; i < kept.size(); ++i) {
      if (i > 0 && kept[i] == kept[i - 1]) continue;
      few.x.push_back(line.x[kept[i]]);
      few.y.push_back(line.y[kept[i]]);
    }
  }
  return few;
}

}  // namespace

double order_of(const ErrorSeries& series, OrderFrom from) {
  const std::size_t count = series.sizes.size();
  if (count < 2 || series.errors.size() != count) return std::nan("");
  for (std::size_t i = 0; i < count; ++i) {
    if (!(series.sizes[i] > 0 && series.errors[i] > 0)) return std::nan("");
  }
  if (from == OrderFrom::fit) return slope_through(series.sizes, series.errors);
  const std::size_t first = from == OrderFrom::ends ? 0 : count - 2;
  return std::log(series.errors[first] / series.errors.back()) / std::log(series.sizes[first] / series.sizes.back());
}

bool Checks::add(CheckRow row) {
  row.holds = is_held(row);
  if (row.kind != CheckKind::order) row.setting = setting_;
  part_.rows.push_back(std::move(row));
  return part_.rows.back().holds;
}

bool Checks::within(const std::string& what, double computed, double exact, double bound, const std::string& unit) {
  const double error = std::fabs(computed - exact) / std::fabs(exact);
  return add({.kind = CheckKind::relative,
              .what = what,
              .unit = unit,
              .computed = computed,
              .exact = exact,
              .error = error,
              .bound = bound});
}

bool Checks::near(const std::string& what, double computed, double exact, double bound, const std::string& unit) {
  const double error = std::fabs(computed - exact);
  return add({.kind = CheckKind::absolute,
              .what = what,
              .unit = unit,
              .computed = computed,
              .exact = exact,
              .error = error,
              .bound = bound});
}

bool Checks::equal(const std::string& what, double computed, double exact, const std::string& unit) {
  return add({.kind = CheckKind::equal, .what = what, .unit = unit, .computed = computed, .exact = exact});
}

bool Checks::at_most(const std::string& what, double computed, double bound, const std::string& unit) {
  return add({.kind = CheckKind::at_most, .what = what, .unit = unit, .computed = computed, .bound = bound});
}

bool Checks::below(const std::string& what, double computed, double bound, const std::string& unit) {
  return add({.kind = CheckKind::below, .what = what, .unit = unit, .computed = computed, .bound = bound});
}

bool Checks::at_least(const std::string& what, double computed, double bound, const std::string& unit) {
  return add({.kind = CheckKind::at_least, .what = what, .unit = unit, .computed = computed, .bound = bound});
}

bool Checks::above(const std::string& what, double computed, double bound, const std::string& unit) {
  return add({.kind = CheckKind::above, .what = what, .unit = unit, .computed = computed, .bound = bound});
}

bool Checks::between(const std::string& what, double computed, double low, double high, const std::string& unit) {
  return add(
      {.kind = CheckKind::between, .what = what, .unit = unit, .computed = computed, .bound = low, .upper = high});
}

bool Checks::order(ErrorSeries series, const OrderBound& bound) {
  series.order = order_of(series, bound.from);
  series.expected = bound.expected;
  const bool held = add({.kind = CheckKind::order,
                         .what = "order of " + series.what,
                         .computed = series.order,
                         .exact = bound.expected,
                         .bound = bound.least,
                         .upper = bound.most});
  part_.series.push_back(std::move(series));
  return held;
}

bool Checks::holds(const std::string& what, bool is_true) {
  return add({.kind = CheckKind::holds, .what = what, .holds = is_true});
}

void Checks::curve(CheckCurve curve) {
  for (CheckLine& line : curve.lines) line = thinned(std::move(line));
  part_.curves.push_back(std::move(curve));
}

void Checks::series(ErrorSeries series) {
  series.order = order_of(series);
  part_.series.push_back(std::move(series));
}

}  // namespace udar

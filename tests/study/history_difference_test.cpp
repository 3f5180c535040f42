#include "udar/study/history_difference.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

using namespace udar;

namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

Curve sampled(double from, double to, int lines, const std::function<double(double)>& f) {
  Curve curve;
  for (int i = 0; i <= lines; ++i) {
    const double t = from + (to - from) * i / lines;
    curve.times.push_back(t);
    curve.values.push_back(f(t));
  }
  return curve;
}

Curve rows(std::vector<double> times, std::vector<double> values) { return {std::move(times), std::move(values), 0}; }

}  // namespace

TEST_CASE("a curve differs from itself by nothing, and from 0 by its own size") {
  const Curve wave = sampled(0, 2 * M_PI, 4000, [](double t) { return std::sin(t); });
  const HistoryDifference same = difference(wave, wave);
  CHECK(same.l2 == 0);
  CHECK(same.max_abs == 0);
  CHECK(std::isnan(same.parted));
  CHECK(relative_l2(same) == 0);

  const HistoryDifference d = difference(rows({0, 7}, {0, 0}), wave, 0.5);
  // The chord of a sine of step h is below it by h^2/12 in the mean at most.
  const double bound = std::pow(2 * M_PI / 4000, 2) / 12 * 2;
  CHECK(d.size == doctest::Approx(std::sqrt(0.5)).epsilon(bound));
  CHECK(d.l2 == doctest::Approx(d.size).epsilon(1e-15));
  CHECK(d.size_of_a == 0);
  CHECK(d.max_abs == 1);
  CHECK(d.time_of_max == doctest::Approx(M_PI / 2));
  CHECK(d.largest == 1);
  CHECK(d.span == doctest::Approx(2 * M_PI));
  CHECK(d.parted == doctest::Approx(M_PI / 6).epsilon(1e-5));
  CHECK(relative_l2(d) == doctest::Approx(1));
  CHECK(relative_l2(difference(wave, rows({0, 7}, {0, 0}))) == std::numeric_limits<double>::infinity());
}

TEST_CASE("two lines: the integral is exact whatever the rows") {
  // a - b = 3t - 1 on 0..1: int = 1, so l2 = 1; int b^2 = int (1-t)^2 = 1/3.
  const Curve b = rows({0, 1}, {1, 0});
  for (const int lines : {1, 2, 3, 7, 100}) {
    const HistoryDifference d = difference(sampled(0, 1, lines, [](double t) { return 2 * t; }), b, 0.5);
    CHECK(d.l2 == doctest::Approx(1).epsilon(1e-14));
    CHECK(d.size == doctest::Approx(std::sqrt(1.0 / 3)).epsilon(1e-14));
    CHECK(d.size_of_a == doctest::Approx(std::sqrt(4.0 / 3)).epsilon(1e-14));
    CHECK(d.max_abs == 2);
    CHECK(d.time_of_max == 1);
    CHECK(d.parted == 0);  // |-1| > 0.5 at once
  }
  // Leaves 1.5 where 3t - 1 = 1.5.
  CHECK(difference(rows({0, 1}, {0, 2}), b, 1.5).parted == doctest::Approx(2.5 / 3).epsilon(1e-14));
  CHECK(std::isnan(difference(rows({0, 1}, {0, 2}), b, 2).parted));
}

TEST_CASE("only the time that both have counts") {
  const HistoryDifference d = difference(rows({0, 10}, {0, 10}), rows({8, 12}, {0, 0}));
  CHECK(d.from == 8);
  CHECK(d.span == 2);
  CHECK(d.l2 == doctest::Approx(std::sqrt((1000.0 - 512.0) / 3 / 2)).epsilon(1e-14));  // int t^2 over 8..10
  CHECK(d.max_abs == 10);
  for (const auto& other : {rows({11, 12}, {1, 1}), rows({10, 12}, {1, 1}), rows({5}, {1}), rows({}, {})}) {
    const HistoryDifference none = difference(rows({0, 10}, {0, 10}), other);
    CHECK_FALSE(none.compared());
    CHECK(std::isnan(none.l2));
    CHECK(std::isnan(none.max_abs));
    CHECK(std::isnan(relative_l2(none)));
  }
}

TEST_CASE("a jump takes no time") {
  const Curve step = rows({0, 1, 1, 2}, {0, 0, 1, 1});
  const HistoryDifference d = difference(step, rows({0, 2}, {0, 0}), 0.5);
  CHECK(d.l2 == doctest::Approx(std::sqrt(0.5)).epsilon(1e-15));
  CHECK(d.time_of_max == 1);
  CHECK(d.parted == 1);
  CHECK(difference(step, step).l2 == 0);
}

TEST_CASE("from 0 they part where the difference begins") {
  CHECK(difference(rows({0, 1, 2}, {0, 0, 1}), rows({0, 2}, {0, 0})).parted == 1);
}

TEST_CASE("values near the largest and the smallest numbers") {
  const double huge = 1e300;
  CHECK(difference(rows({0, 1}, {huge, huge}), rows({0, 1}, {0, 0})).l2 == doctest::Approx(huge));
  CHECK(difference(rows({0, 1}, {1e-300, 1e-300}), rows({0, 1}, {0, 0})).l2 == doctest::Approx(1e-300));
}

TEST_CASE("rows without numbers and rows that go back in time are left out and counted") {
  const std::vector<double> times{0, 1, 2, 1.5, 3, no_value, 4};
  const std::vector<double> values{0, no_value, 2, 99, std::numeric_limits<double>::infinity(), 5, 4};
  const Curve curve = curve_of({times, values});
  CHECK(curve.times == std::vector<double>{0, 2, 4});
  CHECK(curve.values == std::vector<double>{0, 2, 4});
  CHECK(curve.left_out == 4);
  const HistoryDifference d = difference(curve, sampled(0, 4, 5, [](double t) { return t; }));
  CHECK(d.left_out == 4);
  CHECK(d.l2 <= 1e-15);
}

TEST_CASE("shifts bring curves together") {
  const Curve a = sampled(0, 5, 50, [](double t) { return t * t; });
  const Curve b = sampled(1, 6, 50, [](double t) { return (t - 1) * (t - 1); });
  CHECK(compare_histories(a.view(), b.view(), {.shift_b = 1}).l2 <= 1e-13);
  CHECK(compare_histories(a.view(), b.view(), {.shift_a = -1}).l2 <= 1e-13);
  // Not shifted: t^2 - (t-1)^2 = 2t - 1 over 1..5.
  const double exact = std::sqrt((729.0 - 1) / 6 / 4);
  CHECK(compare_histories(a.view(), b.view()).l2 == doctest::Approx(exact).epsilon(1e-3));
}

TEST_CASE("a part of a curve ends between rows") {
  const Curve line = rows({0, 1, 3}, {0, 1, 3});
  const Curve part = cut_to(line, 0.5, 2);
  CHECK(part.times == std::vector<double>{0.5, 1, 2});
  CHECK(part.values == std::vector<double>{0.5, 1, 2});
  CHECK(cut_to(line, -1, 9).times == line.times);
  CHECK(cut_to(line, 1.25, 1.5).values == std::vector<double>{1.25, 1.5});
  CHECK(cut_to(line, 4, 5).times.empty());
  CHECK(cut_to(line, -2, -1).times.empty());
  const HistoryDifference d = compare_histories(line.view(), rows({0, 3}, {0, 0}).view(), {.from = 1, .to = 2});
  CHECK(d.l2 == doctest::Approx(std::sqrt(7.0 / 3)).epsilon(1e-14));
}

TEST_CASE("moving averages are integrals, not means of rows") {
  // Rows crowd at the left: a mean of rows would not be 0.
  Curve crowded = rows({}, {});
  for (int i = 0; i <= 200; ++i) {
    const double t = 2 * std::pow(i / 200.0, 4) - 1;
    crowded.times.push_back(t);
    crowded.values.push_back(t);
  }
  CHECK(moving_average(crowded, 2, std::vector<double>{0}).values[0] == doctest::Approx(0).epsilon(1e-13));

  // A parabola: the mean over W is t^2 + W^2/12; of its chords over h, h^2/6 more, whole lines in the window.
  const double h = 0.01;
  const double window = 0.5;
  const Curve parabola = sampled(0, 4, 400, [](double t) { return t * t; });
  const Curve mean = moving_average(parabola, window);
  for (const std::size_t i : {50, 100, 333}) {
    const double t = parabola.times[i];
    CHECK(mean.values[i] == doctest::Approx(t * t + window * window / 12 + h * h / 6).epsilon(1e-12));
  }
  // At the begin half a window is left: mean of t^2 over 0..W/2.
  CHECK(mean.values[0] == doctest::Approx(window * window / 12 + h * h / 6).epsilon(1e-12));

  // Windows shorter than a line, between rows.
  const Curve line = rows({0, 10}, {5, 25});
  CHECK(moving_average(line, 1e-9, std::vector<double>{3}).values[0] == doctest::Approx(11).epsilon(1e-14));
  CHECK(moving_average(line, 0, std::vector<double>{3}).values[0] == doctest::Approx(11).epsilon(1e-14));
  CHECK(moving_average(line, 100).values == std::vector<double>{15, 15});
  // A jump in the window: 0 for half of it, 1 for the other.
  CHECK(moving_average(rows({0, 1, 1, 2}, {0, 0, 1, 1}), 1, std::vector<double>{1}).values[0] == doctest::Approx(0.5));
}

TEST_CASE("an average over whole periods takes a ripple away") {
  const double period = 0.1;
  const auto line = [](double t) { return 1 + t; };
  const Curve smooth = rows({0, 1}, {1, 2});
  const Curve rippled = sampled(0, 1, 2000, [&](double t) { return line(t) + std::sin(2 * M_PI * t / period); });
  CHECK(compare_histories(rippled.view(), smooth.view()).l2 == doctest::Approx(std::sqrt(0.5)).epsilon(1e-3));
  const HistoryComparison averaged{.window = period, .from = period, .to = 1 - period};
  CHECK(compare_histories(rippled.view(), smooth.view(), averaged).l2 <= 1e-10);
}

TEST_CASE("averages end where the shorter history ends, for both") {
  const Curve longer = sampled(0, 2, 200, [](double t) { return t; });
  const Curve shorter = sampled(0, 1, 100, [](double t) { return t; });
  CHECK(compare_histories(longer.view(), shorter.view(), {.window = 0.5}).max_abs <= 1e-13);
}

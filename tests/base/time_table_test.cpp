#include "udar/base/time_table.hpp"

#include <doctest/doctest.h>

#include <cmath>

using udar::TimeTable;

namespace {

const TimeTable linear{{1, 2, 4}, {10, 20, -20}};
const TimeTable smooth{{1, 2, 4}, {10, 20, -20}, TimeTable::Shape::smooth};

}  // namespace

TEST_CASE("tables meet their points and stay outside of them") {
  for (const TimeTable& table : {linear, smooth}) {
    CHECK(table.at(-5) == 10);
    CHECK(table.at(1) == 10);
    CHECK(table.at(2) == 20);
    CHECK(table.at(3) == 0);  // half-way, in both shapes
    CHECK(table.at(4) == -20);
    CHECK(table.at(1e9) == -20);
  }
  CHECK(linear.at(1.25) == 12.5);
}

TEST_CASE("an empty table is zero, a constant one never changes") {
  CHECK(TimeTable{}.at(3) == 0);
  CHECK(TimeTable::constant(7).at(-1) == 7);
  CHECK(TimeTable::constant(7).at(1e6) == 7);
}

TEST_CASE("a smooth table has no jump in value, slope or curvature") {
  // The third derivative is at most 60 * |step of value| / (time between points)^3 = 600: differences over 2 h of value
  // and slope, and of curvature, stay below what that allows.
  constexpr double h = 1e-3;
  const auto value = [](double t) { return smooth.at(t); };
  const auto slope = [&](double t) { return (value(t + h) - value(t - h)) / (2 * h); };
  const auto curvature = [&](double t) { return (value(t + h) - 2 * value(t) + value(t - h)) / (h * h); };
  for (double t = 0.5; t < 4.5; t += h / 2) {
    CHECK(std::fabs(value(t + h) - value(t)) <= 40 * h);
    CHECK(std::fabs(slope(t + h) - slope(t)) <= 70 * h);
    CHECK(std::fabs(curvature(t + h) - curvature(t)) <= 1.01 * 600 * h);
  }
  for (const double point : {1.0, 2.0, 4.0}) {
    CHECK(std::fabs(slope(point)) < 1e-3);
    CHECK(std::fabs(curvature(point)) < 0.7);
  }
}

TEST_CASE("a smooth table never overshoots") {
  for (double t = 0; t < 5; t += 1e-3) {
    CHECK(smooth.at(t) <= 20);
    CHECK(smooth.at(t) >= -20);
  }
}

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "udar/base/vec2.hpp"

using namespace udar;

namespace {

double error_of(double angle) {
  const Turn turn = turn_by(angle);
  const long double exact = angle;
  return static_cast<double>(std::max(std::fabs(turn.cos - cosl(exact)), std::fabs(turn.sin - sinl(exact))));
}

}  // namespace

TEST_CASE("turn_by keeps its promise over the whole range") {
  std::mt19937 random(3);
  double largest = 0;
  for (const double range : {1e-8, 1.0, 10.0, 1e3, 1e5}) {
    std::uniform_real_distribution<double> angle(-range, range);
    for (int i = 0; i < 100000; ++i) largest = std::max(largest, error_of(angle(random)));
  }
  CHECK(largest < 4e-16);
}

TEST_CASE("turn_by at and beside whole eighths of a turn") {
  const long double quarter = 1.57079632679489661923132169163975144L;
  double largest = 0;
  for (int k = -100000; k < 100000; ++k) {
    const auto angle = static_cast<double>(k * quarter / 2);
    if (std::fabs(angle) >= 1e5) continue;
    for (const double beside : {std::nextafter(angle, -1e9), angle, std::nextafter(angle, 1e9)}) {
      largest = std::max(largest, error_of(beside));
    }
  }
  CHECK(largest < 4e-16);
}

TEST_CASE("no turn is exact") {
  CHECK(turn_by(0).cos == 1);
  CHECK(turn_by(0).sin == 0);
}

TEST_CASE("a turn by what is no number is none, by any other no undefined behaviour") {
  for (const double angle : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    CHECK(std::isnan(turn_by(angle).cos));
    CHECK(std::isnan(turn_by(angle).sin));
  }
  turn_by(1e20);  // more quarters than an integer counts
}

TEST_CASE("a turn keeps length and sense") {
  const Vec2 a{3, 4};
  CHECK(length(turn_by(1.2345) * a) == doctest::Approx(5).epsilon(1e-15));
  const Vec2 quarter = turn_by(std::acos(0.0)) * Vec2{1, 0};
  CHECK(length(quarter - perpendicular({1, 0})) < 1e-16);
}

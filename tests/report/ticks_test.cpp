#include "udar/report/ticks.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "udar/base/human_unit.hpp"

using namespace udar;

TEST_CASE("ticks are multiples of 1, 2 or 5 times a power of ten, cover the range and are about as many as wanted") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> digits(-1, 1);
  std::uniform_int_distribution<int> powers(-9, 9);
  for (int trial = 0; trial < 2000; ++trial) {
    const double low = digits(random) * std::pow(10, powers(random));
    const double high = low + std::fabs(digits(random)) * std::pow(10, powers(random)) + 1e-6 * std::fabs(low);
    const int wanted = 3 + trial % 8;
    const Ticks ticks = ticks_over(low, high, wanted);
    const double power = std::pow(10, std::floor(std::log10(ticks.step * 1.0001)));
    const double digit = ticks.step / power;
    INFO("from ", low, " to ", high, " step ", ticks.step);
    CHECK((std::fabs(digit - 1) < 1e-6 || std::fabs(digit - 2) < 1e-6 || std::fabs(digit - 5) < 1e-6));
    const double hair = 1e-6 * ticks.step;
    CHECK(ticks.values.front() <= low + hair);
    CHECK(ticks.values.back() >= high - hair);
    // No more than one step beyond each end, so at most two intervals more than wanted.
    CHECK(ticks.values.front() > low - ticks.step - hair);
    CHECK(ticks.values.back() < high + ticks.step + hair);
    CHECK(static_cast<int>(ticks.values.size()) <= wanted + 3);
    for (const double v : ticks_within(low, high, wanted).values) {
      CHECK(v >= low - hair);
      CHECK(v <= high + hair);
    }
  }
}

TEST_CASE("the words at ticks have the digits that the step needs") {
  const Ticks tenths = ticks_over(-0.3, 0.4, 7);
  CHECK(tenths.step == doctest::Approx(0.1));
  CHECK(tenths.text(tenths.values.front()) == "−0.3");
  CHECK(tenths.text(1e-17) == "0");
  CHECK(tenths.text(0.4) == "0.4");
  const Ticks hundreds = ticks_over(0, 900, 5);
  CHECK(hundreds.text(800) == "800");
}

TEST_CASE("nothing to cover still makes an axis") {
  CHECK(ticks_over(0, 0, 5).values.size() >= 2);
  CHECK(ticks_over(3, 3, 5).values.size() >= 2);
}

TEST_CASE("units for people") {
  CHECK(human_unit("m", 0.0402).name == "mm");
  CHECK(human_unit("m", 0.0402).size == doctest::Approx(1e-3));
  CHECK(human_unit("s", 2e-3).name == "ms");
  CHECK(human_unit("s", 999.99e-6).name == "ms");  // that is 1 ms
  CHECK(human_unit("s", 40.4e-6).name == "µs");
  CHECK(human_unit("s", 300).name == "s");  // nobody counts in ks
  CHECK(human_unit("Pa", 235e6).name == "MPa");
  CHECK(human_unit("Pa", 2e9).name == "MPa");
  CHECK(human_unit("N", 1.3e6).name == "MN");
  CHECK(human_unit("J", 9902).name == "kJ");
  CHECK(human_unit("m/s", 80).name == "m/s");
  CHECK(human_unit("m/s^2", 9.81).name == "m/s²");
  CHECK(human_unit("m/s^2", 3e7).name == "10⁶ m/s²");
  CHECK(human_unit("m/s^2", 3e7).size == doctest::Approx(1e6));
  CHECK(human_unit("", 0.31).name.empty());
  CHECK(human_unit("Pa", 0).size == 1);
  CHECK(human_text(5.001e-4, "s", 4) == "500.1 µs");
  CHECK(human_text(1.336e6, "N") == "1.34 MN");
  CHECK(human_text(-0.0402, "m") == "-40.2 mm");
  CHECK(human_text(0, "N") == "0 N");
}

TEST_CASE("ticks of a logarithmic axis") {
  const Ticks two = log_ticks_over(0.3, 25);
  CHECK(two.values.size() == 8);  // 0.2 0.5 1 2 5 10 20 50
  CHECK(two.values.front() == doctest::Approx(0.2));
  CHECK(two.values.back() == doctest::Approx(50));
  CHECK(two.text(0.5) == "0.5");
  const Ticks many = log_ticks_over(1e-12, 1e3);
  CHECK(many.values.size() <= 10);
  CHECK(many.values.front() <= 1e-12 * (1 + 1e-9));
  CHECK(many.values.back() >= 1e3 * (1 - 1e-9));
  const Ticks exact = log_ticks_over(1, 10);
  CHECK(exact.values.front() == doctest::Approx(1));
  CHECK(exact.values.back() == doctest::Approx(10));
  CHECK(log_ticks_over(3, 3).values.size() >= 2);
}

TEST_CASE("values that differ by rounding, or are as large and small as numbers get, have a few ticks") {
  const double tiny = 5e-324;
  const double huge = 1.7e308;
  for (const auto& range : std::vector<std::pair<double, double>>{{1, std::nextafter(1, 2)},
                                                                  {-3.2e7, std::nextafter(-3.2e7, 0)},
                                                                  {1e22, 1e22 + 4e6},
                                                                  {0, tiny},
                                                                  {tiny, tiny},
                                                                  {-huge, huge},
                                                                  {huge, huge},
                                                                  {0, huge},
                                                                  {-tiny, tiny},
                                                                  {2.5, 2.5}}) {
    const double low = range.first;
    const double high = range.second;
    INFO(low, " to ", high);
    for (const Ticks& ticks : {ticks_over(low, high, 7), ticks_within(low, high, 7), log_ticks_over(low, high)}) {
      CHECK(!ticks.values.empty());
      CHECK(ticks.values.size() <= 30);
      for (const double v : ticks.values) CHECK(std::isfinite(v));
    }
  }
}

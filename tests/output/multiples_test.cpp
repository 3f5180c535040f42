#include "udar/output/multiples.hpp"

#include <doctest/doctest.h>

#include <initializer_list>
#include <limits>

#include "udar/base/compensated_sum.hpp"

using udar::Multiples;

TEST_CASE("each multiple is reached once, at the first time that is not before it") {
  Multiples multiples(0.1);
  CHECK(multiples.reached(0));
  CHECK_FALSE(multiples.reached(0));
  CHECK_FALSE(multiples.reached(0.099));
  CHECK(multiples.reached(0.11));
  CHECK_FALSE(multiples.reached(0.19));
  CHECK(multiples.reached(0.2));
}

TEST_CASE("several multiples in one step count as one") {
  Multiples multiples(1);
  CHECK(multiples.reached(0));
  CHECK(multiples.reached(3.5));
  CHECK_FALSE(multiples.reached(3.9));
  CHECK(multiples.reached(4));
}

TEST_CASE("without an interval nothing is ever due") {
  Multiples multiples(0);
  CHECK_FALSE(multiples.reached(0));
  CHECK_FALSE(multiples.reached(1e9));
}

TEST_CASE("an interval of next to nothing, and a time that is none, are no more than often") {
  Multiples tiny(1e-300);
  CHECK(tiny.reached(1));
  CHECK_FALSE(tiny.reached(1e9));
  Multiples multiples(1e-6);
  CHECK(multiples.reached(1e300));
  CHECK_FALSE(multiples.reached(std::numeric_limits<double>::quiet_NaN()));
}

TEST_CASE("steps as long as the interval meet every multiple, whatever rounding does to the sum") {
  for (const double interval : {6.4e-8, 0.1, 1.0 / 3, 2.56e-7}) {
    Multiples multiples(interval);
    udar::CompensatedSum time;
    int met = 0;
    constexpr int steps = 100000;
    for (int k = 0; k <= steps; ++k, time.add(interval)) met += multiples.reached(time.value()) ? 1 : 0;
    CHECK(met == steps + 1);
  }
}

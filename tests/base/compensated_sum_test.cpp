#include "udar/base/compensated_sum.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>

using udar::CompensatedSum;

TEST_CASE("ten million tenths are a million to the last digits") {
  CompensatedSum compensated;
  double plain = 0;
  for (int i = 0; i < 10'000'000; ++i) {
    compensated.add(0.1);
    plain += 0.1;
  }
  CHECK(std::fabs(compensated.value() - 1e6) < 2e-10);
  CHECK(std::fabs(plain - 1e6) > 1e-5);  // what it is for
}

TEST_CASE("small terms survive a large one that comes and goes") {
  CompensatedSum sum;
  for (const double term : {1.0, 1e100, 1.0, -1e100}) sum.add(term);
  CHECK(sum.value() == 2);
}

TEST_CASE("nothing added is zero") { CHECK(CompensatedSum{}.value() == 0); }

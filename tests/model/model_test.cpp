#include "udar/model/model.hpp"

#include <doctest/doctest.h>

#include <algorithm>

using namespace udar;

TEST_CASE("without exceptions the same holds for all pairs of bodies, however many") {
  BodyPairs pairs;
  pairs.usual = {true, 0.3, 1e9};
  for (const Index a : {0U, 7U, 4000000000U}) {
    CHECK(&pairs.of(a, 3) == &pairs.usual);
    CHECK(&pairs.of(3, a) == &pairs.usual);
  }
}

TEST_CASE("exceptions of pairs are found in either order, all others are as usual") {
  constexpr Index bodies = 40;
  constexpr Index none = bodies * bodies;
  BodyPairs pairs;
  pairs.usual = {true, none, {}};
  // Some of all pairs, in an order of no kind; what holds is named by a number in a full table.
  std::vector<double> table(std::size_t{bodies} * bodies, none);
  for (Index k = 0; k < 300; ++k) {
    const Index a = k * 17 % bodies;
    const Index b = k * k * 29 % bodies;
    pairs.set(a, b, {false, static_cast<double>(k), {}});
    table[a * bodies + b] = table[b * bodies + a] = k;
  }
  for (Index a = 0; a < bodies; ++a) {
    for (Index b = 0; b < bodies; ++b) CHECK(pairs.of(a, b).friction == table[a * bodies + b]);
  }
  CHECK(std::is_sorted(pairs.exceptions.begin(), pairs.exceptions.end(), [](const auto& x, const auto& y) {
    return x.first != y.first ? x.first < y.first : x.second < y.second;
  }));
}

TEST_CASE("a body with itself is a pair like others") {
  BodyPairs pairs;
  pairs.set(2, 2, {false, 0, {}});
  CHECK_FALSE(pairs.of(2, 2).touch);
  CHECK(pairs.of(2, 3).touch);
  CHECK(pairs.of(1, 2).touch);
}

#include "udar/base/text.hpp"

#include <doctest/doctest.h>

#include <cstdlib>

using namespace udar;

namespace {

const std::vector<std::string> keys{"young_modulus", "poisson_ratio", "yield_stress", "density", "law"};

}  // namespace

TEST_CASE("the nearest word is what was meant") {
  CHECK(nearest_word("yeild_stress", keys) == "yield_stress");  // swapped
  CHECK(nearest_word("densty", keys) == "density");             // left out
  CHECK(nearest_word("young_modulus_", keys) == "young_modulus");
  CHECK(nearest_word("poison_ratoi", keys) == "poisson_ratio");
  CHECK(nearest_word("density", keys) == "density");
  CHECK(nearest_word("lw", keys) == "law");
}

TEST_CASE("what is like nothing has no nearest word") {
  CHECK(nearest_word("thickness", keys).empty());
  CHECK(nearest_word("", keys).empty());
  CHECK(nearest_word("xyz", keys).empty());
  CHECK(nearest_word("density", {}).empty());
  CHECK(nearest_word(std::string(100000, 'd'), keys).empty());
}

TEST_CASE("of words equally near the first is taken") {
  CHECK(nearest_word("cat", std::vector<std::string>{"bat", "hat"}) == "bat");
}

TEST_CASE("lists read as a sentence") {
  CHECK(one_of(std::vector<std::string>{}).empty());
  CHECK(one_of(std::vector<std::string>{"a"}) == "a");
  CHECK(one_of(std::vector<std::string>{"a", "b"}) == "a or b");
  CHECK(one_of(std::vector<std::string>{"a", "b", "c"}) == "a, b or c");
}

TEST_CASE("the shortest text of a number reads back as the same") {
  CHECK(shortest(0.0025) == "0.0025");
  CHECK(shortest(6.4e-8) == "6.4e-08");
  for (const double value : {1.0 / 3, 1e300, 5e-324, -0.1, 9.80665}) {
    CHECK(std::strtod(shortest(value).c_str(), nullptr) == value);
  }
}

#include "udar/base/box.hpp"

#include <doctest/doctest.h>

#include <array>

using namespace udar;

TEST_CASE("a box holds what was put in and its rim") {
  const Box box = bounding_box(std::array{Vec2{1, 5}, Vec2{3, -2}});
  CHECK(box.low == Vec2{1, -2});
  CHECK(box.high == Vec2{3, 5});
  CHECK(box.size() == Vec2{2, 7});
  CHECK(box.holds({1, 5}));
  CHECK(!box.holds({0.9, 0}));
  CHECK(box.grown(0.5).holds({0.6, 5.4}));
}

TEST_CASE("an empty box holds nothing") { CHECK(!Box{}.holds({0, 0})); }

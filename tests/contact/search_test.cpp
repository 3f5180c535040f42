#include "udar/contact/search.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace udar {
namespace {

double distance(Vec2 p, const SegmentEnds& s) {
  const Vec2 along = s.b - s.a;
  const double square = dot(along, along);
  const double part = square > 0 ? std::clamp(dot(p - s.a, along) / square, 0.0, 1.0) : 0;
  return length(p - (s.a + part * along));
}

struct Scene {
  std::vector<Vec2> points;
  std::vector<SegmentEnds> segments;
};

/// Points and segments of mixed lengths in a box, some of them far away, on one line, or in one place.
Scene scene(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto number = [&] { return 0x1p-31 * static_cast<double>(random()) - 1; };
  const double flat = seed % 3 == 0 ? 0 : 1;  // every third one on a line
  Scene s;
  for (int i = 0; i < 300; ++i) s.points.push_back({number(), flat * number()});
  for (int i = 0; i < 300; ++i) {
    const Vec2 a{number(), flat * number()};
    const double size = i % 10 == 0 ? 1 : 0.05;
    s.segments.push_back({a, a + Vec2{size * number(), flat * size * number()}});
  }
  s.points.push_back({30, -20});
  s.segments.push_back({{-100, 5}, {100, 5}});
  s.segments.push_back({s.points[0], s.points[0]});
  return s;
}

}  // namespace

TEST_CASE("every segment within reach of a point is found, in rising order, and none beyond") {
  for (std::uint32_t seed = 1; seed < 10; ++seed) {
    const Scene s = scene(seed);
    for (const double reach : {1e-6, 0.01, 0.3, 50.0}) {
      CAPTURE(seed);
      CAPTURE(reach);
      const Neighbours found = find_near(s.points, s.segments, reach);
      REQUIRE(found.begin.size() == s.points.size() + 1);
      for (std::size_t p = 0; p < s.points.size(); ++p) {
        std::vector<std::uint32_t> expected;
        for (std::uint32_t k = 0; k < s.segments.size(); ++k) {
          if (distance(s.points[p], s.segments[k]) <= reach) expected.push_back(k);
        }
        const std::vector<std::uint32_t> got(found.near.begin() + found.begin[p],
                                             found.near.begin() + found.begin[p + 1]);
        CHECK(got == expected);
      }
    }
  }
}

TEST_CASE("nothing to find") {
  CHECK(find_near({}, {}, 1).empty());
  CHECK(find_near({{0, 0}}, {}, 1).empty());
  CHECK(find_near({}, {{{0, 0}, {1, 0}}}, 1).empty());
  CHECK(find_near({{5, 5}}, {{{0, 0}, {1, 0}}}, 1).empty());
}

}  // namespace udar

#include "udar/contact/body_touch.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <random>

namespace udar {
namespace {

/// The outline of a polygon, counter-clockwise, as segments.
std::vector<Segment> loop(std::uint32_t corners) {
  std::vector<Segment> segments;
  for (std::uint32_t i = 0; i < corners; ++i) {
    segments.push_back({i, (i + 1) % corners, (i + corners - 1) % corners, (i + 1) % corners, 0});
  }
  return segments;
}

const std::vector<Vec2> hollow{{0, 0}, {4, 0}, {4, 3}, {2, 1}, {0, 3}};  // corner 3 points inwards

Foot nearest(const std::vector<Vec2>& corners, Vec2 p) {
  const auto segments = loop(static_cast<std::uint32_t>(corners.size()));
  Foot best{.distance = std::numeric_limits<double>::infinity()};
  for (std::uint32_t s = 0; s < segments.size(); ++s) {
    const Foot foot = foot_on(segments, s, p, [&](std::uint32_t c) { return corners[c]; });
    if (std::fabs(foot.distance) < std::fabs(best.distance)) best = foot;
  }
  return best;
}

/// By counting how often a ray crosses the outline.
bool inside(const std::vector<Vec2>& corners, Vec2 p) {
  bool in = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i];
    const Vec2 b = corners[(i + 1) % corners.size()];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) in = !in;
  }
  return in;
}

}  // namespace

TEST_CASE("the sign of the distance tells inside from outside, and the normal is its gradient") {
  std::mt19937 random(3);
  const auto number = [&] { return 0x1p-32 * static_cast<double>(random()); };
  for (int k = 0; k < 2000; ++k) {
    const Vec2 p{6 * number() - 1, 5 * number() - 1};
    const Foot foot = nearest(hollow, p);
    if (std::fabs(foot.distance) < 1e-3) continue;
    CAPTURE(p.x);
    CAPTURE(p.y);
    CHECK((foot.distance < 0) == inside(hollow, p));
    CHECK(length(foot.normal) == doctest::Approx(1).epsilon(1e-12));
    // Along its normal the distance grows as the way, unless another place gets nearer.
    const double h = 1e-6;
    const double ahead = nearest(hollow, p + h * foot.normal).distance;
    const double behind = nearest(hollow, p - h * foot.normal).distance;
    if (nearest(hollow, p + h * foot.normal).segment == foot.segment) {
      CHECK(ahead - foot.distance == doctest::Approx(h).epsilon(1e-6));
    }
    if (nearest(hollow, p - h * foot.normal).segment == foot.segment) {
      CHECK(foot.distance - behind == doctest::Approx(h).epsilon(1e-6));
    }
  }
}

TEST_CASE("a foot follows a point along the outline, through flat and hollow corners") {
  const auto segments = loop(5);
  const auto place = [](std::uint32_t c) { return hollow[c]; };
  // On a way inside the body that stays 0.1 m from the outline: along the side, round corner 3.
  std::uint32_t segment = 2;
  for (int k = 0; k <= 1000; ++k) {
    const double t = 0.001 * k;
    const Vec2 p = t < 0.5 ? Vec2{3.5 - 3 * t, 2.5 - 3 * t} + Vec2{0.08, -0.08}
                           : Vec2{2 - 3 * (t - 0.5), 1 + 3 * (t - 0.5)} + Vec2{-0.08, -0.08};
    const Foot followed = follow_foot(segments, segment, p, Vec2{}, place);
    const Foot best = nearest(hollow, p);
    CHECK(followed.distance == doctest::Approx(best.distance).epsilon(1e-12));
    segment = followed.segment;
  }
  CHECK(segment == 3);
}

TEST_CASE("forces of a touch balance, and so do their moments") {
  std::mt19937 random(7);
  const auto number = [&] { return 0x1p-31 * static_cast<double>(random()) - 1; };
  const auto segments = loop(7);
  for (int k = 0; k < 500; ++k) {
    std::vector<Vec2> places;
    for (int i = 0; i < 7; ++i) places.push_back({std::cos(i) + 0.2 * number(), std::sin(i) + 0.2 * number()});
    const auto place = [&](std::uint32_t c) { return places[c]; };
    const auto on = static_cast<std::uint32_t>(random() % 2 + 1);
    const double along = k % 3 == 0 ? 0 : (k % 3 == 1 ? 1 : 0.5 + 0.4 * number());
    const Segment& s = segments[on];
    const Vec2 normal = [&] {
      if (along > 0 && along < 1) return (1 / length(place(s.b) - place(s.a))) * outward(place(s.b) - place(s.a));
      const double angle = number();
      return Vec2{std::cos(angle), std::sin(angle)};
    }();
    const double depth = 0.1 * (1.1 + number());
    BodyTouch touch{.point = 6, .segment = on, .along = along};
    touch.springs.normal = normal;
    touch.springs.penetration = depth;
    touch.springs.normal_force = 3 * normal;
    touch.springs.damping_force = 2 * normal;
    touch.springs.friction_force = number() * perpendicular(normal);
    Vec2 spread;
    Vec2 foot;
    for (const TouchShare& share : shares_of(segments, on, along)) {
      spread += share.couple * place(share.point);
      foot += share.weight * place(share.point);
    }
    touch.lever = dot(perpendicular(normal), spread);
    if (touch.lever < 0.1) continue;
    // The point stands in the depth under its foot.
    places[6] = foot - depth * normal;
    Vec2 force;
    double moment = 0;
    for_each_force(segments, touch, [&](std::uint32_t point, const TouchForces& f) {
      force += f.total();
      moment += cross(places[point], f.total());
    });
    CHECK(length(force) < 1e-14);
    CHECK(std::fabs(moment) < 1e-14);
  }
}

}  // namespace udar

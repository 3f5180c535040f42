#include "udar/contact/tie.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace udar {
namespace {

/// The point and the two ends of the segment, m.
using Places = std::array<Vec2, 3>;

TiePull pull_at(const Tie& tie, const Places& x) { return pull(tie, x[0], x[1], x[2]); }

double energy(const Tie& tie, const Places& x) {
  const Vec2 stretch = pull_at(tie, x).stretch;
  return 0.5 * tie.stiffness * dot(stretch, stretch);
}

/// Ties within a segment and a little beyond it, on it and off it, at places where they are stretched.
class RandomTies {
 public:
  Tie tie() { return {.along = 0.75 + 0.75 * number(), .gap = 0.4 * number(), .stiffness = 3}; }
  Places places() {
    const Vec2 a{number(), number()};
    return {Vec2{2 * number(), 2 * number()}, a, a + Vec2{1.5 + number(), number()}};
  }
  /// From -1 to 1.
  double number() { return 0x1p-31 * static_cast<double>(random_()) - 1; }

 private:
  std::mt19937 random_{11};
};

}  // namespace

TEST_CASE("forces of a tie are in balance, and so are their moments") {
  RandomTies random;
  for (int k = 0; k < 500; ++k) {
    const Tie tie = random.tie();
    const Places x = random.places();
    const TiePull now = pull_at(tie, x);
    const double size = length(now.on_point) + length(now.on_a) + length(now.on_b);
    CHECK(length(now.on_point + now.on_a + now.on_b) <= 1e-15 * size);
    const double moment = cross(x[0], now.on_point) + cross(x[1], now.on_a) + cross(x[2], now.on_b);
    CHECK(std::fabs(moment) <= 1e-14 * size);
  }
}

TEST_CASE("forces of a tie are the gradient of its energy") {
  RandomTies random;
  for (int k = 0; k < 500; ++k) {
    const Tie tie = random.tie();
    const Places x = random.places();
    const TiePull now = pull_at(tie, x);
    const std::array forces{now.on_point, now.on_a, now.on_b};
    constexpr double h = 1e-5;  // error h^2 times third derivatives, rounding 1e-16 / h
    for (std::size_t i = 0; i < 3; ++i) {
      for (const Vec2 way : {Vec2{1, 0}, Vec2{0, 1}}) {
        Places ahead = x;
        Places behind = x;
        ahead[i] += h * way;
        behind[i] -= h * way;
        const double slope = (energy(tie, ahead) - energy(tie, behind)) / (2 * h);
        CHECK(std::fabs(slope + dot(forces[i], way)) < 1e-7 * (1 + std::fabs(slope)));
      }
    }
  }
}

TEST_CASE("a tie that is moved and turned as one piece is stretched as before; at rest not at all") {
  RandomTies random;
  for (int k = 0; k < 500; ++k) {
    const Tie tie = random.tie();
    const Places x = random.places();
    const double turn = 4 * random.number();
    const Vec2 way{random.number(), random.number()};
    const auto moved = [&](Vec2 p) {
      return way + Vec2{std::cos(turn) * p.x - std::sin(turn) * p.y, std::sin(turn) * p.x + std::cos(turn) * p.y};
    };
    const TiePull before = pull_at(tie, x);
    const TiePull after = pull_at(tie, {moved(x[0]), moved(x[1]), moved(x[2])});
    CHECK(length(after.on_point - (moved(before.on_point) - way)) < 1e-13);
    CHECK(length(after.on_a - (moved(before.on_a) - way)) < 1e-13);
    CHECK(length(after.on_b - (moved(before.on_b) - way)) < 1e-13);

    const Vec2 along = x[2] - x[1];
    const Vec2 home = x[1] + tie.along * along + (tie.gap / length(along)) * outward(along);
    CHECK(length(pull(tie, home, x[1], x[2]).stretch) < 1e-15 * 10);
  }
}

}  // namespace udar

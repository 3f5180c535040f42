#include "udar/material/tresca.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include "udar/material/elastic.hpp"

namespace udar {
namespace {

using Stress = SymTensor<double>;
using UDAR_ISA::Pack;

constexpr double yield = 400e6;  // Pa
const Tresca steel{.young_modulus = 200e9, .poisson_ratio = 0.3, .yield_stress = yield};
constexpr double epsilon = 2.220446049250313e-16;

/// Largest first.
std::array<double, 3> principal(const Stress& s) {
  const double centre = 0.5 * (s.xx + s.yy);
  const double radius = std::hypot(0.5 * (s.xx - s.yy), s.xy);
  std::array<double, 3> p{centre + radius, centre - radius, s.zz};
  std::sort(p.begin(), p.end(), std::greater<>());
  return p;
}

double excess(const Stress& s) { return principal(s)[0] - principal(s)[2] - yield; }
double mean(const Stress& s) { return (s.xx + s.yy + s.zz) / 3; }
double product(const Stress& a, const Stress& b) { return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2 * a.xy * b.xy; }
Stress minus(const Stress& a, const Stress& b) { return {a.xx - b.xx, a.yy - b.yy, a.xy - b.xy, a.zz - b.zz}; }
double size(const Stress& s) {
  return std::max({std::fabs(s.xx), std::fabs(s.yy), std::fabs(s.xy), std::fabs(s.zz), yield});
}

Stress turn(const Stress& s, double angle) {
  const double c = std::cos(angle), n = std::sin(angle);
  return {c * c * s.xx - 2 * c * n * s.xy + n * n * s.yy, n * n * s.xx + 2 * c * n * s.xy + c * c * s.yy,
          c * n * (s.xx - s.yy) + (c * c - n * n) * s.xy, s.zz};
}

Stress hooke(const Stress& s, double e_x, double e_y, double g_xy) {
  const Elasticity e = steel.elasticity();
  const double pressure = e.lambda * (e_x + e_y);
  return {s.xx + pressure + 2 * e.shear_modulus * e_x, s.yy + pressure + 2 * e.shear_modulus * e_y,
          s.xy + e.shear_modulus * g_xy, s.zz + pressure};
}

bool same_bits(const Stress& a, const Stress& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Trial stresses of all sizes, some with two equal principal values, some without shear, some far from yield.
class Trials {
 public:
  Stress next() {
    const double scale = yield * std::pow(10.0, std::uniform_real_distribution<>(-2, 2)(engine_));
    std::uniform_real_distribution<> any(-1, 1);
    Stress s{scale * any(engine_), scale * any(engine_), scale * any(engine_), scale * any(engine_)};
    switch (engine_() % 6) {
      case 0:
        s.xy = 0;
        break;
      case 1:
        s.yy = s.xx, s.xy = 0;
        break;
      case 2:
        s.zz = s.xx, s.xy = 0;
        break;
      default:
        break;
    }
    return s;
  }
  double number(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }

 private:
  std::mt19937_64 engine_{20240229};
};

constexpr int trials = 20000;

}  // namespace

TEST_CASE("tresca: uniaxial strain") {
  // Elastic to HEL = sigma_T (1 - nu) / (1 - 2 nu); then s_x = -K e - 2 sigma_T / 3 in compression, however many steps.
  const double hel = yield * (1 - 0.3) / (1 - 0.6);
  const Elasticity e = steel.elasticity();
  const double at_yield = hel / e.wave_modulus();
  for (const int steps : {1, 7, 1000}) {
    Stress s;
    const double strain = 5 * at_yield;
    for (int i = 0; i < steps; ++i) s = steel.correct(hooke(s, -strain / steps, 0, 0)).stress;
    const double exact = -e.bulk_modulus() * strain - 2 * yield / 3;
    CHECK(s.xx == doctest::Approx(exact).epsilon(1e-13 * steps));
    CHECK(s.yy == doctest::Approx(exact + yield).epsilon(1e-13 * steps));
    CHECK(s.zz == doctest::Approx(exact + yield).epsilon(1e-13 * steps));
  }
  CHECK(excess(hooke({}, -0.999 * at_yield, 0, 0)) < 0);
  CHECK(excess(hooke({}, -1.001 * at_yield, 0, 0)) > 0);
}

TEST_CASE("tresca: pure shear stays at half the yield stress") {
  Stress s;
  double work = 0;
  for (int i = 0; i < 100; ++i) {
    const Corrected<double> c = steel.correct(hooke(s, 0, 0, 1e-4));
    s = c.stress;
    work += c.plastic_work;
  }
  const double k = yield / 2;
  const double elastic_strain = k / steel.elasticity().shear_modulus;
  CHECK(s.xy == doctest::Approx(k).epsilon(1e-15));
  CHECK(s.xx == 0);
  CHECK(s.yy == 0);
  CHECK(s.zz == 0);
  CHECK(work == doctest::Approx(k * (0.01 - elastic_strain)).epsilon(1e-12));
  CHECK(work * steel.plastic_strain_of_work() == doctest::Approx((0.01 - elastic_strain) / 2).epsilon(1e-12));
}

TEST_CASE("tresca: unloading is elastic") {
  Stress s = steel.correct(hooke({}, -0.02, 0.003, 0.01)).stress;
  REQUIRE(std::fabs(excess(s)) < 1e-6 * yield);
  const Stress unloaded = hooke(s, 0.002, -0.0003, -0.001);
  REQUIRE(excess(unloaded) < 0);
  const Corrected<double> back = steel.correct(unloaded);
  CHECK(same_bits(back.stress, unloaded));
  CHECK(back.plastic_work == 0);
}

TEST_CASE("tresca: edges of the hexagon") {
  const double y = yield;
  struct Case {
    Stress trial, exact;
  };
  // Largest and middle equal, then middle and smallest; with the out-of-plane stress in each of the three places.
  const Case cases[] = {
      {{3.0 * y, 2.9 * y, 0, 0}, {2.3 * y, 2.3 * y, 0, 1.3 * y}},
      {{3.0 * y, 0, 0, 2.9 * y}, {2.3 * y, 1.3 * y, 0, 2.3 * y}},
      {{2.9 * y, 0, 0, 3.0 * y}, {2.3 * y, 1.3 * y, 0, 2.3 * y}},
      {{3.0 * y, 0.1 * y, 0, 0}, {1.7 * y, 0.7 * y, 0, 0.7 * y}},
      {{0.1 * y, 0, 0, 3.0 * y}, {0.7 * y, 0.7 * y, 0, 1.7 * y}},
      {{-2 * y, 2 * y, 0, 0}, {-0.5 * y, 0.5 * y, 0, 0}},    // a face
      {{2 * y, 2 * y, 0, 2 * y}, {2 * y, 2 * y, 0, 2 * y}},  // pure pressure
      {{y, y, 0, -2 * y}, {y / 3, y / 3, 0, -2 * y / 3}},    // two equal from the start
  };
  for (const Case& c : cases) {
    const Stress s = steel.correct(c.trial).stress;
    CHECK(s.xx == doctest::Approx(c.exact.xx).epsilon(1e-14));
    CHECK(s.yy == doctest::Approx(c.exact.yy).epsilon(1e-14));
    CHECK(s.zz == doctest::Approx(c.exact.zz).epsilon(1e-14));
    CHECK(s.xy == 0);
  }
}

TEST_CASE("tresca: on or inside the yield surface, mean stress kept, work never negative") {
  Trials random;
  int flowed = 0;
  for (int i = 0; i < trials; ++i) {
    const Stress trial = random.next();
    const Corrected<double> c = steel.correct(trial);
    const double rounding = 4 * epsilon * size(trial);
    const double over = excess(trial);
    if (over < -rounding) {
      CHECK(same_bits(c.stress, trial));
      CHECK(c.plastic_work == 0);
    } else if (over > rounding) {
      ++flowed;
      CHECK(std::fabs(excess(c.stress)) <= rounding);
      CHECK(c.plastic_work > 0);
    }
    CHECK(std::fabs(mean(c.stress) - mean(trial)) <= rounding);
    CHECK(c.plastic_work >= 0);
  }
  CHECK(flowed > trials / 4);
}

TEST_CASE("tresca: the corrected stress is the nearest admissible one") {
  // What return along the normal to a convex surface means, faces and edges alike: for every admissible stress s,
  // (trial - corrected) : (s - corrected) <= 0. It needs no knowledge of how the correction is computed.
  Trials random;
  for (int i = 0; i < trials; ++i) {
    const Stress trial = random.next();
    const Stress corrected = steel.correct(trial).stress;
    const Stress way = minus(trial, corrected);
    // An admissible stress near by: another trial, corrected and turned, with the same mean or another.
    Stress other = steel.correct(random.next()).stress;
    other = turn(other, random.number(0, 3.2));
    const double shift = mean(corrected) - mean(other) + random.number(-1, 1) * yield;
    other.xx += shift, other.yy += shift, other.zz += shift;
    const double scale = size(trial);
    CHECK(product(way, minus(other, corrected)) <= 32 * epsilon * scale * std::max(scale, size(other)));
  }
}

TEST_CASE("tresca: the axes do not matter") {
  Trials random;
  for (int i = 0; i < trials; ++i) {
    const Stress trial = random.next();
    const double angle = random.number(-3.2, 3.2);
    const Corrected<double> then_turned = steel.correct(trial);
    const Corrected<double> turned_first = steel.correct(turn(trial, angle));
    const Stress off = minus(turn(then_turned.stress, angle), turned_first.stress);
    const double rounding = 32 * epsilon * size(trial);
    CHECK(std::sqrt(product(off, off)) <= rounding);
    CHECK(std::fabs(then_turned.plastic_work - turned_first.plastic_work) <=
          rounding * size(trial) / steel.elasticity().shear_modulus);
    // Mirrored: the very same bits.
    Stress mirrored = trial;
    mirrored.xy = -mirrored.xy;
    Stress image = steel.correct(mirrored).stress;
    image.xy = -image.xy;
    CHECK((image.xx == then_turned.stress.xx && image.yy == then_turned.stress.yy &&
           image.xy == then_turned.stress.xy && image.zz == then_turned.stress.zz));
  }
}

TEST_CASE("tresca: plastic work is that of the corrected stress on the plastic strain") {
  Trials random;
  const double two_g = 2 * steel.elasticity().shear_modulus;
  for (int i = 0; i < trials; ++i) {
    const Stress trial = random.next();
    const Corrected<double> c = steel.correct(trial);
    const double exact = product(c.stress, minus(trial, c.stress)) / two_g;
    CHECK(std::fabs(c.plastic_work - exact) <= 16 * epsilon * size(trial) * size(trial) / two_g);
  }
}

TEST_CASE("tresca and elastic: a pack of lanes gives the bits of a double") {
  Trials random;
  for (int i = 0; i < 2000; ++i) {
    const Stress a = random.next();
    const Stress b = random.next();
    const SymTensor<Pack> both{Pack(Pack::Vector{a.xx, b.xx}), Pack(Pack::Vector{a.yy, b.yy}),
                               Pack(Pack::Vector{a.xy, b.xy}), Pack(Pack::Vector{a.zz, b.zz})};
    const Corrected<Pack> packed = steel.correct(both);
    const Corrected<double> of_b = steel.correct(b);
    const Stress second{packed.stress.xx.v[1], packed.stress.yy.v[1], packed.stress.xy.v[1], packed.stress.zz.v[1]};
    CHECK(same_bits(second, of_b.stress));
    CHECK(packed.plastic_work.v[1] == of_b.plastic_work);
  }
}

TEST_CASE("elastic: nothing is corrected") {
  const Elastic law{.young_modulus = 200e9, .poisson_ratio = 0.3};
  Trials random;
  for (int i = 0; i < 1000; ++i) {
    const Stress trial = random.next();
    const Corrected<double> c = law.correct(trial);
    CHECK(same_bits(c.stress, trial));
    CHECK(c.plastic_work == 0);
  }
  CHECK(law.elasticity().lambda == doctest::Approx(115.384615e9).epsilon(1e-8));
  CHECK(law.elasticity().shear_modulus == doctest::Approx(76.923077e9).epsilon(1e-8));
  CHECK(law.elasticity().bulk_modulus() == doctest::Approx(200e9 / (3 * 0.4)).epsilon(1e-14));
}

}  // namespace udar

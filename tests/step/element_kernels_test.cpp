#include "udar/step/element_kernels.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "udar/base/vec2.hpp"

namespace udar {
namespace {

using Stress = SymTensor<double>;
using UDAR_ISA::Pack;
using Triangle = Sides<double>;
const Elasticity steel = elasticity_of(200e9, 0.3);

class Random {
 public:
  double number(double low = -1, double high = 1) { return std::uniform_real_distribution<>(low, high)(engine_); }
  /// Counter-clockwise, of a size around 1 m, with no angle too small.
  Triangle triangle() {
    for (;;) {
      const Triangle t{number(), number(), number(), number()};
      if (t.twice_area() > 0.1) return t;
    }
  }
  Stress stress() { return {1e9 * number(), 1e9 * number(), 1e9 * number(), 1e9 * number()}; }

 private:
  std::mt19937_64 engine_{4711};
};

Triangle changed(const Triangle& t, double xx, double xy, double yx, double yy) {
  return {xx * t.x1 + xy * t.y1, yx * t.x1 + yy * t.y1, xx * t.x2 + xy * t.y2, yx * t.x2 + yy * t.y2};
}
Triangle minus(const Triangle& a, const Triangle& b) { return {a.x1 - b.x1, a.y1 - b.y1, a.x2 - b.x2, a.y2 - b.y2}; }
Triangle plus(const Triangle& a, const Triangle& b) { return {a.x1 + b.x1, a.y1 + b.y1, a.x2 + b.x2, a.y2 + b.y2}; }

Triangle half(const Triangle& t) { return {t.x1 / 2, t.y1 / 2, t.x2 / 2, t.y2 / 2}; }

/// Work per volume of stress `s` through the step from `t` to `t + d`, times the volume: what the corner forces do.
double work(const Stress& s, const Triangle& t, const Triangle& d, double thickness) {
  const StrainStep<double> e = strain_step(plus(t, half(d)), half(d));
  return 0.5 * thickness * e.twice_area * stress_work(s, e);
}

}  // namespace

TEST_CASE("a rigid turn of any angle gives no strain and itself") {
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const Triangle before = random.triangle();
    const double angle = random.number(-3, 3);
    const double c = std::cos(angle), s = std::sin(angle);
    const Triangle after = changed(before, c, -s, s, c);
    const Triangle change = minus(after, before);
    const StrainStep<double> e = strain_step(plus(before, half(change)), half(change));
    // The middle triangle is smaller by cos(angle / 2) in each direction, so rounding weighs more.
    const double rounding = 1e-14 / (std::cos(angle / 2) * std::cos(angle / 2));
    CHECK(std::fabs(e.xx) <= rounding);
    CHECK(std::fabs(e.yy) <= rounding);
    CHECK(std::fabs(e.xy2) <= rounding);
    CHECK(std::fabs(e.cos - c) <= rounding);
    CHECK(std::fabs(e.sin - s) <= rounding);
    // (1 + q^2)^2 scale^2: six roundings in the scale and nine in q^2 count twice, half an ulp each.
    CHECK(std::fabs(e.cos * e.cos + e.sin * e.sin - 1) <= 2 * (6 + 9) * 0x1p-53);
  }
}

TEST_CASE("strain and turn are those of the gradient on the middle triangle") {
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const Triangle middle = random.triangle();
    const double xx = 0.1 * random.number(), xy = 0.1 * random.number(), yx = 0.1 * random.number(),
                 yy = 0.1 * random.number();
    const Triangle change = changed(middle, xx, xy, yx, yy);
    const StrainStep<double> e = strain_step(middle, half(change));
    CHECK(e.xx == doctest::Approx(xx).epsilon(1e-12));
    CHECK(e.yy == doctest::Approx(yy).epsilon(1e-12));
    CHECK(std::fabs(e.xy2 - (xy + yx)) <= 1e-13);
    CHECK(std::fabs(std::atan2(e.sin, e.cos) - 2 * std::atan((yx - xy) / 4)) <= 1e-13);
    CHECK(e.twice_area == doctest::Approx(middle.twice_area()).epsilon(1e-13));
  }
}

TEST_CASE("turning a stress keeps its invariants, and turns add up") {
  Random random;
  const auto turned = [](const Stress& s, double angle) {
    return elastic_trial(s, StrainStep<double>{0, 0, 0, std::cos(angle), std::sin(angle), 1}, steel);
  };
  for (int i = 0; i < 2000; ++i) {
    const Stress s = random.stress();
    const double a = random.number(-3, 3), b = random.number(-3, 3);
    const Stress once = turned(s, a);
    CHECK(std::fabs(once.xx + once.yy - s.xx - s.yy) <= 1e-15 * 4e9);
    CHECK(std::fabs((once.xx * once.yy - once.xy * once.xy) - (s.xx * s.yy - s.xy * s.xy)) <= 1e-15 * 1e19);
    CHECK(once.zz == s.zz);
    const Stress twice = turned(once, b);
    const Stress sum = turned(s, a + b);
    CHECK(std::fabs(twice.xx - sum.xx) <= 1e-14 * 1e9);
    CHECK(std::fabs(twice.xy - sum.xy) <= 1e-14 * 1e9);
  }
  // R s R^T of a pull along x turned by 90 degrees is a pull along y.
  const Stress pull = elastic_trial(Stress{1, 0, 0, 0.5}, StrainStep<double>{0, 0, 0, 0, 1, 1}, steel);
  CHECK(pull.xx == 0);
  CHECK(pull.yy == 1);
  CHECK(pull.xy == 0);
  CHECK(pull.zz == 0.5);
}

TEST_CASE("the strain of a step is turned on by half of its turn") {
  // R_half (C de) R_half^T with matrices, against the shortcut through mean and half difference.
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const double angle = random.number(-3, 3), c = std::cos(angle / 2), s = std::sin(angle / 2);
    const double xx = random.number(), yy = random.number(), xy = random.number();
    const Stress got = elastic_trial(Stress{}, {xx, yy, 2 * xy, std::cos(angle), std::sin(angle), 1}, {2, 3});
    const double a = 2 * (xx + yy) + 6 * xx, b = 2 * (xx + yy) + 6 * yy, d = 6 * xy;
    CHECK(std::fabs(got.xx - (c * c * a - 2 * c * s * d + s * s * b)) <= 1e-14);
    CHECK(std::fabs(got.yy - (s * s * a + 2 * c * s * d + c * c * b)) <= 1e-14);
    CHECK(std::fabs(got.xy - (c * s * (a - b) + (c * c - s * s) * d)) <= 1e-14);
    CHECK(got.zz == doctest::Approx(2 * (xx + yy)));
  }
}

TEST_CASE("no triangle becomes stiffer in a step than the bound on its stretch says") {
  Random random;
  double closest = 0;
  for (const double nu : {0.0, 0.25, 0.49, -0.5}) {
    const Elasticity e = elasticity_of(200e9, nu);
    for (int i = 0; i < 20000; ++i) {
      const Triangle middle = random.triangle();
      const double size = 0.03 * (i % 3 == 0 ? 1 : 0.1);
      const double turn = i % 2 == 0 ? random.number() : 0;  // as fast as it likes
      const double xy = size * random.number(), yx = size * random.number();
      const Triangle change = changed(middle, size * random.number(), xy - turn, yx + turn, size * random.number());
      const double q = std::sqrt(stretch_squared(strain_step(middle, half(change))));
      REQUIRE(q <= 0.1);
      const double before = eigenfrequency_squared(minus(middle, half(change)), e, 1.0);
      const double after = eigenfrequency_squared(plus(middle, half(change)), e, 1.0);
      CHECK(after <= before * (1 + 1.1 * q));
      closest = std::max(closest, (after / before - 1) / (1.1 * q));
    }
  }
  CHECK(closest > 0.8);  // the bound is not a wide one
}

TEST_CASE("corner forces have no moment and do the work of the stress") {
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const Triangle t = random.triangle();
    const Stress s = random.stress();
    const double thickness = 0.01;
    const CornerForces<double> f = corner_forces(s, t, thickness / 2);
    // About corner 0, where the third force acts; it is the opposite of the other two by construction.
    const double moment = t.x1 * f.y1 - t.y1 * f.x1 + t.x2 * f.y2 - t.y2 * f.x2;
    CHECK(std::fabs(moment) <= 1e-15 * thickness * 8e9);

    // Minus the gradient of the work by central differences of each coordinate of corners 1 and 2.
    const double d = 1e-4;
    const double forces[] = {f.x1, f.y1, f.x2, f.y2};
    const Triangle ways[] = {{d, 0, 0, 0}, {0, d, 0, 0}, {0, 0, d, 0}, {0, 0, 0, d}};
    for (int k = 0; k < 4; ++k) {
      const Triangle back{-ways[k].x1, -ways[k].y1, -ways[k].x2, -ways[k].y2};
      const double gradient = (work(s, t, ways[k], thickness) - work(s, t, back, thickness)) / (2 * d);
      CHECK(std::fabs(forces[k] + gradient) <= 1e-10 * thickness * 1e9);
    }
  }
}

TEST_CASE("forces at both ends of a step do the stress work of its middle") {
  // (f_n + f_{n+1}) . dx / 2 = -A_mid t s : de for a constant stress: corner forces are linear in the sides. On this
  // the ledger's second order rests.
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const Triangle t = random.triangle();
    const Triangle d{0.1 * random.number(), 0.1 * random.number(), 0.1 * random.number(), 0.1 * random.number()};
    const Stress s = random.stress();
    const CornerForces<double> f = corner_forces(s, t, 0.5);
    const CornerForces<double> g = corner_forces(s, plus(t, d), 0.5);
    const double by_forces =
        0.5 * ((f.x1 + g.x1) * d.x1 + (f.y1 + g.y1) * d.y1 + (f.x2 + g.x2) * d.x2 + (f.y2 + g.y2) * d.y2);
    CHECK(std::fabs(by_forces + work(s, t, d, 1)) <= 1e-15 * 4e9);
  }
}

TEST_CASE("stress work and the elastic increment") {
  // Pure strain (0.01, -0.02, 0.03) on a unit triangle, without turn.
  const Triangle change{0.01, 0.015, 0.015, -0.02};
  const Triangle middle{1, 0, 0, 1};
  const StrainStep<double> e = strain_step(middle, half(change));
  CHECK(std::fabs(e.sin) <= 1e-17);
  CHECK(stress_work(Stress{3, 4, 5, 6}, e) == doctest::Approx(3 * 0.01 - 4 * 0.02 + 5 * 0.03));
  const Stress s = elastic_trial(Stress{1, 2, 3, 4}, e, Elasticity{10, 100});
  CHECK(s.xx == doctest::Approx(1 - 0.1 + 2));
  CHECK(s.yy == doctest::Approx(2 - 0.1 - 4));
  CHECK(s.xy == doctest::Approx(3 + 3));
  CHECK(s.zz == doctest::Approx(4 - 0.1));
}

TEST_CASE("the largest eigenfrequency of a triangle, against the matrix itself") {
  Random random;
  const double density = 7850;
  for (const double nu : {0.0, 0.3, 0.49, -0.5}) {
    const Elasticity e = elasticity_of(200e9, nu);
    for (int i = 0; i < 300; ++i) {
      const Triangle t = random.triangle();
      // D B B^T, B in Voigt's order (x, y, xy), from the gradients of the corner functions.
      const double twice = t.twice_area();
      const double bx[] = {(t.y1 - t.y2) / twice, t.y2 / twice, -t.y1 / twice};
      const double by[] = {(t.x2 - t.x1) / twice, -t.x2 / twice, t.x1 / twice};
      double xx = 0, yy = 0, xy = 0;
      for (int k = 0; k < 3; ++k) xx += bx[k] * bx[k], yy += by[k] * by[k], xy += bx[k] * by[k];
      const double bb[3][3] = {{xx, 0, xy}, {0, yy, xy}, {xy, xy, xx + yy}};
      const double d[3][3] = {
          {e.wave_modulus(), e.lambda, 0}, {e.lambda, e.wave_modulus(), 0}, {0, 0, e.shear_modulus}};
      double v[3] = {0.3, 0.5, 0.7};
      double largest = 0;
      for (int round = 0; round < 3000; ++round) {
        double w[3] = {}, u[3] = {};
        for (int r = 0; r < 3; ++r) {
          for (int c = 0; c < 3; ++c) w[r] += bb[r][c] * v[c];
        }
        for (int r = 0; r < 3; ++r) {
          for (int c = 0; c < 3; ++c) u[r] += d[r][c] * w[c];
        }
        largest = std::sqrt((u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) / (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
        for (int r = 0; r < 3; ++r) v[r] = u[r] / largest;
      }
      CHECK(eigenfrequency_squared(t, e, density * 0.5 * twice) ==
            doctest::Approx(3 / density * largest).epsilon(1e-6));
    }
  }
}

TEST_CASE("stable steps of well-known triangles") {
  const double density = 7850;
  const double c = std::sqrt(steel.wave_modulus() / density);
  struct Known {
    Triangle t;
    double smallest_height, factor;
  };
  const double root3 = std::sqrt(3.0);
  const Known known[] = {{{1, 0, 0, 1}, std::sqrt(0.5), 0.9065},
                         {{1, 0, 0.5, root3 / 2}, root3 / 2, 0.7888},
                         {{4, 0, 0, 1}, 4 / std::sqrt(17.0), 0.8312},
                         {{1, 0, 0.5, 0.1}, 0.1, 0.9416}};
  for (const Known& k : known) {
    const double omega = std::sqrt(eigenfrequency_squared(k.t, steel, density * 0.5 * k.t.twice_area()));
    CHECK(2 / omega * c / k.smallest_height == doctest::Approx(k.factor).epsilon(1e-4));
  }
}

TEST_CASE("a pack of lanes gives the bits of a double") {
  Random random;
  const auto pack = [](double a, double b) { return Pack(Pack::Vector{a, b}); };
  for (int i = 0; i < 500; ++i) {
    const Triangle a = random.triangle(), b = random.triangle();
    const Triangle c{0.1 * a.y1, 0.1 * a.x2, 0.1 * b.x1, 0.1 * b.y2};
    const Sides<Pack> ends{pack(b.x1, a.x1), pack(b.y1, a.y1), pack(b.x2, a.x2), pack(b.y2, a.y2)};
    const Sides<Pack> changes{pack(0, c.x1), pack(0, c.y1), pack(0, c.x2), pack(0, c.y2)};
    const StrainStep<Pack> packed = strain_step(ends, changes);
    const StrainStep<double> one = strain_step(a, c);
    CHECK(packed.xx.v[1] == one.xx);
    CHECK(packed.xy2.v[1] == one.xy2);
    CHECK(packed.cos.v[1] == one.cos);
    CHECK(packed.sin.v[1] == one.sin);
    CHECK(eigenfrequency_squared(ends, steel, Pack(7850.0)).v[1] == eigenfrequency_squared(a, steel, 7850.0));
  }
}

}  // namespace udar

#include <doctest/doctest.h>

#include <cmath>

#include "problem.hpp"

namespace udar::verification {
namespace {

constexpr double shear_modulus = 200e9 / 2.6;  // Pa
constexpr double gamma_end = 10;
constexpr double yield_stress = 400e6;  // Pa

Case shear_case(int steps) {
  Case c = load("simple-shear.toml");
  c.run.time_step = 10e-6;
  c.run.end_time = 10e-6 * steps;
  for (SupportCase& s : c.supports) {
    if (s.name == "top") s.move_x->times = {0, c.run.end_time};
  }
  return c;
}

struct Errors {
  double shear = 0;      // of t_xy, over G
  double normal = 0;     // of s_x, over G
  double lag = 0;        // of t_xy from what the step is known to compute, over G
  double symmetry = 0;   // s_x + s_y and s_z, over G
  double alike = 0;      // of the two triangles, over G
  double work = 0;       // of the stress work against G (1 - cos gamma), over G
};

/// Stress that the step leaves after n steps of `d`: it turns the old stress by 4 atan(d / 4) (in stress space) and then
/// adds the whole increment G d unturned.
struct Known {
  double shear, normal;
};
Known known(int n, double d) {
  const double turn = 4 * std::atan(d / 4);
  const double scale = shear_modulus * d / (2 * std::sin(turn / 2));
  // i d / (1 - exp(-i turn)) (1 - exp(-i turn n)), real part normal, imaginary part shear.
  return {scale * (std::sin(turn / 2) + std::sin(turn * n - turn / 2)),
          scale * (std::cos(turn / 2) - std::cos(turn * n - turn / 2))};
}

Errors shear(int steps) {
  Run run(shear_case(steps));
  Errors e;
  const double d = gamma_end / steps;
  for (int n = 1; n <= steps; ++n) {
    run.step();
    const State& s = run.state;
    const double gamma = n * d;
    const double scale = 1 / shear_modulus;
    const Known k = known(n, d);
    e.shear = std::max(e.shear, std::fabs(s.stress_xy[0] * scale - std::sin(gamma)));
    e.normal = std::max(e.normal, std::fabs(s.stress_xx[0] * scale - (1 - std::cos(gamma))));
    e.lag = std::max({e.lag, scale * std::fabs(s.stress_xy[0] - k.shear), scale * std::fabs(s.stress_xx[0] - k.normal)});
    e.symmetry = std::max({e.symmetry, scale * std::fabs(s.stress_xx[0] + s.stress_yy[0]), scale * std::fabs(s.stress_zz[0])});
    e.alike = std::max(e.alike, scale * std::fabs(s.stress_xy[0] - s.stress_xy[1]));
    e.work = std::max(e.work, std::fabs(s.ledger.stress_work.value() * scale - (1 - std::cos(gamma))));
  }
  return e;
}

}  // namespace

TEST_CASE("simple-shear: elastic to gamma = 10") {
  std::vector<Errors> errors;
  for (const int steps : {100, 200, 400, 800}) {
    const double d = gamma_end / steps;
    const Errors e = shear(steps);
    errors.push_back(e);
    MESSAGE("steps of " << d << ": t_xy off by " << e.shear << " G, s_x by " << e.normal << " G, work by " << e.work
                        << " G (bound " << 1.05 * d << "); from the known sequence by " << e.lag << ", s_x + s_y and s_z "
                        << e.symmetry << ", the two triangles " << e.alike);
    CHECK(e.shear <= 1.05 * d);
    CHECK(e.normal <= 1.05 * d);
    CHECK(e.lag <= 1e-12);
    CHECK(e.symmetry <= 1e-12);
    CHECK(e.alike <= 1e-12);
  }
  const double order = std::log(errors.front().shear / errors.back().shear) / std::log(8.0);
  MESSAGE("order " << order);
}

TEST_CASE("simple-shear: perfectly plastic") {
  const double k = yield_stress / 2;
  const double tilt = k / shear_modulus;
  for (const int steps : {100, 1000, 10000}) {
    Case c = shear_case(steps);
    c.materials[0].law = Tresca{.young_modulus = 200e9, .poisson_ratio = 0.3, .yield_stress = yield_stress};
    Run run(c);
    const double d = gamma_end / steps;
    double radius_error = 0, out_of_plane = 0;
    for (int n = 1; n <= steps; ++n) {
      run.step();
      const State& s = run.state;
      const double radius = std::hypot(0.5 * (s.stress_xx[0] - s.stress_yy[0]), s.stress_xy[0]);
      if (s.plastic_power[0] > 0) radius_error = std::max(radius_error, std::fabs(radius / k - 1));
      out_of_plane = std::max({out_of_plane, std::fabs(s.stress_zz[0]), std::fabs(s.stress_xx[0] + s.stress_yy[0])});
    }
    const double t = run.state.stress_xy[0];
    const double s_x = run.state.stress_xx[0];
    MESSAGE("steps of " << d << ": t_xy / k " << t / k << ", s_x / k " << s_x / k << "; plastic strain " << run.state.plastic_strain[0] << "radius off by " << radius_error
                        << ", s_z " << out_of_plane << " Pa; steady state t / k " << std::sqrt(1 - tilt * tilt)
                        << ", s_x / k " << tilt);
  }
}

}  // namespace udar::verification

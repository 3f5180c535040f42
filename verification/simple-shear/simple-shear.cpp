// simple-shear: large shear, against Jaumann's rate and Tresca in closed form. See README.md.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "run.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

constexpr double shear_modulus = 200e9 / 2.6;  // Pa
constexpr double gamma_end = 10;
constexpr double yield_stress = 400e6;  // Pa

Case shear_case(int steps) {
  Case c = load("simple-shear/simple-shear.toml");
  c.run.time_step = 10e-6;
  c.run.end_time = 10e-6 * steps;
  for (SupportCase& s : c.supports) {
    if (s.name == "top") s.move_x->times = {0, c.run.end_time};
  }
  return c;
}

struct Errors {
  double shear = 0;     // of t_xy, over G
  double normal = 0;    // of s_x, over G
  double known = 0;     // of both from what the step is known to compute, over G
  double symmetry = 0;  // s_x + s_y and s_z, over G
  double alike = 0;     // of the two triangles, over G
  double work = 0;      // of the stress work against G (1 - cos gamma), over G
  CheckLine path;       // t_xy / G over gamma
};

/// Stress after n steps of `d`: each turns the old stress by 4 atan(d / 4) (in the plane of (s_x - s_y) / 2 and t_xy)
/// and adds G d turned by half of that. The geometric series has the sum S sin(n turn), S (1 - cos(n turn)).
struct Known {
  double shear, normal;
};
Known known(int n, double d) {
  const double turn = 4 * std::atan(d / 4);
  const double scale = shear_modulus * (1 + d * d / 16);
  return {scale * std::sin(turn * n), scale * (1 - std::cos(turn * n))};
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
    e.path.x.push_back(gamma);
    e.path.y.push_back(s.stress_xy[0] * scale);
    e.shear = std::max(e.shear, std::fabs(s.stress_xy[0] * scale - std::sin(gamma)));
    e.normal = std::max(e.normal, std::fabs(s.stress_xx[0] * scale - (1 - std::cos(gamma))));
    e.known =
        std::max({e.known, scale * std::fabs(s.stress_xy[0] - k.shear), scale * std::fabs(s.stress_xx[0] - k.normal)});
    e.symmetry =
        std::max({e.symmetry, scale * std::fabs(s.stress_xx[0] + s.stress_yy[0]), scale * std::fabs(s.stress_zz[0])});
    e.alike = std::max(e.alike, scale * std::fabs(s.stress_xy[0] - s.stress_xy[1]));
    e.work = std::max(e.work, std::fabs(s.ledger.stress_work.value() * scale - (1 - std::cos(gamma))));
  }
  return e;
}

void check_elastic(Checks& checks) {
  ErrorSeries shear_errors{.what = "t_xy / G", .size = "step of the angle gamma", .size_unit = ""};
  ErrorSeries normal_errors{.what = "s_x / G", .size = "step of the angle gamma", .size_unit = ""};
  CheckCurve swing{.title = "Shear stress, elastic", .x_label = "gamma", .x_unit = "", .y_label = "t_xy / G"};
  for (const int steps : {100, 200, 400, 800}) {
    const double d = gamma_end / steps;
    checks.setting(fmt::format("steps of {}", d));
    const Errors e = shear(steps);
    const double for_shear = d * d * (1.0 / 16 + gamma_end / 48);
    const double for_normal = d * d * (1.0 / 8 + gamma_end / 48);
    // The turn of a step is short by d^3 / 48, the radius of the circle large by d^2 / 16: second order both.
    checks.at_most("t_xy off, over G", e.shear, 1.05 * for_shear);
    checks.at_most("s_x off, over G", e.normal, 1.05 * for_normal);
    // Work: a full circle must give nothing. A first-order rule gives d / 2 for every radian, for ever.
    checks.at_most("work off, over G", e.work, 1.05 * for_normal);
    // Rounding: some hundred steps of 1e-16 each.
    checks.at_most("stress off the known sequence, over G", e.known, 1e-12);
    checks.at_most("s_x + s_y and s_z, over G", e.symmetry, 1e-12);
    checks.at_most("difference of the two triangles, over G", e.alike, 1e-12);
    shear_errors.add(d, e.shear, 1.05 * for_shear);
    normal_errors.add(d, e.normal, 1.05 * for_normal);
    if (steps == 100) swing.lines.push_back({.name = "100 steps", .x = e.path.x, .y = e.path.y});
  }
  checks.order(shear_errors, {.expected = 2, .least = 1.9, .from = OrderFrom::ends});
  checks.series(normal_errors);
  CheckLine sine{.name = "sin(gamma)", .exact = true, .x = {}, .y = {}};
  for (int i = 0; i <= 400; ++i) {
    sine.x.push_back(i * gamma_end / 400);
    sine.y.push_back(std::sin(sine.x.back()));
  }
  swing.lines.push_back(sine);
  checks.curve(swing);
}

void check_plastic(Checks& checks) {
  const double k = yield_stress / 2;
  const double tilt = k / shear_modulus;  // steady flow: the turn of the axes balances the flow at this angle
  for (const int steps : {100, 1000, 10000}) {
    Case c = shear_case(steps);
    c.materials[0].law = Tresca{.young_modulus = 200e9, .poisson_ratio = 0.3, .yield_stress = yield_stress};
    Run run(c);
    const State& s = run.state;
    const double d = gamma_end / steps;
    double off_surface = 0, out_of_plane = 0, largest_shear = 0;
    for (int n = 1; n <= steps; ++n) {
      run.step();
      const double radius = std::hypot(0.5 * (s.stress_xx[0] - s.stress_yy[0]), s.stress_xy[0]);
      if (flows(s, 0)) off_surface = std::max(off_surface, std::fabs(radius / k - 1));
      out_of_plane = std::max({out_of_plane, std::fabs(s.stress_zz[0]), std::fabs(s.stress_xx[0] + s.stress_yy[0])});
      largest_shear = std::max(largest_shear, std::fabs(s.stress_xy[0]));
    }
    const double t = s.stress_xy[0] / k;
    const double s_x = s.stress_xx[0] / k;
    const double strain = 0.5 * (gamma_end * std::sqrt(1 - tilt * tilt) - tilt);
    checks.setting(fmt::format("steps of {}", d));
    constexpr double four_ulp = 4 * 2.220446049250313e-16;
    checks.at_most("off the yield surface, over k", off_surface, four_ulp);
    checks.at_most("largest t_xy", largest_shear, k * (1 + four_ulp), "Pa");
    checks.at_most("s_z and s_x + s_y", out_of_plane, 1e-12 * k, "Pa");
    // The return to the surface takes the direction of the end of the step: first order, half a step of turn.
    checks.near("s_x / k", s_x, tilt, 1.05 * d / 2);
    checks.near("t_xy / k", t, std::sqrt(1 - tilt * tilt), 0.55 * (tilt + d / 2) * (tilt + d / 2));
    // Flow misses k (1 - cos d) / G of d in each step, about tilt d / 2 of it.
    checks.within("plastic strain", s.plastic_strain[0], strain, 1.1 * tilt * d / 2 + 1e-6);
  }
}

}  // namespace

Problem simple_shear() {
  return {.topic = Topic::rotation,
          .parts = {{"elastic to gamma = 10", check_elastic}, {"perfectly plastic", check_plastic}}};
}

}  // namespace udar::verification

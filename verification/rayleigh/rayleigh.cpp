// rayleigh: the surface wave of a pushed half-plane, against Lamb's solution. See README.md.

#include <fmt/core.h>

#include <numbers>

#include "tools.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

constexpr double density = 7850;
constexpr double pi = std::numbers::pi;
constexpr double line_force = 1e6;  // N per metre of thickness, both halves of the half-plane
constexpr double rise = 40e-6;      // s

/// Slownesses and stiffness of the half-plane; everything is written in p = t / x (s/m), as Lamb's problem is solved by
/// Cagniard and de Hoop.
struct HalfPlaneSolution {
  double a, b;      ///< s/m, of P and S waves
  double g;         ///< Pa, shear modulus
  double rayleigh;  ///< s/m

  explicit HalfPlaneSolution(double poisson) {
    const Elasticity e = elasticity_of(200e9, poisson);
    a = std::sqrt(density / e.wave_modulus());
    b = std::sqrt(density / e.shear_modulus);
    g = e.shear_modulus;
    rayleigh = root_between([&](double p) { return -function(p); }, b * (1 + 1e-9), 2 * b);
  }

  /// Rayleigh's function for p > b.
  [[nodiscard]] double function(double p) const {
    const double n = std::pow(b * b - 2 * p * p, 2);
    return n - 4 * p * p * std::sqrt((p * p - a * a) * (p * p - b * b));
  }

  /// Velocity along the surface (away from the force) at x, time t, when the force rises as the smooth ramp of length
  /// `rise`: between the P and the S arrival Im[p (b^2 - 2 p^2 - 2 alpha beta)/R], behind it only the pole: an
  /// undistorted Rayleigh pulse.
  [[nodiscard]] double along(double x, double t) const {
    const auto kernel = [&](double p) {
      const double c = b * b - 2 * p * p;
      const double ab = std::sqrt((p * p - a * a) * (b * b - p * p));
      return 2 * p * ab * c * b * b / (c * c * c * c + 16 * std::pow(p, 4) * ab * ab);
    };
    // p = mid + half sin(s) takes the square roots at both ends away.
    const double mid = 0.5 * (a + b);
    const double half = 0.5 * (b - a);
    constexpr int points = 2000;
    double body = 0;
    for (int i = 0; i < points; ++i) {
      const double s = pi * ((i + 0.5) / points - 0.5);
      const double p = mid + half * std::sin(s);
      body += kernel(p) * ramp_rate(t - x * p) * half * std::cos(s) * pi / points;
    }
    const double r = rayleigh;
    const double ab = std::sqrt((r * r - a * a) * (r * r - b * b));  // alpha beta = -ab
    const double step = 1e-6 * r;
    const double slope = (function(r + step) - function(r - step)) / (2 * step);
    const double pole = -pi * r * (b * b - 2 * r * r + 2 * ab) / slope;
    return line_force / (pi * g) * (body + pole * ramp_rate(t - x * r));
  }

  /// Rate of s^3 (10 - 15 s + 6 s^2), s = t / rise.
  static double ramp_rate(double t) {
    const double s = t / rise;
    return s > 0 && s < 1 ? 30 * s * s * (1 - s) * (1 - s) / rise : 0;
  }
};

struct Surface {
  double speed;               ///< m/s, from the arrivals at the two stations
  double history;             ///< relative L2 error of the velocity along the surface at the far station, whole passage
  CheckLine computed, exact;  ///< that velocity over time
};

constexpr double far_station = 1.2;

/// Lamb's record at a station, tabulated.
struct ExactRecord {
  std::vector<double> values;
  double step;

  ExactRecord(const HalfPlaneSolution& exact, double x, double end) : step(end / 1500) {
    for (int i = 0; i <= 1500; ++i) values.push_back(exact.along(x, i * step));
  }
  [[nodiscard]] double at(double t) const {
    if (t < 0) return 0;
    const auto i = static_cast<std::size_t>(t / step);
    if (i + 1 >= values.size()) return values.back();
    const double s = t / step - static_cast<double>(i);
    return (1 - s) * values[i] + s * values[i + 1];
  }
};

/// How much later the computed record comes: the shift at which the exact one fits it best (largest correlation).
double delay(const Record& computed, const ExactRecord& exact) {
  Record fit;
  constexpr int shifts = 200;
  for (int i = -shifts; i <= shifts; ++i) {
    const double shift = i * (0.5 * rise / shifts);
    double sum = 0;
    for (std::size_t k = 0; k < computed.times.size(); ++k) {
      sum += computed.values[k] * exact.at(computed.times[k] - shift);
    }
    fit.add(shift, sum);
  }
  return fit.peak_time(-rise, rise);
}

Surface push(double poisson, double element_size) {
  const HalfPlaneSolution exact(poisson);
  Run run(load("rayleigh/rayleigh.toml", {fmt::format("bodies.ground.mesh.element_size={} mm", 1e3 * element_size),
                                          fmt::format("materials.steel.poisson_ratio={}", poisson)}));
  const Index near = run.model.observed_nodes[0].node;
  const Index far = run.model.observed_nodes[1].node;
  Record at_near, at_far;
  const ExactRecord exact_near(exact, run.model.rest[near].x, run.model.run.end_time);
  const ExactRecord exact_far(exact, run.model.rest[far].x, run.model.run.end_time);
  double error = 0;
  double norm = 0;
  run.run([&](const Run& now) {
    at_near.add(now.time(), velocity(now.state, near).x);
    at_far.add(now.time(), velocity(now.state, far).x);
    const double v = exact_far.at(now.time());
    error += std::pow(at_far.values.back() - v, 2);
    norm += v * v;
  });
  const double distance = run.model.rest[far].x - run.model.rest[near].x;
  const double time = distance * exact.rayleigh + delay(at_far, exact_far) - delay(at_near, exact_near);
  CheckLine lamb{.name = "Lamb", .exact = true, .x = at_far.times, .y = {}};
  for (const double t : at_far.times) lamb.y.push_back(exact_far.at(t));
  return {distance / time,
          std::sqrt(error / norm),
          {.name = fmt::format("h = {} mm", 1e3 * element_size), .x = at_far.times, .y = at_far.values},
          lamb};
}

// Linear elements, lumped masses and central difference carry wave number k at c (1 - (k h)^2 / 24) in one dimension.
// The arrival by correlation weighs that with k^2 |F|^2, F the pulse's spectrum: for the ramp's rate, a bell of length
// c_R rise = l, that is <k^4>/<k^2> = 42 / l^2, so 1.75 (h / l)^2. Twice that for the second direction: a surface wave
// is sheared as much across the depth as along.
double speed_bound(double element_size, double speed) { return 3.5 * std::pow(element_size / (speed * rise), 2); }
// The shape is shifted by 1.75 (h/l)^2 of the travel time x / c_R; times its rms wave number sqrt(12) / l.
double history_bound(double element_size, double speed) {
  const double l = speed * rise;
  return 1.75 * std::pow(element_size / l, 2) * std::sqrt(12.0) * far_station / l;
}

void check_speed(Checks& checks, double poisson, double ratio, const std::vector<double>& sizes) {
  const HalfPlaneSolution exact(poisson);
  const double c_s = 1 / exact.b;
  const double c_r = 1 / exact.rayleigh;
  checks.within("c_R / c_S", c_r / c_s, ratio, 0.0000005 / ratio);
  ErrorSeries errors{.what = "c_R"};
  ErrorSeries histories{.what = "velocity along the surface at 1.2 m, L2 error"};
  CheckCurve record{.title = fmt::format("Velocity along the surface, 1.2 m from the force, nu = {}", poisson),
                    .y_label = "velocity",
                    .y_unit = "m/s"};
  for (const double h : sizes) {
    checks.setting(fmt::format("h = {} mm", 1e3 * h));
    const Surface surface = push(poisson, h);
    checks.within("c_R", surface.speed, c_r, speed_bound(h, c_r), "m/s");
    checks.at_most("velocity along the surface at 1.2 m, L2 error", surface.history, history_bound(h, c_r));
    errors.add(h, std::fabs(surface.speed / c_r - 1), speed_bound(h, c_r));
    histories.add(h, surface.history, history_bound(h, c_r));
    record.lines.push_back(surface.computed);
    if (h == sizes.back()) record.lines.push_back(surface.exact);
  }
  checks.series(errors);
  checks.order(histories, {.expected = 2, .least = 1.5});
  checks.curve(record);
}

void check_root(Checks& checks) {
  for (const double poisson : {0.3, 0.25}) {
    const double ratio = poisson == 0.3 ? 0.927413 : 0.919402;
    const double k = (1 - 2 * poisson) / (2 - 2 * poisson);
    const auto f = [&](double x) {
      return std::pow(2 - x * x, 2) - 4 * std::sqrt(1 - x * x) * std::sqrt(1 - k * x * x);
    };
    checks.setting(fmt::format("nu = {}", poisson));
    checks.within("c_R / c_S", root_between(f, 0.5, 1 - 1e-9), ratio, 0.0000005 / ratio);
  }
}

void check_symmetry(Checks& checks) {
  Case c = load("rayleigh/rayleigh.toml");
  c.supports.clear();
  c.observed_nodes.clear();  // their places are outside of this smaller piece
  c.run.end_time = 100e-6;
  c.loads[0].value.y *= 2;
  RectangleMesh& mesh = std::get<RectangleMesh>(c.bodies[0].mesh);
  mesh.size = {0.8, 0.4};
  mesh.at = {-0.4, -0.4};
  Run run(c);
  run.run();
  checks.at_most("mirror symmetry of all velocities", mirror_error(run, true, 0, 1), 1e-11);
  checks.at_most("momentum: change less impulses", momentum_error(run), 1e-12);
}

}  // namespace

Problem rayleigh() {
  return {.topic = Topic::waves,
          .parts = {{"the root", check_root},
                    {"surface wave, nu = 0.3",
                     [](Checks& checks) {
                       check_speed(checks, 0.3, 0.927413, {0.02, 0.01});
                     }},
                    {"surface wave, nu = 0.25",
                     [](Checks& checks) {
                       check_speed(checks, 0.25, 0.919402, {0.02, 0.01});
                     }},
                    {"the whole half-plane stays symmetric", check_symmetry},
                    {.name = "finer mesh",
                     .check =
                         [](Checks& checks) {
                           check_speed(checks, 0.3, 0.927413, {0.02, 0.01, 0.005});
                         },
                     .is_long = true}}};
}

}  // namespace udar::verification

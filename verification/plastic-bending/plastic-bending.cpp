// plastic-bending: a beam bent beyond the elastic limit and back, against the exact moment. See README.md.

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

constexpr double height = 0.05;                                     // m
constexpr double modulus = 200e9 / (1 - 0.3 * 0.3);                 // Pa, E / (1 - nu^2)
constexpr double yield = 400e6;                                     // Pa, 2 k
constexpr double limit_moment = yield * height * height / 6;        // N m for 1 m, where yielding begins
constexpr double limit_curvature = 2 * yield / (modulus * height);  // 1/m
constexpr double stiffness = limit_moment / limit_curvature;        // N m2 for 1 m
constexpr double gauge = 0.05;                                      // m, half of the part that is looked at

/// Moment in a beam bent to `curvature` (Nadai, Plasticity, 1931).
double exact_moment(double curvature) {
  const double ratio = limit_curvature / curvature;
  return ratio >= 1 ? limit_moment / ratio : limit_moment * 1.5 * (1 - ratio * ratio / 3);
}

/// The middle part of the beam at one time, means along it.
struct Middle {
  double curvature = 0;  ///< 1/m
  double moment = 0;     ///< N m for 1 m
  double axial = 0;      ///< N for 1 m
};

/// Turn of the section at `x` by least squares, rad: displacement against height.
double turn_of_section(const Run& run, double x) {
  double moment = 0, square = 0;
  for (Index i = 0; i < run.model.node_count; ++i) {
    const Vec2 rest = run.model.rest[i];
    if (std::fabs(rest.x - x) > 1e-9) continue;
    moment += -run.displacement(i).x * rest.y;
    square += rest.y * rest.y;
  }
  return moment / square;
}

Middle look(const Run& run) {
  Middle out;
  out.curvature = (turn_of_section(run, gauge) - turn_of_section(run, -gauge)) / (2 * gauge);
  for (Index e = 0; e < run.model.element_count; ++e) {
    const Vec2 at = rest_centroid(run.model, e);
    if (std::fabs(at.x) > gauge) continue;
    const double force = run.state.stress_xx[e] * run.model.area_density[e] / run.model.bodies[0].density / (2 * gauge);
    out.axial += force;
    out.moment -= force * at.y;
  }
  return out;
}

/// Moments of the left and of the right support about the middle of their sections, N m.
std::array<double, 2> support_moments(const Run& run) {
  std::array<double, 2> moments{};
  std::size_t force = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    const Vec2 middle{s == 0 ? -0.15 : 0.15, 0};
    for (const Index node : run.model.supports[s].nodes) {
      moments[s] += cross(place(run.state, node) - middle, run.state.support_forces[force++]);
    }
  }
  return moments;
}

struct Bent {
  Record loading;    ///< moment against curvature (in place of time) until the beam is held
  Record unloading;  ///< curvature against moment, falling, with its sign turned: it grows
  Middle held;
  double support = 0;  ///< N m, of the right one while it is held
  double uneven = 0;   ///< sum of both supports' moments over one
  double axial = 0;    ///< over 2 k h, the largest
  double across = 0;   ///< s_z - nu (s_x + s_y) over 2 k, the largest while held
  double kinetic = 0;  ///< over internal energy, the largest from half the elastic limit on
  double energy_error = 0;
};

Bent bend(double element_size) {
  Case input = load("plastic-bending/plastic-bending.toml");
  std::get<RectangleMesh>(input.bodies[0].mesh).element_size = element_size;
  Run run(input);
  Bent out;
  int step = 0;
  bool held = false;
  run.run([&](const Run& now) {
    if (step++ % 50 != 0) return;
    const Middle m = look(now);
    out.axial = std::max(out.axial, std::fabs(m.axial) / (yield * height));
    if (m.curvature > 0.5 * limit_curvature) {
      const Ledger& ledger = now.state.ledger;
      out.kinetic = std::max(out.kinetic, ledger.kinetic_energy / ledger.stress_work.value());
    }
    if (now.time() < 16e-3) out.loading.add(m.curvature, m.moment);
    if (now.time() > 17e-3) out.unloading.add(-m.moment, m.curvature);
    if (held || now.time() < 16.5e-3) return;
    held = true;
    out.held = m;
    const auto [left, right] = support_moments(now);
    out.support = right;
    out.uneven = std::fabs(left + right) / right;
    for (Index e = 0; e < now.model.element_count; ++e) {
      if (std::fabs(rest_centroid(now.model, e).x) > gauge) continue;
      const State& s = now.state;
      const double elastic = 0.3 * (s.stress_xx[e] + s.stress_yy[e]);
      out.across = std::max(out.across, std::fabs(s.stress_zz[e] - elastic) / yield);
    }
  });
  out.energy_error = run.state.ledger.energy_error();
  return out;
}

/// Linear between the first two records round `at`.
double value_at(const Record& record, double at) {
  for (std::size_t k = 1; k < record.times.size(); ++k) {
    if (record.times[k] < at) continue;
    const double part = (at - record.times[k - 1]) / (record.times[k] - record.times[k - 1]);
    return record.values[k - 1] + part * (record.values[k] - record.values[k - 1]);
  }
  return record.values.back();
}

/// Moment over curvature, up and back.
CheckCurve against_curvature(const Bent& bent, double element_size) {
  CheckLine up{.name = fmt::format("cells of {} mm, bent", 1e3 * element_size),
               .x = bent.loading.times,
               .y = bent.loading.values};
  CheckLine back{.name = "bent back", .x = bent.unloading.values, .y = {}};
  for (const double m : bent.unloading.times) back.y.push_back(-m);
  std::reverse(back.x.begin(), back.x.end());
  std::reverse(back.y.begin(), back.y.end());
  CheckLine nadai{.name = "Nadai", .exact = true, .x = {}, .y = {}};
  for (int i = 1; i <= 300; ++i) {
    nadai.x.push_back(bent.held.curvature * i / 300);
    nadai.y.push_back(exact_moment(nadai.x.back()));
  }
  const double most = exact_moment(bent.held.curvature);
  const CheckLine springback{.name = "elastic springback",
                             .exact = true,
                             .x = {bent.held.curvature - most / stiffness, bent.held.curvature},
                             .y = {0, most}};
  return {.title = "Moment against curvature",
          .x_label = "curvature",
          .x_unit = "1/m",
          .y_label = "moment",
          .y_unit = "N m",
          .lines = {up, back, nadai, springback}};
}

struct Errors {
  double elastic, plastic;
};

Errors check_bending(Checks& checks, double element_size) {
  checks.setting(fmt::format("cells of {} mm", 1e3 * element_size));
  const Bent bent = bend(element_size);
  const double fine = element_size / height;
  // Both from the linear interpolation of the exact motion in a crossed cell, which the mesh could follow: its error in
  // the strains has 0.69 (a/h)^2 of the elastic energy, and (k for each strain difference) 0.67 a/h of the plastic
  // power at the limit. 0.3 %: the beam's own inertia.
  const double elastic = 0.69 * fine * fine + 3e-3;
  const auto plastic = [&](double ratio) { return elastic + 0.67 * fine * (1 - 1 / ratio); };
  Errors errors{};
  for (const double ratio : {0.5, 1.0, 1.5, 2.0, 3.0}) {
    const double moment = value_at(bent.loading, ratio * limit_curvature);
    const double exact = exact_moment(ratio * limit_curvature);
    if (ratio == 0.5) errors.elastic = moment / exact - 1;
    checks.within(fmt::format("moment at {} of the limit curvature", ratio), moment, exact,
                  ratio > 1 ? plastic(ratio) : elastic, "N m");
  }
  const double ratio = bent.held.curvature / limit_curvature;
  const double most = exact_moment(bent.held.curvature);
  checks.note(fmt::format("Cells of {} mm: held at {:.4g} of the limit curvature.", 1e3 * element_size, ratio));
  checks.within("moment while held", bent.held.moment, most, plastic(ratio), "N m");
  checks.within("that of the support", bent.support, most, plastic(ratio), "N m");
  checks.below("moment while held, against the limit moment", bent.held.moment,
               (1 + plastic(ratio)) * 1.5 * limit_moment, "N m");
  errors.plastic = bent.held.moment / most - 1;
  // Springback: the whole moment comes off elastically.
  const double left = value_at(bent.unloading, 0);
  checks.within("springback", bent.held.curvature - left, most / stiffness, plastic(ratio), "1/m");
  // The fibres' strain is ln(1 + kappa y): the mean of its square term, (kappa h)^2 / 24, against kappa h / 2.
  checks.at_most("axial force over 2 k h", bent.axial, bent.held.curvature * height);
  // s_z stays between s_y and s_x, flow is in the plane and s_z is elastic.
  checks.at_most("s_z off nu (s_x + s_y), over 2 k", bent.across, 1e-9);
  // Mesh, supports and motion are mirrored: what is left is rounding, which flow does not make grow.
  checks.at_most("moments of both supports together", bent.uneven, 1e-9);
  checks.at_most("kinetic over internal energy", bent.kinetic, 0.01);
  checks.at_most("energy error", bent.energy_error, 1e-3);
  checks.curve(against_curvature(bent, element_size));
  return errors;
}

void check_limits(Checks& checks) {
  checks.within("limit moment", limit_moment, 166.667e3, 1e-5, "N m");
  checks.within("limit curvature", limit_curvature, 0.0728, 1e-5, "1/m");
}

void check_orders(Checks& checks) {
  ErrorSeries elastic{.what = "elastic moment"};
  ErrorSeries plastic{.what = "moment while held"};
  for (const double size : {0.01, 0.005, 0.0025}) {
    const Errors errors = check_bending(checks, size);
    elastic.add(size, std::fabs(errors.elastic));
    plastic.add(size, std::fabs(errors.plastic));
  }
  // Squares of the strain error in the elastic range; beyond it at least its first power.
  checks.order(elastic, {.expected = 2, .least = 1.8});
  checks.order(plastic, {.least = 1});
}

}  // namespace

Problem plastic_bending() {
  return {.topic = Topic::plasticity,
          .parts = {{"where yielding begins", check_limits},
                    {"five cells through the height", [](Checks& checks) { check_bending(checks, 0.01); }},
                    {"ten cells through the height", [](Checks& checks) { check_bending(checks, 0.005); }},
                    {.name = "five, ten and twenty cells", .check = check_orders, .is_long = true}}};
}

}  // namespace udar::verification

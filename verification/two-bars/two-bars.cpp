// two-bars: two equal elastic bars that meet, against d'Alembert's solution. See README.md.

#include <fmt/core.h>

#include <cmath>

#include "tools.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

constexpr double length_of_bar = 10;  // m
constexpr double speed = 1e-3;        // m/s, of each
constexpr double impedance = 1;       // rho c, kg/(m2 s)
constexpr double contact = 20;        // s, 2 L / c

struct Meeting {
  double first = -1;  // s
  double last = 0;    // s
  double stress = 0;  // Pa, mean over the middle half of each bar while both are loaded
  double exchanged = 0;
  double momentum = 0;
  double energy = 0;
  Record force;  // N, on the left bar, from the change of its momentum
};

/// Two meshes: that of the left bar and that of the right one.
Meeting meet(double left, double right) {
  Case input = load("two-bars/two-bars.toml");
  std::get<RectangleMesh>(input.bodies[0].mesh).element_size = left;
  std::get<RectangleMesh>(input.bodies[1].mesh).element_size = right;
  Run run(input);
  Meeting m;
  Record stress;
  const double before = run.state.body_momentum[0].x;
  double time_before = 0;
  double momentum_before = before;
  run.run([&](const Run& now) {
    if (now.time() >= time_before + 0.1) {
      const double momentum = now.state.body_momentum[0].x;
      m.force.add(now.time(), (momentum_before - momentum) / (now.time() - time_before));
      time_before = now.time();
      momentum_before = momentum;
    }
    if (!now.state.touches.empty()) {
      if (m.first < 0) m.first = now.time();
      m.last = now.time();
    }
    double sum = 0;
    int count = 0;
    for (const Body& body : now.model.bodies) {
      for (Index e = body.element_begin; e < body.element_end; ++e) {
        const double x = std::fabs(rest_centroid(now.model, e).x);
        if (x < 0.4 * length_of_bar || x > 0.6 * length_of_bar) continue;
        sum += now.state.stress_xx[e];
        ++count;
      }
    }
    stress.add(now.time(), sum / count);
  });
  m.stress = stress.mean(0.8 * length_of_bar, 1.2 * length_of_bar);
  m.exchanged = (before - run.state.body_momentum[0].x) / (2 * before);
  m.momentum = length(run.state.body_momentum[0] + run.state.body_momentum[1]) / before;
  m.energy = run.state.ledger.energy_error();
  return m;
}

void check(Checks& checks, double left, double right) {
  checks.setting(fmt::format("{} m, {} m", left, right));
  const Meeting m = meet(left, right);
  const double h = std::max(left, right);
  const double l = airy_length(h, 2 * length_of_bar);
  // As for a bar on a wall: the front that ends the contact has run 2 L and is as wide as Airy's length.
  checks.within("contact", m.last - m.first, contact, (2 * l + h) / contact, "s");
  checks.within("stress", m.stress, -impedance * speed, 0.01, "Pa");
  checks.within("momentum exchanged", m.exchanged, 1, 0.25 * l / length_of_bar);
  checks.below("momentum exchanged is less than all", m.exchanged, 1);
  checks.at_most("momentum of both", m.momentum, 1e-12);
  checks.at_most("energy error", m.energy, 1e-3);
  checks.curve({.title = "Force between the bars",
                .y_label = "force",
                .y_unit = "N",
                .lines = {{.name = fmt::format("cells of {} m and {} m, mean over 0.1 s", left, right),
                           .x = m.force.times,
                           .y = m.force.values},
                          {.name = "exact",
                           .exact = true,
                           .x = {0, contact, contact, 30},
                           .y = {impedance * speed, impedance * speed, 0, 0}}}});
}

}  // namespace

Problem two_bars() {
  return {.topic = Topic::waves,
          .parts = {
              {"equal meshes", [](Checks& checks) { check(checks, 0.05, 0.05); }},
              {"one mesh two and a half times as fine", [](Checks& checks) { check(checks, 0.05, 0.02); }},
              {.name = "fine meshes", .check = [](Checks& checks) { check(checks, 0.02, 0.02); }, .is_long = true},
          }};
}

}  // namespace udar::verification

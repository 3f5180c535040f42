// two-bars: two equal elastic bars that meet, against d'Alembert's solution. See README.md.

#include <doctest/doctest.h>
#include <fmt/core.h>

#include <cmath>

#include "wave_tools.hpp"

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
};

/// Two meshes: that of the left bar and that of the right one.
Meeting meet(double left, double right) {
  Case input = load("two-bars.toml");
  std::get<RectangleMesh>(input.bodies[0].mesh).element_size = left;
  std::get<RectangleMesh>(input.bodies[1].mesh).element_size = right;
  Run run(input);
  Meeting m;
  Record stress;
  const double before = run.state.body_momentum[0].x;
  run.run([&](const Run& now) {
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

void check(double left, double right) {
  CAPTURE(left);
  CAPTURE(right);
  const Meeting m = meet(left, right);
  const double h = std::max(left, right);
  const double l = airy_length(h, 2 * length_of_bar);
  // As for a bar on a wall: the front that ends the contact has run 2 L and is as wide as Airy's length.
  CHECK(within("contact (s)", m.last - m.first, contact, (2 * l + h) / contact));
  CHECK(within("stress (Pa)", m.stress, -impedance * speed, 0.01));
  CHECK(within("momentum exchanged", m.exchanged, 1, 0.25 * l / length_of_bar));
  CHECK(m.exchanged < 1);
  CHECK(below("momentum of both", m.momentum, 1e-12));
  CHECK(below("energy error", m.energy, 1e-3));
}

}  // namespace

TEST_CASE("two-bars: equal meshes") { check(0.05, 0.05); }
TEST_CASE("two-bars: one mesh two and a half times as fine") { check(0.05, 0.02); }
TEST_CASE("two-bars: the contact within 1 % (long)") { check(0.02, 0.02); }

}  // namespace udar::verification

// integrators: order, growth and limits on an oscillator, against the roots of the rules. See README.md.

#include "udar/step/integrators.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "run.hpp"
#include "udar/step/stages.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

constexpr double omega = 100;    // 1/s
constexpr double speed = -0.01;  // m/s, at the start
constexpr double amplitude = 1e-4;
using Complex = std::complex<double>;

/// The oscillator, with the size of every step in the hands of the check: also steps that the program would refuse or
/// come to slowly. The stages are those of the step, in its order; loads and supports there are none.
struct Oscillator {
  explicit Oscillator(Integrator kind, double step, double start_speed = speed)
      : model(build_model(with(kind, start_speed))), work(model, 1), state(rest_state(model)) {
    find_frequencies(model, state, work);
    touch_bodies(model, state, work);
    choose_time_step(model, state, work);
    state.clock.next_step = step;
    open_books(model, state);
    sweep(model, state, work);
    close_books(model, state, work);
  }
  static Case with(Integrator kind, double start_speed) {
    Case c = load("integrators/integrators.toml");
    c.run.integrator = kind;
    c.bodies[0].velocity.y = start_speed;
    return c;
  }
  /// One step; the next one will be `next` (s) long.
  void step(double next) {
    advance_clock(model, state);
    state.clock.next_step = next;
    touch_bodies(model, state, work);
    sweep(model, state, work);
    close_books(model, state, work);
  }
  void step() { step(state.clock.last_step > 0 ? state.clock.last_step : state.clock.next_step); }
  [[nodiscard]] double place() const { return state.nodes[0].y - model.rest[0].y; }

  Model model;
  Workspace work;
  State state;
};

/// The roots of an integrator on the oscillator, z = omega h. A motion x_n = c L^n solves
///   (L - 1)^2 + z^2 (B + (L - 1) C) = 0,  B = sum b_j L^-j,  C = sum c_j L^-j
/// with b and c the weights of velocity and place over h and h (with the new velocity C is b itself: B + (L - 1) B).
std::vector<Complex> roots(Integrator kind, double z) {
  std::vector<double> polynomial;  // highest power first
  const double z2 = z * z;
  switch (kind) {
    case Integrator::central_difference:
      polynomial = {1, z2 - 2, 1};
      break;
    case Integrator::adams:  // times L^2
      polynomial = {1, -2 + z2 * 19 / 24, 1 + z2 * (23.0 / 12 - 19.0 / 24 - 10.0 / 24),
                    z2 * (-16.0 / 12 + 10.0 / 24 + 3.0 / 24), z2 * (5.0 / 12 - 3.0 / 24)};
      break;
    case Integrator::adams2:  // times L
      polynomial = {1, -2 + z2 * 4 / 6, 1 + z2 * (3.0 / 2 - 4.0 / 6 - 1.0 / 6), z2 * (-1.0 / 2 + 1.0 / 6)};
      break;
    case Integrator::adams2_new_velocity:
      polynomial = {1, -2 + z2 * 3 / 2, 1 - z2 / 2};
      break;
  }
  // Durand and Kerner: all roots at once.
  std::vector<Complex> found;
  for (std::size_t i = 1; i < polynomial.size(); ++i) found.push_back(std::pow(Complex(0.4, 0.9), double(i)));
  for (int round = 0; round < 2000; ++round) {
    for (std::size_t i = 0; i < found.size(); ++i) {
      Complex value = 0, others = 1;
      for (const double p : polynomial) value = value * found[i] + p;
      for (std::size_t j = 0; j < found.size(); ++j) {
        if (j != i) others *= found[i] - found[j];
      }
      found[i] -= value / others;
    }
  }
  return found;
}

double largest_root(Integrator kind, double z) {
  double largest = 0;
  for (const Complex root : roots(kind, z)) largest = std::max(largest, std::abs(root));
  return largest;
}

/// Modulus of the root near exp(i z): the physical one.
double physical_root(Integrator kind, double z) {
  const Complex exact = std::exp(Complex(0, z));
  Complex nearest = 99;
  for (const Complex root : roots(kind, z)) {
    if (std::abs(root - exact) < std::abs(nearest - exact)) nearest = root;
  }
  return std::abs(nearest);
}

/// The z at which the largest root leaves the unit circle.
double limit_by_roots(Integrator kind) {
  double low = 0.5, high = 2.5;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (largest_root(kind, middle) > 1 + 1e-6 ? high : low) = middle;
  }
  return low;
}

/// Growth of the amplitude per step, from x_{n+2} = p x_{n+1} - q x_n fitted over the run: the modulus is sqrt(q).
double measured_modulus(Integrator kind, double z) {
  Oscillator o(kind, z / omega);
  double a11 = 0, a12 = 0, a22 = 0, b1 = 0, b2 = 0;
  double x0 = 0, x1 = 0;
  for (int n = 0; n < 600; ++n) {
    o.step();
    const double x2 = o.place();
    if (std::fabs(x2) > 8 * amplitude) break;  // it would soon leave its anvils
    if (n > 100) {                             // the other roots have died away
      a11 += x1 * x1;
      a12 -= x1 * x0;
      a22 += x0 * x0;
      b1 += x1 * x2;
      b2 -= x0 * x2;
    }
    x0 = x1;
    x1 = x2;
  }
  return std::sqrt((a11 * b2 - a12 * b1) / (a11 * a22 - a12 * a12));
}

/// Steps until the place is a hundred times the amplitude of the exact motion (far more than central difference
/// overshoots just below its limit, by 1 / sqrt(1 - z^2 / 4)); 0: not within `most`.
int steps_to_grow(Integrator kind, double z, int most) {
  constexpr double start_speed = -1e-6;
  Oscillator o(kind, z / omega, start_speed);
  for (int n = 1; n <= most; ++n) {
    o.step();
    if (std::fabs(o.place()) > 100 * std::fabs(start_speed) / omega) return n;
  }
  return 0;
}

/// Largest error of place over the phase 0 .. 4, over the amplitude. Steps repeat the pattern.
double solution_error(Integrator kind, double h, const std::vector<double>& pattern) {
  Oscillator o(kind, pattern[0] * h);
  double largest = 0;
  for (std::size_t n = 0; o.state.clock.time.value() < 4 / omega; ++n) {
    o.step(pattern[(n + 1) % pattern.size()] * h);
    const double exact = speed / omega * std::sin(omega * o.state.clock.time.value());
    largest = std::max(largest, std::fabs(o.place() - exact) / amplitude);
  }
  return largest;
}

struct Expected {
  Integrator kind;
  double order;
  double limit;   // 0: never stable
  double growth;  // per step at z = 0.1, leading term
  double error;   // bound of the solution error: this times z^order over the phase 4
};

constexpr double z4 = 1e-4;  // 0.1^4
const Expected expected[] = {
    {Integrator::central_difference, 2, 2, 0, 1},
    {Integrator::adams, 3, 0.966, -1.9e-5, 4},
    {Integrator::adams2, 2, 0, z4 / 6, 4},
    {Integrator::adams2_new_velocity, 1, 1.414, -0.01 / 4, 4},
};

std::string name(Integrator kind) { return rule_of(kind).keyword; }

void check_growth(Checks& checks) {
  CheckCurve growths{.title = "Growth of the amplitude per step",
                     .x_label = "z, step times frequency",
                     .x_unit = "",
                     .y_label = "growth per step"};
  for (const Expected& e : expected) {
    CheckLine line{.name = name(e.kind), .x = {}, .y = {}};
    CheckLine by_root{.name = name(e.kind) + ", by the root", .exact = true, .x = {}, .y = {}};
    for (const double z : {0.05, 0.1, 0.2, 0.4}) {
      checks.setting(fmt::format("{}, z = {}", name(e.kind), z));
      // The fit is exact for two roots; what the others leave after 100 steps, and rounding, is below 1e-9.
      const double measured = measured_modulus(e.kind, z);
      checks.near("amplitude after a step, by the root", measured, physical_root(e.kind, z), 1e-9);
      line.x.push_back(z);
      line.y.push_back(measured - 1);
    }
    for (int i = 10; i <= 80; ++i) {
      by_root.x.push_back(0.005 * i);
      by_root.y.push_back(physical_root(e.kind, 0.005 * i) - 1);
    }
    growths.lines.push_back(line);
    growths.lines.push_back(by_root);
    // The table's leading term; the next is z^2 = 1 % of it, with a factor of order 1 to 10.
    const double growth = measured_modulus(e.kind, 0.1) - 1;
    checks.setting(fmt::format("{}, z = 0.1", name(e.kind)));
    checks.near("growth per step, leading term", growth, e.growth, std::max(0.1 * std::fabs(e.growth), 1e-11));
  }
  checks.curve(growths);
}

void check_limits(Checks& checks) {
  for (const Expected& e : expected) {
    checks.setting(name(e.kind));
    if (e.limit == 0) {
      // Grows at any step, slowly at a small one: z^4 / 6 a step.
      const double by_growth = std::log(100.0) / std::log(physical_root(e.kind, 0.3));
      checks.within("steps to grow a hundred times at z = 0.3, by the root", steps_to_grow(e.kind, 0.3, 20000),
                    by_growth, 0.02);
      checks.equal("stable limit that the program tells (0: never stable)", rule_of(e.kind).stable_limit, 0);
      continue;
    }
    // The program has three digits of it, cut off.
    checks.near("limit by the roots", limit_by_roots(e.kind), e.limit, 1e-3);
    checks.equal("stable limit that the program tells (0: never stable)", rule_of(e.kind).stable_limit, e.limit);
    checks.holds("bounded for 20 000 steps 1 % below it", steps_to_grow(e.kind, 0.99 * e.limit, 20000) == 0);
    checks.above("steps to grow a hundred times 1 % above it", steps_to_grow(e.kind, 1.01 * e.limit, 20000), 0);
  }
}

void check_order(Checks& checks, const std::vector<double>& pattern) {
  for (const Expected& e : expected) {
    ErrorSeries errors{.what = "place, " + name(e.kind), .size = "time step", .size_unit = "s"};
    for (const double h : {4e-4, 2e-4, 1e-4, 0.5e-4}) {
      checks.setting(fmt::format("{}, {} us", name(e.kind), 1e6 * h));
      const double z = (pattern.size() == 1 ? 1 : 1.6) * omega * h;
      const double error = solution_error(e.kind, h, pattern);
      const double bound = e.error * std::pow(z, e.order);
      checks.at_most("largest error of place over the amplitude", error, bound);
      errors.add(h, error, bound);
    }
    checks.order(errors,
                 {.expected = e.order, .least = e.order - 0.15, .most = e.order + 0.5, .from = OrderFrom::ends});
  }
}

void check_books(Checks& checks) {
  for (const Expected& e : expected) {
    ErrorSeries errors{.what = "energy books, " + name(e.kind), .size = "time step", .size_unit = "s"};
    for (const double h : {4e-4, 2e-4, 1e-4}) {
      Oscillator o(e.kind, h);
      while (o.state.clock.time.value() < 4 / omega) o.step();
      const Ledger& ledger = o.state.ledger;
      errors.add(h, ledger.energy_gap / (0.5 * 6000 * speed * speed));
      // Momentum = impulses, whatever the integrator: the same weights enter both.
      checks.setting(fmt::format("{}, {} us", name(e.kind), 1e6 * h));
      checks.at_most("momentum less impulses", ledger.momentum_gap, 1e-12 * 6000 * 10 * 4 / omega, "N s");
    }
    if (e.kind == Integrator::central_difference) {
      // m v-.v+ / 2 + k x^2 / 2 is what it keeps exactly on a linear spring: rounding only.
      checks.setting(name(e.kind));
      checks.at_most("energy books apart, over the energy at the start", errors.errors.front(), 1e-8);
    } else {
      checks.order(errors, {.expected = e.order, .least = std::min(2.0, e.order) - 0.2, .from = OrderFrom::ends});
    }
  }
}

}  // namespace

Problem integrators() {
  return {.topic = Topic::scheme,
          .parts = {{"growth of the amplitude per step", check_growth},
                    {"stable limit", check_limits},
                    {"order of the solution, equal steps", [](Checks& checks) { check_order(checks, {1}); }},
                    {"order of the solution, unequal steps",
                     [](Checks& checks) {
                       check_order(checks, {1, 1.6, 0.7, 1.2});
                     }},
                    {"the books of work and impulse agree with the motion", check_books}}};
}

}  // namespace udar::verification

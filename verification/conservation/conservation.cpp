// conservation: the books of momentum, spin and energy, and faults planted on purpose. See README.md.

#include <fmt/core.h>

#include <cmath>

#include "run.hpp"
#include "udar/step/motion.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

Vec2 place(const Run& run, Index i) { return {run.state.nodes[i].x, run.state.nodes[i].y}; }
Vec2 coming(const Run& run, Index i) { return {run.state.nodes[i].vx, run.state.nodes[i].vy}; }

/// Compensated, so that the check itself rounds less than what it checks.
struct Sum2 {
  CompensatedSum x, y;
  void add(Vec2 v) { x.add(v.x), y.add(v.y); }
  [[nodiscard]] Vec2 value() const { return {x.value(), y.value()}; }
};

Vec2 centre_of_mass(const Run& run) {
  Sum2 sum;
  for (Index i = 0; i < run.model.node_count; ++i) sum.add(run.model.mass[i] * place(run, i));
  return (1 / run.model.bodies[0].mass) * sum.value();
}

/// Spin momentum about the origin with the velocity of the coming step, as the ledger has it; and its size.
double spin(const Run& run) {
  CompensatedSum sum;
  for (Index i = 0; i < run.model.node_count; ++i) sum.add(run.model.mass[i] * cross(place(run, i), coming(run, i)));
  return sum.value();
}
double spin_scale(const Run& run) {
  double sum = 0;
  for (Index i = 0; i < run.model.node_count; ++i) {
    sum += run.model.mass[i] * length(place(run, i)) * length(coming(run, i));
  }
  return sum;
}

/// Moment of the contact forces about the origin, N m.
double contact_moment(const Run& run) {
  double moment = 0;
  for (std::size_t c = 0; c < run.state.contacts.size(); ++c) {
    const SpringState& s = run.state.contacts[c];
    if (s.touches == 0) continue;
    moment += cross(place(run, run.model.contact_nodes[c]), s.normal_force + s.friction_force + s.damping_force);
  }
  for (const CornerTouch& touch : run.state.corner_touches) {
    for_each_force(run.model.segments, touch, [&](std::uint32_t point, const TouchForces& f) {
      moment += cross(place(run, run.model.contact_nodes[point]), f.total());
    });
  }
  return moment;
}

struct Variant {
  std::string name;
  bool plastic;
  double friction;
  bool gravity;
};

Case impact_case(const Variant& v) {
  Case c = load("conservation/conservation.toml");
  if (!v.plastic) c.materials[0].law = Elastic{.young_modulus = 200e9, .poisson_ratio = 0.3};
  c.obstacles[0].friction = v.friction;
  if (!v.gravity) c.run.gravity = {};
  return c;
}

/// What a run of a variant shows. Momentum and spin are over their sizes at the start.
struct Outcome {
  double flight_begin = 0;  // s
  double momentum_error = 0, spin_error = 0;
  double flight_momentum = 0, flight_spin = 0, path_error = 0;
  double energy_bound = 0;
};

Outcome watch(Run& run) {
  const double mass = run.model.bodies[0].mass;
  const Vec2 g = run.model.run.gravity;
  const Ledger& ledger = run.state.ledger;
  const double start_spin = spin(run);
  const double scale = spin_scale(run);
  CompensatedSum moment;  // of contact and weight, through the current velocity
  Outcome out;
  struct {
    double time = 0, spin = 0;
    Vec2 centre, velocity, momentum;
  } left;
  double path_error = 0, flight_momentum = 0, flight_spin = 0, reach = 0;
  std::vector<bool> touched(run.model.contact_nodes.size());
  while (!run.done()) {
    run.step();
    const Clock& clock = run.state.clock;
    moment.add(velocity_span(clock) * (contact_moment(run) + mass * cross(centre_of_mass(run), g)));
    const bool touches = run.state.obstacles[0].touching > 0;
    for (std::size_t k = 0; k < touched.size(); ++k) touched[k] = touched[k] || run.state.contacts[k].touches != 0;
    if (touches) out.flight_begin = 0;
    if (!touches && out.flight_begin == 0) {
      out.flight_begin = run.time();
      left = {run.time(), spin(run), centre_of_mass(run), {}, ledger.momentum};
      // The centre of mass moves on with the mean velocity of the coming step; at t_n it had half a kick of gravity
      // less.
      left.velocity = (1 / mass) * ledger.momentum - (0.5 * clock.next_step) * g;
      path_error = flight_momentum = flight_spin = reach = 0;
    }
    if (out.flight_begin == 0 || run.time() == out.flight_begin) continue;
    const double t = run.time() - left.time;
    const double to_middle = t + 0.5 * clock.next_step;
    const Vec2 exact = left.centre + t * left.velocity + (0.5 * t * t) * g;
    path_error = std::max(path_error, length(centre_of_mass(run) - exact));
    reach = std::max(reach, length(exact - left.centre));
    flight_momentum = std::max(flight_momentum, length(ledger.momentum - mass * (left.velocity + to_middle * g)));
    // About the centre of mass, which gravity does not turn.
    const double own = spin(run) - mass * cross(centre_of_mass(run), (1 / mass) * ledger.momentum);
    const double own_left = left.spin - mass * cross(left.centre, (1 / mass) * left.momentum);
    flight_spin = std::max(flight_spin, std::fabs(own - own_left));
  }
  const Vec2 change = ledger.momentum - ledger.start_momentum;
  const ForceBook& stop = run.state.obstacles[0].total;
  const double weight_time = run.time() + 0.5 * run.state.clock.next_step;
  out.momentum_error = length(change - stop.impulse() - (mass * weight_time) * g) / ledger.momentum_scale;
  out.spin_error = std::fabs(spin(run) - start_spin - moment.value()) / scale;
  out.flight_momentum = flight_momentum / ledger.momentum_scale;
  out.flight_spin = flight_spin / scale;
  out.path_error = path_error / reach;
  // A spring that is met within a step: force x way / 2 is off k d^2 / 2 by at most k (v h)^2 / 8. Every node that
  // ever touches enters and leaves at the speed of the impact at most.
  for (std::size_t k = 0; k < touched.size(); ++k) {
    const double h = run.state.clock.largest_step;
    if (touched[k]) out.energy_bound += 2 * run.model.obstacles[0].normal_stiffness[k] * h * h / (4 * mass);
  }
  return out;
}

void check_impact(Checks& checks, const Variant& variant) {
  Run run(impact_case(variant));
  const Outcome out = watch(run);
  const Ledger& ledger = run.state.ledger;
  const double bound = variant.gravity ? 1e-9 : 1e-12;
  checks.setting(variant.name);
  checks.above("it leaves the stop, at", out.flight_begin, 0, "s");
  // Internal forces cancel, friction and spring act at the same point: exact but for rounding, which in sums over
  // 2000 to 4000 steps stays a thousand times below 1e-12.
  checks.at_most("momentum: change less impulses of stop and weight", out.momentum_error, 1e-12);
  checks.at_most("momentum: gap in the books", ledger.momentum_gap / ledger.momentum_scale, 1e-12);
  checks.at_most("spin: change less moments", out.spin_error, 1e-12);
  checks.at_most("momentum in flight", out.flight_momentum, bound);
  checks.at_most("spin about the centre of mass in flight", out.flight_spin, bound);
  checks.at_most("path of the centre of mass in flight", out.path_error, bound);
  checks.at_most("energy: identity error", ledger.identity_error(), 1e-11);
  checks.at_most("energy error", ledger.energy_error(), out.energy_bound);
  if (variant.plastic) {
    checks.above("plastic work over the energy at the start", ledger.plastic_work.value() / ledger.start_energy, 0.5);
  }
  if (variant.friction > 0) checks.above("friction work", ledger.friction_work.value(), 0, "J");
}

void check_impacts(Checks& checks) {
  for (const Variant& variant :
       {Variant{"elastic, smooth, no gravity", false, 0, false}, Variant{"elastic, rough, gravity", false, 0.35, true},
        Variant{"plastic, smooth, gravity", true, 0, true}, Variant{"plastic, rough, no gravity", true, 0.35, false}}) {
    check_impact(checks, variant);
  }
}

/// The largest energy error with a fixed step.
double smooth_error(double step) {
  Case c = load("conservation/smooth-mode.toml");
  c.run.time_step = step;
  Run run(c);
  run.run();
  return run.state.ledger.energy_error();
}

void check_smooth(Checks& checks) {
  for (const bool clipped : {false, true}) {
    // Steps that divide the end time, and steps of which the last one is cut to a third.
    const double end = 0.1e-3;
    ErrorSeries errors{.what = clipped ? "energy error, the last step cut to a third" : "energy error",
                       .size = "time step",
                       .size_unit = "s"};
    for (const int steps : {128, 256, 512, 1024}) {
      const double step = end / (clipped ? steps - 0.67 : steps);
      errors.add(step, smooth_error(step));
    }
    checks.order(errors, {.expected = 2, .least = 1.8, .from = OrderFrom::ends});
  }
}

void check_small_steps(Checks& checks) {
  for (const bool plastic : {false, true}) {
    const std::string name = plastic ? "plastic" : "elastic";
    ErrorSeries errors{.what = name + " impact, energy error", .size = "time step", .size_unit = "s"};
    for (const double step : {6e-7, 3e-7, 1.5e-7}) {
      Case c = impact_case({"", plastic, 0.35, true});
      c.run.end_time = 1e-3;
      c.run.time_step = step;
      Run run(c);
      run.run();
      errors.add(step, run.state.ledger.energy_error());
      checks.setting(fmt::format("{}, {:.2g} us", name, 1e6 * step));
      checks.equal("steps that were shortened", static_cast<double>(run.state.clock.shortened), 0);
    }
    // Touch, release, change of face and onset of sliding have kinks: between 1 and 2.
    checks.order(errors, {.least = 0.85, .from = OrderFrom::ends});
  }
}

void check_bouncing(Checks& checks) {
  Run run(load("conservation/bouncing.toml"));
  int landings = 0;
  bool touched = false;
  for (int n = 0; n < 100000; ++n) {
    run.step();
    const bool touches = run.state.obstacles[0].touching > 0;
    if (touches && !touched) ++landings;
    touched = touches;
  }
  const Ledger& ledger = run.state.ledger;
  checks.above("landings", landings, 5);
  // Compensated sums: what is left is the rounding of each step's terms, 1e-16 of the energy, as a random walk 3e-14.
  checks.at_most("energy: identity error", ledger.identity_error(), 1e-11);
  checks.at_most("momentum: gap in the books", ledger.momentum_gap / ledger.momentum_scale, 1e-11);
}

/// In mid-flight one node gets a millionth more velocity than its forces give it.
void check_planted(Checks& checks) {
  Case c = impact_case({"", true, 0.35, true});
  c.run.end_time = 0.5e-3;
  Run honest(c);
  while (honest.time() < 0.25e-3) honest.step();
  State planted = honest.state;
  const Index node = honest.model.node_count / 2;
  const double kick = 1e-6 * planted.nodes[node].vy;
  const double energy = honest.model.mass[node] * kick * planted.nodes[node].vy;
  planted.nodes[node].vy += kick;
  Workspace work(honest.model, 1);
  while (!finished(honest.model, planted)) step(honest.model, planted, work);
  honest.run();
  const Ledger& right = honest.state.ledger;
  const Ledger& wrong = planted.ledger;
  const double momentum = honest.model.mass[node] * std::fabs(kick);
  checks.within("identity gap, the energy of the kick", wrong.identity_gap, std::fabs(energy), 1e-2, "J");
  checks.within("momentum gap, the momentum of the kick", wrong.momentum_gap, momentum, 1e-2, "N s");
  checks.above("identity gap over that without the kick", wrong.identity_gap / right.identity_gap, 100);
  checks.above("momentum gap over that without the kick", wrong.momentum_gap / right.momentum_gap, 100);
}

}  // namespace

Problem conservation() {
  return {.topic = Topic::conservation,
          .parts = {{"impact and flight", check_impacts},
                    {"the energy error falls with the square of the step", check_smooth},
                    {"the energy error of an impact under smaller steps", check_small_steps},
                    {"100 000 steps of bouncing", check_bouncing},
                    {"a planted error shows in the books", check_planted}}};
}

}  // namespace udar::verification

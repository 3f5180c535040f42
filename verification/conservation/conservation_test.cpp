#include <doctest/doctest.h>

#include <cmath>

#include "problem.hpp"
#include "udar/step/motion.hpp"

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
  Case c = load("conservation.toml");
  if (!v.plastic) c.materials[0].law = Elastic{.young_modulus = 200e9, .poisson_ratio = 0.3};
  c.obstacles[0].friction = v.friction;
  if (!v.gravity) c.run.gravity = {};
  return c;
}

}  // namespace

TEST_CASE("conservation: impact and flight") {
  const Variant variants[] = {{"elastic, smooth, no gravity", false, 0, false},
                              {"elastic, rough, gravity", false, 0.35, true},
                              {"plastic, smooth, gravity", true, 0, true},
                              {"plastic, rough, no gravity", true, 0.35, false}};
  for (const Variant& variant : variants) {
    Run run(impact_case(variant));
    const double mass = run.model.bodies[0].mass;
    const Vec2 g = run.model.run.gravity;
    const Ledger& ledger = run.state.ledger;
    const double start_spin = spin(run);
    const double scale = spin_scale(run);
    CompensatedSum moment;  // of contact and weight, through the current velocity
    double flight_begin = 0;
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
      if (touches) flight_begin = 0;
      if (!touches && flight_begin == 0) {
        flight_begin = run.time();
        left = {run.time(), spin(run), centre_of_mass(run), {}, ledger.momentum};
        // The centre of mass moves on with the mean velocity of the coming step; at t_n it had half a kick of gravity
        // less.
        left.velocity = (1 / mass) * ledger.momentum - (0.5 * clock.next_step) * g;
        path_error = flight_momentum = flight_spin = reach = 0;
      }
      if (flight_begin == 0 || run.time() == flight_begin) continue;
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
    const double momentum_error = length(change - stop.impulse() - (mass * weight_time) * g) / ledger.momentum_scale;
    const double spin_error = std::fabs(spin(run) - start_spin - moment.value()) / scale;
    const double bound = variant.gravity ? 1e-9 : 1e-12;
    // A spring that is met within a step: force x way / 2 is off k d^2 / 2 by at most k (v h)^2 / 8. Every node that
    // ever touches enters and leaves at the speed of the impact at most.
    double energy_bound = 0;
    for (std::size_t k = 0; k < touched.size(); ++k) {
      const double h = run.state.clock.largest_step;
      if (touched[k]) energy_bound += 2 * run.model.obstacles[0].normal_stiffness[k] * h * h / (4 * mass);
    }
    MESSAGE(variant.name << ": " << run.state.clock.step << " steps, momentum change " << change.y
                         << ", impulse of the stop " << stop.impulse().y << " N s: off by " << momentum_error
                         << ", books by " << ledger.momentum_gap / ledger.momentum_scale
                         << "; spin momentum less moments " << spin_error << " (bound 1e-12)");
    MESSAGE(variant.name << ": flies from " << flight_begin << " s for " << run.time() - flight_begin
                         << " s: momentum off by " << flight_momentum / ledger.momentum_scale
                         << ", spin about the centre of mass by " << flight_spin / scale << ", path by "
                         << path_error / reach << " (bound " << bound << ")");
    MESSAGE(variant.name << ": energy error " << ledger.energy_error() << " (bound " << energy_bound
                         << "), identity error " << ledger.identity_error() << " (bound 1e-11); plastic "
                         << ledger.plastic_work.value() << ", friction " << ledger.friction_work.value() << ", dropped "
                         << ledger.dropped_energy.value() << " of " << ledger.start_energy << " J");
    CHECK(flight_begin > 0);
    // Internal forces cancel, friction and spring act at the same point: exact but for rounding, which in sums over
    // 2000 to 4000 steps stays a thousand times below 1e-12.
    CHECK(momentum_error <= 1e-12);
    CHECK(ledger.momentum_gap <= 1e-12 * ledger.momentum_scale);
    CHECK(spin_error <= 1e-12);
    CHECK(flight_momentum <= bound * ledger.momentum_scale);
    CHECK(flight_spin <= bound * scale);
    CHECK(path_error <= bound * reach);
    CHECK(ledger.identity_error() <= 1e-11);
    CHECK(ledger.energy_error() <= energy_bound);
    if (variant.plastic) CHECK(ledger.plastic_work.value() > 0.5 * ledger.start_energy);
    if (variant.friction > 0) CHECK(ledger.friction_work.value() > 0);
  }
}

namespace {

/// The largest energy error with a fixed step.
double smooth_error(double step) {
  Case c = load("smooth-mode.toml");
  c.run.time_step = step;
  Run run(c);
  run.run();
  return run.state.ledger.energy_error();
}

}  // namespace

TEST_CASE("conservation: the energy error falls with the square of the step") {
  for (const bool clipped : {false, true}) {
    // Steps that divide the end time, and steps of which the last one is cut to a third.
    const double end = 0.1e-3;
    std::vector<double> errors;
    for (const int steps : {128, 256, 512, 1024})
      errors.push_back(smooth_error(end / (clipped ? steps - 0.67 : steps)));
    const double order = std::log(errors.front() / errors.back()) / std::log(8.0);
    MESSAGE("smooth mode, last step " << std::string(clipped ? "cut to a third" : "a whole one") << ": energy error "
                                      << errors.front() << " with 128 steps, " << errors.back() << " with 1024: order "
                                      << order << " (1.8 or more)");
    CHECK(order >= 1.8);
  }
}

TEST_CASE("conservation: the energy error of an impact under smaller steps") {
  for (const bool plastic : {false, true}) {
    std::vector<double> errors;
    for (const double step : {6e-7, 3e-7, 1.5e-7}) {
      Case c = impact_case({"", plastic, 0.35, true});
      c.run.end_time = 1e-3;
      c.run.time_step = step;
      Run run(c);
      run.run();
      errors.push_back(run.state.ledger.energy_error());
      CHECK(run.state.clock.shortened == 0);
    }
    MESSAGE(std::string(plastic ? "plastic" : "elastic")
            << " impact: energy error " << errors[0] << ", " << errors[1] << ", " << errors[2]
            << " with steps of 0.6, 0.3 and 0.15 us: orders " << std::log2(errors[0] / errors[1]) << " and "
            << std::log2(errors[1] / errors[2]));
    // Touch, release, change of face and onset of sliding have kinks: between 1 and 2.
    CHECK(std::log2(errors.front() / errors.back()) / 2 >= 0.85);
  }
}

TEST_CASE("conservation: 100 000 steps of bouncing") {
  Run run(load("bouncing.toml"));
  int landings = 0;
  bool touched = false;
  for (int n = 0; n < 100000; ++n) {
    run.step();
    const bool touches = run.state.obstacles[0].touching > 0;
    if (touches && !touched) ++landings;
    touched = touches;
  }
  const Ledger& ledger = run.state.ledger;
  MESSAGE(landings << " landings in " << run.time() << " s: identity error " << ledger.identity_error()
                   << " (bound 1e-11), momentum gap " << ledger.momentum_gap / ledger.momentum_scale
                   << ", energy error " << ledger.energy_error());
  CHECK(landings > 5);
  // Compensated sums: what is left is the rounding of each step's terms, 1e-16 of the energy, as a random walk 3e-14.
  CHECK(ledger.identity_error() <= 1e-11);
  CHECK(ledger.momentum_gap <= 1e-11 * ledger.momentum_scale);
}

TEST_CASE("conservation: a planted error shows in the books") {
  // In mid-flight one node gets a millionth more velocity than its forces give it.
  Case c = impact_case({"", true, 0.35, true});
  c.run.end_time = 0.5e-3;
  Run honest(c);
  while (honest.time() < 0.25e-3) honest.step();
  const double honest_identity = honest.state.ledger.identity_gap;
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
  MESSAGE("kick of " << energy << " J: identity gap " << wrong.identity_gap << " J, without it " << right.identity_gap
                     << " J (at the kick " << honest_identity << "); of " << momentum << " N s: momentum gap "
                     << wrong.momentum_gap << ", without it " << right.momentum_gap << " N s");
  CHECK(wrong.identity_gap == doctest::Approx(std::fabs(energy)).epsilon(1e-2));
  CHECK(wrong.momentum_gap == doctest::Approx(momentum).epsilon(1e-2));
  CHECK(wrong.identity_gap > 100 * right.identity_gap);
  CHECK(wrong.momentum_gap > 100 * right.momentum_gap);
}

}  // namespace udar::verification

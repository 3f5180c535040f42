#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "problem.hpp"

namespace udar::verification {
namespace {

constexpr double g = 9.81;  // m/s2
constexpr double degree = std::numbers::pi / 180;
constexpr double height = 0.02;  // m
constexpr double cell = 0.01;    // m
constexpr double density = 7850;

struct Slope {
  double angle = 30 * degree;
  double friction = 0.2;
  double young = 1e6;         // Pa
  double end_time = 1;        // s
  double start_speed = 0;     // m/s, down the slope
  bool turn_gravity = false;  // a level plane and gravity that leans instead

  [[nodiscard]] Elasticity elasticity() const { return elasticity_of(young, 0.3); }
  [[nodiscard]] double shear_speed() const { return std::sqrt(elasticity().shear_modulus / density); }
  /// Penetration at which the springs carry the weight, m.
  [[nodiscard]] double rest_depth() const {
    return density * g * std::cos(angle) * height * cell / elasticity().wave_modulus();
  }
  [[nodiscard]] double acceleration() const { return g * (std::sin(angle) - friction * std::cos(angle)); }
  [[nodiscard]] double slope_turn() const { return turn_gravity ? 0 : -angle; }
  [[nodiscard]] Vec2 down() const { return {std::cos(slope_turn()), std::sin(slope_turn())}; }

  [[nodiscard]] Case to_case() const {
    Case c = load("incline.toml");
    c.run.end_time = end_time;
    c.run.damping.rate *= std::sqrt(young / 1e6);  // the same part of the block's own frequencies
    std::get<Elastic>(c.materials[0].law).young_modulus = young;
    const Vec2 normal = perpendicular(down());
    std::get<HalfPlane>(c.obstacles[0].shape).normal = normal;
    c.obstacles[0].friction = friction;
    auto& mesh = std::get<RectangleMesh>(c.bodies[0].mesh);
    mesh.turn = slope_turn();
    mesh.at = -rest_depth() * normal;
    c.bodies[0].velocity = start_speed * down();
    if (turn_gravity) c.run.gravity = g * Vec2{std::sin(angle), -std::cos(angle)};
    return c;
  }
};

/// Way of the centre of mass down the slope, m.
double way(const Run& run, Vec2 down) {
  double sum = 0;
  for (Index i = 0; i < run.model.node_count; ++i) sum += run.model.mass[i] * dot(down, run.displacement(i));
  return sum / run.model.bodies[0].mass;
}

double speed(const Run& run, Vec2 down) {
  double sum = 0;
  for (Index i = 0; i < run.model.node_count; ++i) {
    sum += run.model.mass[i] * dot(down, udar::velocity(run.state, i));
  }
  return sum / run.model.bodies[0].mass;
}

struct Slide {
  double way = 0;                   // m
  double acceleration = 0;          // m/s2, over the second half
  double friction_over_normal = 0;  // impulses over the second half
  double friction_work_error = 0;   // of the heat against force times way of the second half
  std::uint64_t steps = 0;
  double energy_error = 0;
};

Slide slide(const Slope& slope) {
  Run run(slope.to_case());
  const Vec2 down = slope.down();
  double half_time = 0, half_speed = 0, half_way = 0, half_heat = 0;
  Vec2 half_impulse, half_normal;
  while (!run.done()) {
    run.step();
    if (half_time == 0 && run.time() >= 0.5 * slope.end_time) {
      half_time = run.time();
      half_speed = speed(run, down);
      half_way = way(run, down);
      half_heat = run.state.ledger.friction_work.value();
      half_impulse = run.state.obstacles[0].total.impulse();
      half_normal = run.state.obstacles[0].normal.impulse();
    }
  }
  const Vec2 impulse = run.state.obstacles[0].total.impulse() - half_impulse;
  const Vec2 normal = run.state.obstacles[0].normal.impulse() - half_normal;
  const double heat =
      slope.friction * run.model.bodies[0].mass * g * std::cos(slope.angle) * (way(run, down) - half_way);
  return {.way = way(run, down),
          .acceleration = (speed(run, down) - half_speed) / (run.time() - half_time),
          .friction_over_normal = -dot(impulse, down) / dot(normal, perpendicular(down)),
          .friction_work_error = (run.state.ledger.friction_work.value() - half_heat) / heat - 1,
          .steps = run.state.clock.step,
          .energy_error = run.state.ledger.energy_error()};
}

/// The block is released without friction in its springs. Its lower face sticks while the rest falls freely behind a
/// shear wave: the shear stress rho c_S g sin(a) t reaches Coulomb's limit mu rho g cos(a) H at mu cot(a) H / c_S; the
/// springs, in series, add their rho c_S b / (lambda + 2 G). At most all friction is missing until then, and the speed
/// gained is kept to the end.
double start_allowance(const Slope& s) {
  const double spring_time = density * s.shear_speed() * cell / s.elasticity().wave_modulus();
  const double build_up = s.friction / std::tan(s.angle) * height / s.shear_speed() + 2 * spring_time;
  return s.friction * g * std::cos(s.angle) * build_up * s.end_time;
}

void check_slide(const Slope& slope) {
  const Slide s = slide(slope);
  const double exact = 0.5 * slope.acceleration() * slope.end_time * slope.end_time;
  MESSAGE("slope " << slope.angle / degree << " deg, mu " << slope.friction << ", E " << slope.young / 1e6
                   << " MPa: " << s.way << " / " << exact << " m, ahead by at most " << start_allowance(slope)
                   << " m; acceleration " << s.acceleration << " / " << slope.acceleration()
                   << " m/s2; friction / normal impulse " << s.friction_over_normal << "; heat off by "
                   << s.friction_work_error << "; energy error " << s.energy_error << "; " << s.steps << " steps");
  CHECK(s.way >= exact);
  CHECK(s.way <= exact + start_allowance(slope));
  // Once it slides quietly everything is constant, and central difference carries a constant acceleration exactly. What
  // is left of the ringing after 0.5 s of damping is exp(-0.5 x 300 x 0.2) = 1e-13 of g for modes with a fifth or more
  // of relative motion.
  CHECK(s.acceleration == doctest::Approx(slope.acceleration()).epsilon(1e-6));
  CHECK(s.friction_over_normal == doctest::Approx(slope.friction).epsilon(1e-9));
  CHECK(std::fabs(s.friction_work_error) <= 1e-6);
  CHECK(s.steps < 1000000);
}

}  // namespace

TEST_CASE("incline: sliding at 30 and 20 degrees") {
  check_slide({});
  check_slide({.angle = 20 * degree, .friction = 0.3});
}

TEST_CASE("incline: the start costs less in a stiffer block") {
  // The allowance falls as the speed of shear waves rises: order 1/2 in Young's modulus.
  const auto ahead = [](double young) {
    const Slope s{.young = young};
    return slide(s).way - 0.5 * s.acceleration();
  };
  const double soft = ahead(1e6);
  const double stiff = ahead(16e6);
  const double order = std::log(soft / stiff) / std::log(16.0);
  MESSAGE("ahead of the rigid block by " << soft << " m at 1 MPa and " << stiff << " m at 16 MPa: order " << order
                                         << " (1/2 expected)");
  CHECK(order == doctest::Approx(0.5).epsilon(0.1));
}

TEST_CASE("incline: leaning plane or leaning gravity") {
  Slope s;
  const double leaning_plane = slide(s).way;
  s.turn_gravity = true;
  const double leaning_gravity = slide(s).way;
  MESSAGE("way " << leaning_plane << " and " << leaning_gravity << " m, apart by " << leaning_plane - leaning_gravity);
  // Rounding of some thousand steps, 1e-16 of 1.6 m each, without anything that amplifies it.
  CHECK(leaning_plane == doctest::Approx(leaning_gravity).epsilon(1e-11));
}

TEST_CASE("incline: sticking") {
  const Slope slope{.friction = 0.6};
  Run run(slope.to_case());
  const Vec2 down = slope.down();
  double half_way = -1, lowest = 1, highest = -1;
  std::uint64_t late_slides = 0;
  while (!run.done()) {
    run.step();
    if (run.time() < 0.5) continue;
    const double now = way(run, down);
    if (half_way < 0) half_way = now;
    lowest = std::min(lowest, now);
    highest = std::max(highest, now);
    for (const SpringState& s : run.state.contacts) late_slides += s.slides;
  }
  const double weight = run.model.bodies[0].mass * g;
  const ForceBook& book = run.state.obstacles[0].total;
  MESSAGE("moved " << half_way << " m in the first 0.5 s, then by " << highest - lowest << " m; " << late_slides
                   << " node-steps of sliding after 0.5 s; force of the slope along it "
                   << -dot(book.force, down) / weight << " / " << std::sin(slope.angle) << " of the weight");
  // tan(30 deg) = 0.577 < 0.6: every node sticks in the end. Where, is settled while the unstressed start rings and
  // nodes hop: no further than free fall goes until that has died away as exp(-5), at half the rate of damping.
  CHECK(late_slides == 0);
  CHECK(half_way > 0);
  const double ringing = 10 / run.model.run.damping.rate;
  CHECK(half_way < 0.5 * g * std::sin(slope.angle) * ringing * ringing);
  CHECK(highest - lowest <= 1e-9 * height);
  CHECK(-dot(book.force, down) == doctest::Approx(weight * std::sin(slope.angle)).epsilon(1e-6));
}

TEST_CASE("incline: a thrown block comes to rest") {
  const double v0 = 10;
  const double mu = 0.3;
  std::vector<double> errors;
  for (const double safety : {0.9, 0.45}) {
    const Slope slope{.angle = 0, .friction = mu, .end_time = 4, .start_speed = v0};
    Case c = slope.to_case();
    c.run.step_safety = safety;
    Run run(c);
    const Vec2 down = slope.down();
    double stop_time = 0, last_speed = v0, last_time = 0, at_stop = 0;
    double lowest = 1e9, highest = 0;
    while (!run.done()) {
      run.step();
      const double now = speed(run, down);
      if (stop_time == 0 && now <= 0) {
        stop_time = last_time + (run.time() - last_time) * last_speed / (last_speed - now);
        at_stop = way(run, down);
      }
      last_speed = now;
      last_time = run.time();
      if (run.time() < 3.9) continue;
      lowest = std::min(lowest, way(run, down));
      highest = std::max(highest, way(run, down));
    }
    const double h = run.state.clock.largest_step;
    const double exact_time = v0 / (mu * g);
    const double exact_way = 0.5 * v0 * exact_time;
    MESSAGE("step " << h << " s: stops after " << stop_time << " / " << exact_time << " s and " << at_stop << " / "
                    << exact_way << " m, at rest within " << highest - lowest << " m; heat "
                    << run.state.ledger.friction_work.value() << " of " << run.state.ledger.start_kinetic << " J");
    errors.push_back(at_stop - exact_way);
    // Friction is missing in the half step before the springs first stretch: mu g h / 2 in speed, that is h / 2 in
    // time and v0 h / 2 in way; the elastic slip of block and springs, some 1e-5 m, comes on top.
    const double slip = 10 * mu * slope.rest_depth() * (1 + height / cell);
    CHECK(stop_time == doctest::Approx(exact_time).epsilon(0.6 * h / exact_time + 1e-4));
    CHECK(std::fabs(at_stop - exact_way) <= 0.6 * v0 * h + slip);
    CHECK(highest - lowest <= slip);
    CHECK(run.state.ledger.friction_work.value() ==
          doctest::Approx(run.state.ledger.start_kinetic).epsilon(2 * h / exact_time + 1e-5));
  }
  const double order = std::log2(errors[0] / errors[1]);
  MESSAGE("order of the way in the step " << order << " (1 expected: the missing half step)");
  CHECK(order >= 0.85);
}

}  // namespace udar::verification

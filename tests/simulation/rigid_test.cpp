// Rigid bodies: free flight, what contact does to them, and their books.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/simulation/example.hpp"
#include "udar/case/build_model.hpp"
#include "udar/output/observer.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

const Vec2 size{0.04, 0.02};

/// A rigid block of steel, alone.
Case rigid_block(double element_size = 0.01) {
  return {.run = {.end_time = 1e-3, .time_step = 1e-6},
          .materials = {{.name = "steel", .density = 7850, .law = Elastic{196e9, 0.25}}},
          .bodies = {{.name = "block",
                      .material = "steel",
                      .thickness = 0.01,
                      .rigid = true,
                      .mesh = RectangleMesh{.size = size, .at = {-0.02, 0}, .element_size = element_size}}}};
}

/// A rigid hammer strikes a deformable anvil off its middle, with friction; nothing holds either.
Case hammer_on_anvil(const Law& law) {
  Case input = rigid_block();
  input.bodies[0].name = "hammer";
  input.run = {.end_time = 300e-6};
  input.contact.friction = 0.3;
  input.materials.push_back({.name = "soft", .density = 2700, .law = law});
  input.bodies[0].velocity = {12, -30};
  input.bodies[0].spin = -100;
  input.bodies.push_back({.name = "anvil",
                          .material = "soft",
                          .thickness = 0.01,
                          .mesh = RectangleMesh{.size = {0.1, 0.03}, .at = {-0.06, -0.031}, .element_size = 0.004}});
  return input;
}

void run(const Model& model, State& state, Workspace& work) {
  while (!finished(model, state)) step(model, state, work);
}

}  // namespace

TEST_CASE("mass and inertia of a rigid body are those of its area, whatever its mesh") {
  for (const double element_size : {0.02, 0.01, 0.0025}) {
    CAPTURE(element_size);
    const Model model = build_model(rigid_block(element_size));
    REQUIRE(model.rigid_bodies.size() == 1);
    const RigidBody& rigid = model.rigid_bodies[0];
    const double mass = 7850 * size.x * size.y * 0.01;
    CHECK(rigid.mass == doctest::Approx(mass).epsilon(1e-13));
    CHECK(rigid.inertia == doctest::Approx(mass / 12 * dot(size, size)).epsilon(1e-13));
    CHECK(length(rigid.centre - Vec2{0, 0.01}) < 1e-16);
    CHECK(model.element_blocks.empty());
  }
}

TEST_CASE("a rigid body in flight keeps its shape and its spin through many turns, and its path is a parabola") {
  for (const Integrator integrator : {Integrator::central_difference, Integrator::adams}) {
    Case input = rigid_block();
    input.run.integrator = integrator;
    input.run.gravity = {0, -9.81};
    input.bodies[0].velocity = {3, 40};
    input.bodies[0].spin = 2e5;  // 0.1 rad a step, 32 turns
    input.run.time_step = 5e-7;
    const Model model = build_model(input);
    Workspace work(model, 1);
    State state = start(model, work);
    const double spin = state.rigid[0].velocity.angular * model.rigid_bodies[0].inertia;
    run(model, state, work);
    const double t = state.clock.time.value();
    const RigidMotion& motion = state.rigid[0];
    const Vec2 expected{3 * t, 0.01 + 40 * t - 0.5 * 9.81 * t * t};
    // Adams and central difference both integrate a constant acceleration exactly.
    CHECK(length(motion.place - expected) < 1e-13);
    CHECK(motion.angle == doctest::Approx(2e5 * t).epsilon(1e-12));
    for (Index i = 0; i < model.node_count; ++i) {
      for (Index j = 0; j < i; ++j) {
        const double now = length(place(state, i) - place(state, j));
        CHECK(std::fabs(now - length(model.rest[i] - model.rest[j])) < 1e-15);
      }
    }
    const BodySums& sums = state.body_sums[0];
    const Vec2 centre = (1 / model.bodies[0].mass) * sums.position;
    CHECK(sums.spin - cross(centre, sums.momentum) == doctest::Approx(spin).epsilon(1e-12));
    CHECK(state.ledger.energy_error() < 1e-12);
    if (integrator == Integrator::central_difference) CHECK(state.ledger.identity_error() < 1e-12);
  }
}

TEST_CASE("a rigid block that falls flat on springs is an oscillator: half a period of touch, then as fast back") {
  Case input = rigid_block(0.005);
  constexpr double stiffness = 1e8;
  input.run = {.end_time = 1.5e-3, .time_step = 5e-7};
  input.obstacles = {{.name = "stop", .shape = HalfPlane{}, .stiffness = stiffness}};
  input.bodies[0].velocity = {0, -10};
  const Model model = build_model(input);
  Workspace work(model, 1);
  State state = start(model, work);
  double touching = 0;
  double deepest = 0;
  while (!finished(model, state)) {
    step(model, state, work);
    if (state.obstacles[0].touching > 0) touching += state.clock.last_step;
    for (const SpringState& s : state.contacts) deepest = std::max(deepest, s.penetration);
  }
  const double omega = std::sqrt(9 * stiffness / model.bodies[0].mass);
  const double h = *input.run.time_step;
  // The frequency of the scheme is higher by (omega h)^2 / 24; where in a step the touch ends is not known.
  CHECK(std::fabs(touching - std::numbers::pi / omega) < 1.5 * h);
  CHECK(deepest == doctest::Approx(10 / omega).epsilon(omega * omega * h * h));
  // Springs switch on and off within a step, which costs up to k h^2 / (4 m) of the energy.
  CHECK(state.body_momentum[0].y / model.bodies[0].mass == doctest::Approx(10).epsilon(0.25 * omega * omega * h * h));
  CHECK(std::fabs(state.rigid[0].velocity.angular) < 1e-9);
  CHECK(state.ledger.energy_error() < 0.25 * omega * omega * h * h);
}

TEST_CASE("a rigid body and one that deforms: momentum and spin stay, the books close") {
  const Law laws[] = {Elastic{.young_modulus = 70e9, .poisson_ratio = 0.3},
                      Tresca{.young_modulus = 70e9, .poisson_ratio = 0.3, .yield_stress = 100e6}};
  for (const Law& law : laws) {
    const Model model = build_model(hammer_on_anvil(law));
    Workspace work(model, 1);
    State state = start(model, work);
    const Vec2 momentum = state.ledger.start_momentum;
    const double spin = state.body_spin[0] + state.body_spin[1];
    double momentum_drift = 0;
    double spin_drift = 0;
    while (!finished(model, state)) {
      step(model, state, work);
      momentum_drift = std::max(momentum_drift, length(state.body_momentum[0] + state.body_momentum[1] - momentum));
      spin_drift = std::max(spin_drift, std::fabs(state.body_spin[0] + state.body_spin[1] - spin));
    }
    CHECK(momentum_drift < 1e-12 * length(momentum));
    CHECK(spin_drift < 1e-12 * length(momentum) * 0.05);
    CHECK(state.ledger.friction_work.value() > 0);
    CHECK(state.ledger.identity_error() < 1e-11);
    CHECK(state.ledger.energy_error() < 1e-3);
    CHECK(state.body_momentum[1].y < -0.1 * length(momentum));
    CHECK(state.touches.empty());
  }
}

TEST_CASE("histories of a rigid body have its angle, those of a pair the push of the one on the other") {
  const Model model = build_model(hammer_on_anvil(Elastic{.young_modulus = 70e9, .poisson_ratio = 0.3}));
  Workspace work(model, 1);
  State state = start(model, work);
  run(model, state, work);
  const std::vector<Observer> all = make_observers(model);
  const auto last = [&](const std::string& name, const std::string& column) {
    const auto o = std::find_if(all.begin(), all.end(), [&](const Observer& at) { return at.name == name; });
    REQUIRE(o != all.end());
    std::vector<double> values(o->columns.size());
    o->measure(state, values);
    const auto c =
        std::find_if(o->columns.begin(), o->columns.end(), [&](const Column& at) { return at.name == column; });
    REQUIRE(c != o->columns.end());
    return values[static_cast<std::size_t>(c - o->columns.begin())];
  };
  CHECK(last("hammer", "spin") == doctest::Approx(model.rigid_bodies[0].inertia * last("hammer", "angular_velocity")));
  CHECK(last("hammer", "angle") == state.rigid[0].angle);
  CHECK(last("hammer", "angle") != 0);
  const double gained = last("hammer", "momentum_y") - model.bodies[0].mass * -30;
  CHECK(last("hammer-anvil", "impulse_y") == doctest::Approx(gained).epsilon(1e-12));
  CHECK(last("hammer-anvil", "touching_nodes") == 0);
}

TEST_CASE("two rigid bodies rebound from each other, and the step follows from their springs") {
  // Half of (omega h)^2 / 4 of the energy at most, with omega h = 0.09 for the bound on omega.
  Case input = rigid_block();
  input.run = {.end_time = 2e-4};
  input.bodies.push_back(input.bodies[0]);
  input.bodies[1].name = "other";
  input.bodies[1].mesh = RectangleMesh{.size = {0.02, 0.02}, .at = {-0.01, 0.0201}, .element_size = 0.01};
  input.bodies[1].velocity = {0, -20};
  const Model model = build_model(input);
  Workspace work(model, 1);
  State state = start(model, work);
  CHECK(std::isfinite(state.clock.limit.size));
  run(model, state, work);
  // Two masses M and M / 2, no losses: the second one comes back with -v (M1 - M2) / (M1 + M2).
  CHECK(state.body_momentum[1].y / model.bodies[1].mass == doctest::Approx(20 / 3.0).epsilon(0.005));
  CHECK(state.body_momentum[0].y / model.bodies[0].mass == doctest::Approx(-2 * 20 / 3.0).epsilon(0.005));
  CHECK(state.ledger.energy_error() < 5e-3);
}

}  // namespace udar

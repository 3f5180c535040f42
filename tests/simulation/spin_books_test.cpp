// The books of the spin momentum: what changes it is the moments of the forces from outside, and nothing else.

#include <doctest/doctest.h>

#include <cmath>

#include "tests/simulation/example.hpp"
#include "tests/simulation/golden_cases.hpp"
#include "udar/output/summarise.hpp"
#include "udar/simulation/simulation.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

struct Run {
  Model model;
  Workspace work{model, 1};
  State state;

  explicit Run(const Case& input) : model(build_model(input)), state(start(model, work)) {}
  void finish() {
    while (!finished(model, state)) udar::step(model, state, work);
  }
  [[nodiscard]] const Ledger& ledger() const { return state.ledger; }
  [[nodiscard]] double moment(SpinKind kind) const { return ledger().spin_book(kind).impulse.value(); }
};

Case lone_block(bool rigid) {
  Case input{
      .run = {.end_time = 200e-6},
      .materials = {aluminium},
      .bodies = {golden::block("block", "aluminium",
                               RectangleMesh{.size = {0.04, 0.02}, .at = {0.3, 0.1}, .element_size = 0.005}, {4, -7})}};
  input.bodies[0].rigid = rigid;
  return input;
}

}  // namespace

TEST_CASE("spin books: gravity turns a thrown body about the origin as the parabola of its centre says") {
  for (const bool rigid : {false, true}) {
    CAPTURE(rigid);
    Case input = lone_block(rigid);
    input.run.gravity = {1500, -9.81};
    input.bodies[0].spin = 300;
    Run run(input);
    run.finish();
    const double mass = run.model.bodies[0].mass;
    const Vec2 centre{0.32, 0.11};
    const Vec2 g = input.run.gravity;
    // L(t) = m c(t) x v(t) + L_own with c = c0 + v0 t + g t^2 / 2: the moment c x m g, integrated. The books hold the
    // momentum in the middle of the coming step and places at its begin; that differs by (h / 2)^2 at most.
    const Clock& clock = run.state.clock;
    const double t = clock.time.value() + 0.5 * clock.next_step;
    const double expected = mass * (cross(centre, g) * t + 0.5 * cross(input.bodies[0].velocity, g) * t * t);
    CHECK(run.moment(SpinKind::gravity) == doctest::Approx(expected).epsilon(1e-4));
    CHECK(run.ledger().spin - run.ledger().start_spin == doctest::Approx(expected).epsilon(1e-4));
    CHECK(run.ledger().spin_gap < 1e-12 * run.ledger().spin_scale);
    for (const SpinKind kind : {SpinKind::obstacle, SpinKind::load, SpinKind::support, SpinKind::damping}) {
      CHECK(run.moment(kind) == 0);
    }
  }
}

TEST_CASE("spin books: the moment of a force at a corner of a body at rest, and of the hand that holds another") {
  Case input = lone_block(false);
  input.bodies[0].velocity = {};
  input.loads = {{.name = "push", .where = {.body = "block", .point = Vec2{0.34, 0.12}}, .value = {30, 50}}};
  Run run(input);
  run.finish();
  const double t = run.state.clock.time.value() + 0.5 * run.state.clock.next_step;
  // The corner moves by some micrometres of the 0.3 m to the origin.
  CHECK(run.moment(SpinKind::load) == doctest::Approx(cross({0.34, 0.12}, {30, 50}) * t).epsilon(1e-4));
  CHECK(run.ledger().spin_gap < 1e-13 * std::fabs(run.moment(SpinKind::load)));

  // Held on its left side, what the force brings in the hand takes out again, once waves have run to and fro.
  input.supports = {{.name = "hand",
                     .nodes = {.body = "block", .side = "left"},
                     .move_x = TimeTable::constant(0),
                     .move_y = TimeTable::constant(0)}};
  input.run.damping.rate = 1e5;
  input.run.end_time = 2e-3;
  Run held(input);
  held.finish();
  const double load = held.moment(SpinKind::load);
  CHECK(held.moment(SpinKind::support) + held.moment(SpinKind::damping) == doctest::Approx(-load).epsilon(1e-3));
  CHECK(held.moment(SpinKind::damping) != 0);
  CHECK(held.ledger().spin_gap < 1e-13 * load);
}

TEST_CASE("spin books: mass damping brakes the turn of a deforming and a rigid body as e^(-c t)") {
  for (const bool rigid : {false, true}) {
    CAPTURE(rigid);
    Case input = lone_block(rigid);
    input.bodies[0].velocity = {};
    input.bodies[0].spin = 100;
    input.run.damping.rate = 2000;
    Run run(input);
    run.finish();
    const double t = run.state.clock.time.value() + 0.5 * run.state.clock.next_step;
    // The damping force is half a step late: c h / 2 of it.
    CHECK(run.ledger().spin / run.ledger().start_spin == doctest::Approx(std::exp(-2000 * t)).epsilon(1e-3));
    CHECK(run.moment(SpinKind::damping) == doctest::Approx(run.ledger().spin - run.ledger().start_spin).epsilon(1e-12));
  }
}

TEST_CASE("spin books: a velocity that no force gave opens them, and the verdict says so") {
  Case input = falling_block();
  Run run(input);
  while (run.state.clock.time.value() < 30e-6) step(run.model, run.state, run.work);
  CHECK(run.ledger().spin_gap < 1e-12 * run.ledger().spin_scale);
  // Two nodes get opposite pushes: momentum stays, spin does not.
  const Index one = 0;
  const Index two = run.model.node_count - 1;
  const double push = 1e-6 * run.model.mass[one];
  run.state.nodes[one].vy += push * run.model.inverse_mass[one];
  run.state.nodes[two].vy -= push * run.model.inverse_mass[two];
  const double arm = run.state.nodes[one].x - run.state.nodes[two].x;
  run.finish();
  CHECK(run.ledger().spin_gap == doctest::Approx(std::fabs(push * arm)).epsilon(1e-3));
  CHECK(run.ledger().momentum_gap < 1e-13 * run.ledger().momentum_scale);
  run.state.ledger.identity_gap = 0;
  run.state.ledger.energy_gap = 0;
  run.state.ledger.spin_gap *= 100;
  Summary told = summarise(run.model, run.state);
  judge(run.model, run.state, told);
  CHECK(told.verdict == "bad");
  REQUIRE(told.reasons.size() == 1);
  CHECK(told.reasons[0].find("spin momentum") != std::string::npos);
}

TEST_CASE("spin books: with an Adams rule the gap falls with the square of the step, and is not judged") {
  std::vector<double> gaps;
  for (const double step : {4e-8, 2e-8, 1e-8}) {
    Case input = lone_block(false);
    input.run.integrator = Integrator::adams;
    input.run.time_step = step;
    input.run.end_time = 40e-6;
    input.bodies[0].spin = 2000;
    input.loads = {{.name = "push",
                    .where = {.body = "block", .point = Vec2{0.34, 0.12}},
                    .value = {3e3, 5e3},
                    .factor = {.times = {0, 2e-5}, .values = {0, 1}, .shape = TimeTable::Shape::smooth}}};
    Run run(input);
    run.finish();
    gaps.push_back(run.ledger().spin_gap);
    Summary told = summarise(run.model, run.state);
    CHECK(told.spin_error > 0);
    judge(run.model, run.state, told);
    CHECK(told.verdict == "good");
  }
  CHECK(gaps[0] / gaps[1] > 3.5);
  CHECK(gaps[1] / gaps[2] > 3.5);
}

}  // namespace udar

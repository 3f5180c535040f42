// Corners of obstacles that dig into boundaries between nodes.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/simulation/example.hpp"
#include "udar/base/error.hpp"
#include "udar/case/build_model.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

/// An elastic block of cells of 1 cm over an obstacle with corners.
Case block_over(const Shape& shape, double friction, Vec2 velocity) {
  return {.run = {.end_time = 200e-6},
          .materials = {{.name = "steel", .density = 7850, .law = Elastic{196e9, 0.25}}},
          .bodies = {{.name = "block",
                      .material = "steel",
                      .thickness = 0.01,
                      .velocity = velocity,
                      .mesh = RectangleMesh{.size = {0.06, 0.03}, .at = {-0.03, 0.0001}, .element_size = 0.01}}},
          .obstacles = {{.name = "edge", .shape = shape, .friction = friction}}};
}

const Polygon wedge{.points = {{-0.004, -0.02}, {0.004, -0.02}, {0.001, 0}}};

struct End {
  State state;
  double deepest = 0;  ///< m
  double mass = 0;     ///< kg
};

End run(const Case& input) {
  const Model model = build_model(input);
  Workspace work(model, 1);
  End end{.state = start(model, work), .mass = model.bodies[0].mass};
  while (!finished(model, end.state)) {
    step(model, end.state, work);
    for (const CornerTouch& t : end.state.corner_touches) end.deepest = std::max(end.deepest, t.springs.penetration);
  }
  return end;
}

}  // namespace

TEST_CASE("a wedge between two nodes throws a body back, and only its corner does") {
  Case input = block_over(wedge, 0.3, {0, -5});
  const End with = run(input);
  CHECK(with.deepest > 0);
  CHECK(with.deepest < 0.05 * 0.01);
  CHECK(with.state.corner_touches.empty());
  // It spins away about the corner and rings, so that not all of the speed comes back.
  CHECK(with.state.body_momentum[0].y / with.mass > 1);
  CHECK(with.state.ledger.energy_error() < 1e-3);
  CHECK(with.state.ledger.identity_error() < 1e-12);
  const Vec2 impulse = with.state.obstacles[0].total.impulse();
  CHECK(length(with.state.ledger.momentum - with.state.ledger.start_momentum - impulse) < 1e-12 * 5 * with.mass);

  input.obstacles[0].corners = false;
  const End without = run(input);
  CHECK(without.state.body_momentum[0].y / without.mass == doctest::Approx(-5).epsilon(1e-12));
}

TEST_CASE("a corner that slides along a segment and rubs: energy closes with the square of the step") {
  const auto error = [](double step) {
    Case input = block_over(Polygon{.points = {{0.002, -0.02}, {0.01, -0.02}, {0.008, 0}}}, 0.2, {40, -5});
    input.run.time_step = step;
    input.run.end_time = 150e-6;  // from 0.8 to 0.2 of a segment
    const End end = run(input);
    CHECK(end.state.ledger.friction_work.value() > 0);
    CHECK(end.deepest > 0);
    return end.state.ledger.energy_error();
  };
  // Sixteen times less for a quarter of the step; where in a step the touch begins makes some difference.
  CHECK(error(1e-7) < error(4e-7) / 6);
}

TEST_CASE("a corner that slides on over nodes: each passes its tip within a step, which costs little energy") {
  Case input = block_over(wedge, 0.2, {40, -5});
  input.run.end_time = 500e-6;  // two cells of way
  const End end = run(input);
  CHECK(end.state.ledger.energy_error() < 1e-3);
  CHECK(end.state.ledger.identity_error() < 1e-12);
}

TEST_CASE("a moving corner into a body at rest is a body thrown onto the corner at rest") {
  Case one = block_over(wedge, 0.2, {3, -5});
  one.run.time_step = 2e-7;
  Case two = one;
  two.bodies[0].velocity = {};
  two.obstacles[0].velocity = {-3, 5};
  const End a = run(one);
  const End b = run(two);
  const Vec2 velocity_a = (1 / a.mass) * a.state.body_momentum[0];
  const Vec2 velocity_b = (1 / b.mass) * b.state.body_momentum[0];
  CHECK(length(velocity_a - velocity_b - Vec2{3, -5}) < 1e-9 * length(velocity_a));
  CHECK(length(velocity_a - Vec2{3, -5}) > 1);
}

TEST_CASE("where a boundary lies flat on an obstacle up to its corners, corners add nothing") {
  Case input = block_over(Rectangle{.at = {-0.0137, -0.05}, .size = {0.0274, 0.05}}, 0.3, {0, -5});
  input.bodies[0].rigid = true;
  input.run.time_step = 2e-7;
  const End with = run(input);
  input.obstacles[0].corners = false;
  const End without = run(input);
  const Vec2 v = (1 / with.mass) * with.state.body_momentum[0];
  CHECK(v.y == doctest::Approx(5).epsilon(0.01));
  CHECK(length(v - (1 / without.mass) * without.state.body_momentum[0]) < 1e-9);
}

TEST_CASE("what lies left and right may be exchanged") {
  Case one = block_over(Polygon{.points = {{-0.004, -0.02}, {0.004, -0.02}, {0.0023, 0}}}, 0.3, {4, -8});
  one.run.time_step = 2e-7;
  one.run.end_time = 100e-6;
  std::get<RectangleMesh>(one.bodies[0].mesh).diagonals = RectangleMesh::Diagonals::crossed;
  Case two = one;
  two.obstacles[0].shape = Polygon{.points = {{-0.004, -0.02}, {0.004, -0.02}, {-0.0023, 0}}};
  two.bodies[0].velocity = {-4, -8};
  const End a = run(one);
  const End b = run(two);
  CHECK(a.state.body_momentum[0].x == doctest::Approx(-b.state.body_momentum[0].x).epsilon(1e-9));
  CHECK(a.state.body_momentum[0].y == doctest::Approx(b.state.body_momentum[0].y).epsilon(1e-9));
  CHECK(a.state.body_momentum[0].y > -8 * a.mass);
}

TEST_CASE("an obstacle whose corner starts deep in a body is refused") {
  Case input = block_over(Polygon{.points = {{-0.004, -0.02}, {0.004, -0.02}, {0.0023, 0.01}}}, 0, {});
  const Model model = build_model(input);
  Workspace work(model, 1);
  CHECK_THROWS_WITH_AS(
      start(model, work),
      doctest::Contains("obstacle `edge` starts inside body `block`: its corner at (0.0023, 0.01) m is 0.0099 m deep"),
      UserError);
}

}  // namespace udar

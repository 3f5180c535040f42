// Contact of bodies with each other: what must hold exactly, or to rounding.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/simulation/example.hpp"
#include "udar/base/error.hpp"
#include "udar/case/build_model.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

const Elastic elastic{.young_modulus = 196e9, .poisson_ratio = 0.25};
const Tresca plastic{.young_modulus = 196e9, .poisson_ratio = 0.25, .yield_stress = 235e6};

BodyCase block(const char* name, Vec2 at, Vec2 size, double element_size, Vec2 velocity) {
  return {.name = name,
          .material = "steel",
          .thickness = 0.01,
          .velocity = velocity,
          .mesh = RectangleMesh{.size = size, .at = at, .element_size = element_size}};
}

/// Two blocks of different meshes meet at an angle, rub, spin and fly apart.
Case two_blocks(const Law& law, double friction) {
  return {.run = {.end_time = 500e-6},
          .contact = {.friction = friction},
          .materials = {{.name = "steel", .density = 7850, .law = law}},
          .bodies = {block("lower", {-0.02, 0}, {0.04, 0.02}, 0.0025, {0, 20}),
                     block("upper", {0.005, 0.0201}, {0.03, 0.01}, 0.002, {-15, -40})}};
}

}  // namespace

TEST_CASE("two bodies strike, rub and part: momentum and spin stay, the books close") {
  for (const Law& law : {Law(elastic), Law(plastic)}) {
    for (const double friction : {0.0, 0.3}) {
      CAPTURE(friction);
      const Model model = build_model(two_blocks(law, friction));
      Workspace work(model, 1);
      State state = start(model, work);
      const Totals before = totals(model, state);
      std::size_t most = 0;
      double spin_drift = 0;
      double momentum_drift = 0;
      while (!finished(model, state)) {
        step(model, state, work);
        most = std::max(most, state.touches.size());
        const Totals now = totals(model, state);
        spin_drift = std::max(spin_drift, std::fabs(now.spin - before.spin));
        momentum_drift = std::max(momentum_drift, length(now.momentum - before.momentum));
      }
      CHECK(most > 3);
      CHECK(state.touches.empty());
      CHECK(momentum_drift < 1e-12 * before.size);
      CHECK(spin_drift < 1e-12 * before.size * 0.03);
      CHECK(state.ledger.energy_error() < 5e-3);
      CHECK(state.ledger.identity_error() < 1e-11);
      CHECK(state.largest_penetration < 0.05);
      CHECK((state.ledger.friction_work.value() > 0) == (friction > 0));
      CHECK(std::fabs(state.body_momentum[0].y / model.bodies[0].mass - 20) > 10);
    }
  }
}

TEST_CASE("what touches cost in energy falls with the square of the step") {
  const auto error = [](double safety, double friction) {
    Case input = two_blocks(elastic, friction);
    input.run.step_safety = safety;
    input.run.end_time = 100e-6;
    const Model model = build_model(input);
    Workspace work(model, 1);
    State state = start(model, work);
    while (!finished(model, state)) step(model, state, work);
    return state.ledger.energy_error();
  };
  // Four times less for half the step; touches fall here and there within a step, so something less is asked for.
  for (const double friction : {0.0, 0.3}) CHECK(error(0.2, friction) < error(0.4, friction) / 2.5);
}

TEST_CASE("which body is named first changes nothing but rounding") {
  Case one = two_blocks(elastic, 0.3);
  one.run.time_step = 1e-7;
  one.run.end_time = 60e-6;
  Case two = one;
  std::swap(two.bodies[0], two.bodies[1]);
  const Model models[] = {build_model(one), build_model(two)};
  State ends[2];
  for (int k = 0; k < 2; ++k) {
    Workspace work(models[k], 1);
    ends[k] = start(models[k], work);
    while (!finished(models[k], ends[k])) step(models[k], ends[k], work);
  }
  for (const int body : {0, 1}) {
    const Vec2 a = ends[0].body_momentum[static_cast<std::size_t>(body)];
    const Vec2 b = ends[1].body_momentum[static_cast<std::size_t>(1 - body)];
    CHECK(length(a - b) < 1e-9 * length(a));
  }
}

namespace {

/// How far a body that meets its mirror image gets from one that meets a frictionless wall, m.
double apart_from_wall(const Law& law, double end_time) {
  Case wall{.run = {.end_time = end_time, .time_step = 5e-8},
            .materials = {{.name = "steel", .density = 7850, .law = law}},
            .bodies = {block("right", {0, -0.01}, {0.03, 0.02}, 0.0025, {-40, 0})},
            .obstacles = {{.name = "wall", .shape = HalfPlane{.normal = {1, 0}}}}};
  std::get<RectangleMesh>(wall.bodies[0].mesh).diagonals = RectangleMesh::Diagonals::crossed;
  Case pair = wall;
  pair.obstacles.clear();
  pair.bodies.push_back(block("left", {-0.03, -0.01}, {0.03, 0.02}, 0.0025, {40, 0}));
  std::get<RectangleMesh>(pair.bodies[1].mesh).diagonals = RectangleMesh::Diagonals::crossed;
  Model alone = build_model(wall);
  const Model both = build_model(pair);
  // A node is pushed by its own spring and by that of the node opposite, each half as stiff as one to the wall and
  // pressed twice as far.
  for (auto* k : {&alone.obstacles[0].normal_stiffness, &alone.obstacles[0].tangential_stiffness}) {
    for (double& value : *k) value *= 2;
  }
  Workspace one(alone, 1), two(both, 1);
  State a = start(alone, one), b = start(both, two);
  double apart = 0;
  while (!finished(alone, a)) {
    step(alone, a, one);
    step(both, b, two);
    for (Index i = 0; i < alone.node_count; ++i) {
      apart = std::max(apart, std::hypot(a.nodes[i].x - b.nodes[i].x, a.nodes[i].y - b.nodes[i].y));
    }
  }
  CHECK(a.obstacles[0].total.impulse().x > 0);
  return apart;
}

}  // namespace

TEST_CASE("two equal bodies head-on are as one against a frictionless wall") {
  // To rounding as long as the fronts are flat. In their corners springs are as stiff as elsewhere on half the mass:
  // soon a front has a slope of 1e-3 there and pushes the other one aside by as much of the depth, 1e-5 m; a wall does
  // not.
  for (const Law& law : {Law(elastic), Law(plastic)}) {
    CHECK(apart_from_wall(law, 0.2e-6) < 1e-17);
    CHECK(apart_from_wall(law, 2e-6) < 1e-8);
  }
  CHECK(apart_from_wall(elastic, 40e-6) < 1e-7);
  CHECK(apart_from_wall(plastic, 40e-6) < 1e-6);
}

TEST_CASE("any number of threads gives the same bits, also where bodies touch") {
  Case input = two_blocks(plastic, 0.3);
  std::get<RectangleMesh>(input.bodies[0].mesh).element_size = 0.001;
  input.run.end_time = 30e-6;
  const Model model = build_model(input);
  std::uint64_t first = 0;
  for (const int threads : {1, 2, 3, 7}) {
    Workspace work(model, threads);
    State state = start(model, work);
    while (!finished(model, state)) step(model, state, work);
    CHECK(!state.touches.empty());
    if (threads == 1) first = hash_of(state);
    CHECK(hash_of(state) == first);
  }
}

TEST_CASE("books are kept of the bodies that met, in the order of bodies, and hold all that happened to each") {
  for (const Integrator integrator : {Integrator::central_difference, Integrator::adams}) {
    CAPTURE(integrator == Integrator::adams);
    // Six blocks in a row. The last two meet first, then 0 and 1, then 1 and 2; number 3 is left alone.
    Case input = two_blocks(elastic, 0.3);
    input.run.integrator = integrator;
    input.run.stop_at_energy_error = 1;  // flush blocks strike node on node; here the momentum counts
    input.run.end_time = 40e-6;
    input.bodies.clear();
    const double gaps[] = {4e-4, 8e-4, 0.1, 0.1, 1e-4, 0};  // m, to the next one
    const double speeds[] = {20, 0, -20, 5, 40, 0};         // m/s
    double x = 0;
    for (std::size_t b = 0; b < 6; ++b) {
      const double y = b % 2 == 0 ? 0 : 0.001;
      input.bodies.push_back(
          block(("block" + std::to_string(b)).c_str(), {x, y}, {0.005, 0.01}, 0.0025, {speeds[b], 0}));
      x += 0.005 + gaps[b];
    }
    const Model model = build_model(input);
    Workspace work(model, 1);
    State state = start(model, work);
    CHECK(state.pairs.empty());
    std::vector<Vec2> momentum(6);
    for (std::size_t b = 0; b < 6; ++b) momentum[b] = model.bodies[b].mass * input.bodies[b].velocity;
    std::vector<BodyNumbers> met;
    double worst = 0;
    while (!finished(model, state)) {
      step(model, state, work);
      for (const PairBook& pair : state.pairs) {
        const auto one = bodies_of(pair);
        if (std::find(met.begin(), met.end(), one) == met.end()) met.push_back(one);
      }
      std::vector<Vec2> apart = momentum;
      std::uint64_t touching = 0;
      for (const PairBook& pair : state.pairs) {
        apart[pair.first] += pair.book.total.impulse();
        apart[pair.second] -= pair.book.total.impulse();
        touching += pair.book.touching;
      }
      CHECK(touching == state.touches.size());
      for (std::size_t b = 0; b < 6; ++b) {
        const Vec2 now = integrator == Integrator::adams ? state.body_sums[b].momentum : state.body_momentum[b];
        worst = std::max(worst, length(apart[b] - now));
      }
    }
    CHECK(met == std::vector<BodyNumbers>{{4, 5}, {0, 1}, {1, 2}});
    REQUIRE(state.pairs.size() == 3);
    CHECK(bodies_of(state.pairs[0]) == BodyNumbers{0, 1});
    CHECK(bodies_of(state.pairs[1]) == BodyNumbers{1, 2});
    CHECK(bodies_of(state.pairs[2]) == BodyNumbers{4, 5});
    CHECK(book_of_pair(state, 5, 4) == &state.pairs[2].book);
    CHECK(book_of_pair(state, 3, 4) == nullptr);
    CHECK(length(state.pairs[2].book.total.impulse()) > 0.1 * length(momentum[4]));
    CHECK(worst < 1e-12 * length(momentum[4]));
  }
}

TEST_CASE("a body folds onto itself: its arms strike each other") {
  // A ring that a block crushes flat on an anvil.
  Case input{
      .run = {.end_time = 4e-3, .stop_at_energy_error = 0.05},
      .contact = {.friction = 0.1},
      .materials = {{.name = "steel", .density = 7850, .law = plastic},
                    {.name = "soft",
                     .density = 7850,
                     .law = Tresca{.young_modulus = 20e9, .poisson_ratio = 0.3, .yield_stress = 60e6}}},
      .bodies = {{.name = "ring",
                  .material = "soft",
                  .thickness = 0.01,
                  .mesh =
                      RingMesh{.outer_radius = 0.02, .inner_radius = 0.017, .at = {0, 0.0205}, .element_size = 0.0015}},
                 block("hammer", {-0.03, 0.041}, {0.06, 0.01}, 0.005, {0, -30})},
      .obstacles = {{.name = "anvil", .shape = HalfPlane{}, .friction = 0.1}}};
  const Model model = build_model(input);
  Workspace work(model, 1);
  State state = start(model, work);
  bool itself = false;
  while (!finished(model, state)) {
    step(model, state, work);
    for (const BodyTouch& touch : state.touches)
      itself = itself || (touch.body == 0 && model.contact_bodies[touch.point] == 0);
  }
  CHECK(itself);
  CHECK(state.ledger.energy_error() < 1e-2);
  CHECK(state.largest_penetration < 0.5);
}

TEST_CASE("bodies that overlap at the start are refused, with depth and place") {
  Case input = two_blocks(elastic, 0);
  std::get<RectangleMesh>(input.bodies[1].mesh).at = {0.005, 0.015};
  const Model model = build_model(input);
  Workspace work(model, 1);
  try {
    start(model, work);
    FAIL("not refused");
  } catch (const UserError& error) {
    const std::string text = error.what();
    CHECK(text.find("bodies `lower` and `upper` overlap") != std::string::npos);
    CHECK(text.find("m deep in the second") != std::string::npos);
    CHECK(text.find("touch = \"no\"") != std::string::npos);
  }
  // A small part of an element is what springs may be pressed at the start.
  std::get<RectangleMesh>(input.bodies[1].mesh).at = {0.005, 0.0199};
  const Model pressed = build_model(input);
  Workspace room(pressed, 1);
  CHECK(!start(pressed, room).touches.empty());
}

TEST_CASE("bodies that are not to touch pass through each other") {
  Case input = two_blocks(elastic, 0.3);
  input.contact_pairs = {{.body = "upper", .other = "lower", .touch = ContactPairCase::Touch::no}};
  const Model model = build_model(input);
  Workspace work(model, 1);
  State state = start(model, work);
  while (!finished(model, state)) {
    step(model, state, work);
    REQUIRE(state.touches.empty());
  }
}

}  // namespace udar

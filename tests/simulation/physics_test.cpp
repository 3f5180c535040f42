// What a case may ask for, each against what must come out exactly.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/results/scratch.hpp"
#include "tests/simulation/example.hpp"
#include "udar/results/histories.hpp"
#include "udar/simulation/simulation.hpp"

namespace udar {
namespace {

/// A block that flies freely.
Case flying_block() {
  Case c = falling_block();
  c.obstacles.clear();
  return c;
}

Selection all_of(const std::string& body) { return {.body = body, .box = {{-1, -1}, {1, 1}}}; }

double last(const Summary& s, const std::string& observer, const std::string& quantity) {
  return s.histories.at(observer).at(quantity).last;
}

/// Bits of the nodes and stresses of one body.
std::uint64_t hash_of_body(const Simulation& simulation, std::size_t body) {
  const Body& b = simulation.model().bodies[body];
  const State& all = simulation.state();
  State part;
  part.nodes.assign(all.nodes.begin() + b.node_begin, all.nodes.begin() + b.node_end);
  part.acceleration.assign(all.acceleration.begin() + b.node_begin, all.acceleration.begin() + b.node_end);
  for (const auto field :
       {&State::stress_xx, &State::stress_yy, &State::stress_xy, &State::stress_zz, &State::plastic_strain}) {
    (part.*field).assign((all.*field).begin() + b.element_begin, (all.*field).begin() + b.element_end);
  }
  return hash_of(part);
}

}  // namespace

TEST_CASE("two beams on one stop that are not to touch do not feel each other") {
  Case left = falling_block();
  left.run.time_step = 2e-7;
  left.bodies[0].name = "left";
  std::get<RectangleMesh>(left.bodies[0].mesh).at = {-0.05, 0};
  left.observed_nodes.clear();
  left.observed_elements.clear();
  left.observed_regions.clear();
  Case right = left;
  right.bodies[0].name = "right";
  right.bodies[0].velocity = {0, -40};
  // They lie upon each other: only their contact would part them.
  std::get<RectangleMesh>(right.bodies[0].mesh) = {.size = {0.03, 0.03}, .at = {-0.04, 0.002}, .element_size = 0.005};
  Case both = left;
  both.bodies.push_back(right.bodies[0]);
  both.contact_pairs = {{.body = "left", .other = "right", .touch = ContactPairCase::Touch::no}};

  Simulation alone_left(left);
  Simulation alone_right(right);
  Simulation together(both);
  alone_left.run();
  alone_right.run();
  const Summary s = together.run({.threads = 2});
  CHECK(hash_of_body(together, 0) == hash_of_body(alone_left, 0));
  CHECK(hash_of_body(together, 1) == hash_of_body(alone_right, 0));
  CHECK(s.masses.size() == 2);
  CHECK(last(s, "left", "velocity_y") != last(s, "right", "velocity_y"));
  CHECK(s.momentum_error < 1e-12);
}

TEST_CASE("a stop that strikes a block at rest is a block that falls on a stop at rest") {
  Case falls = falling_block();
  falls.run.gravity = {};
  falls.run.time_step = 1e-7;
  falls.bodies[0].velocity = {0, -80};
  Case is_struck = falls;
  is_struck.bodies[0].velocity = {};
  is_struck.obstacles[0].velocity = {0, 80};
  const Summary a = Simulation(falls).run();
  const Summary b = Simulation(is_struck).run();
  // Places differ by 5 mm of flight: rounding, blown up by sticking and sliding of single nodes.
  CHECK(last(b, "block", "velocity_y") == doctest::Approx(last(a, "block", "velocity_y") + 80).epsilon(1e-6));
  const EpisodeSummary& fall = a.contacts.at("stop").episodes.at(0);
  const EpisodeSummary& blow = b.contacts.at("stop").episodes.at(0);
  CHECK(fall.velocity_before.y == doctest::Approx(-80));
  CHECK(blow.velocity_before.y == 0);
  CHECK(blow.restitution == doctest::Approx(fall.restitution).epsilon(1e-6));
  CHECK(blow.impulse.y == doctest::Approx(fall.impulse.y).epsilon(1e-6));
  // The stop moves with 80 m/s: its work is its impulse times that.
  CHECK(b.ledger.obstacles == doctest::Approx(80 * b.contacts.at("stop").impulse.y).epsilon(1e-9));
  CHECK(a.ledger.obstacles == 0);
  CHECK(b.ledger.start == 0);
  CHECK(b.momentum_error < 1e-12);
  CHECK(b.energy_error < 0.05);
}

TEST_CASE("free flight under gravity: the parabola, no stress, no turn") {
  Case input = flying_block();
  input.run.end_time = 0.01;
  input.run.time_step = 2e-7;
  input.output.histories_every = 1e-4;
  const Scratch folder;
  const Summary s = Simulation(input).run({.folder = folder / "run"});
  const History block = read_csv(folder / "run/histories/block.csv");
  REQUIRE(block.at("time").size() == 101);
  double off = 0;
  for (std::size_t k = 0; k < 101; ++k) {
    const double t = block.at("time")[k];
    off = std::max(off, std::fabs(block.at("position_y")[k] - (0.01 - 80 * t - 0.5 * 9.81 * t * t)));
    off = std::max(off, std::fabs(block.at("position_x")[k] - 5 * t));
  }
  // 50 000 steps round a place of up to 0.8 m by 1e-16 m each.
  CHECK(off <= 5e-12);
  CHECK(last(s, "block", "velocity_y") == doctest::Approx(-80 - 0.0981).epsilon(1e-12));
  CHECK(s.histories.at("bottom").at("max_shear").max <= 1e-6 * 235e6);
  CHECK(std::fabs(last(s, "block", "spin")) <= 1e-12);
  CHECK(s.energy_error <= 1e-11);
  CHECK(s.ledger.gravity == doctest::Approx(s.masses.at("block") * 9.81 * (0.8 + 0.5 * 9.81e-4)).epsilon(1e-9));
  CHECK(s.verdict == "good");
}

TEST_CASE("loads follow their tables: force, traction and pressure give the impulse under the table") {
  Case input = flying_block();
  input.run.gravity = {};
  input.bodies[0].velocity = {};
  input.run.time_step = 1e-7;
  const TimeTable ramp{{0, 10e-6, 20e-6, 40e-6}, {0, 1, 1, 0}};                    // area 25 us
  const TimeTable smooth{{0, 20e-6, 40e-6}, {0, 1, 0}, TimeTable::Shape::smooth};  // area 20 us
  input.loads = {{.name = "push",
                  .kind = LoadCase::Kind::force,
                  .where = {.body = "block", .side = "left"},
                  .value = {100, 0},
                  .factor = ramp},
                 {.name = "drag",
                  .kind = LoadCase::Kind::traction,
                  .where = {.body = "block", .side = "top"},
                  .value = {2e5, 0},
                  .factor = smooth},
                 {.name = "air",
                  .kind = LoadCase::Kind::pressure,
                  .where = {.body = "block", .side = "bottom"},
                  .pressure = 1e6,
                  .factor = ramp}};
  const Summary s = Simulation(input).run();
  // Tables whose corners are multiples of the step are summed exactly: 5 nodes, 4 cm x 1 cm of edge.
  const Vec2 expected{5 * 100 * 25e-6 + 2e5 * 4e-4 * 20e-6, 1e6 * 4e-4 * 25e-6};
  CHECK(s.momentum.loads.x == doctest::Approx(expected.x).epsilon(1e-6));
  CHECK(s.momentum.loads.y == doctest::Approx(expected.y).epsilon(1e-3));  // the edge turns and stretches
  CHECK(s.momentum.end.x == doctest::Approx(s.momentum.loads.x).epsilon(1e-12));
  CHECK(s.momentum.end.y == doctest::Approx(s.momentum.loads.y).epsilon(1e-12));
  CHECK(s.ledger.loads == doctest::Approx(s.ledger.total).epsilon(1e-3));
  CHECK(s.verdict == "good");
}

TEST_CASE("the reaction of a block that is held is its weight, in every row") {
  Case input = flying_block();
  input.bodies[0].velocity = {};
  input.supports = {
      {.name = "hands", .nodes = all_of("block"), .move_x = TimeTable::constant(0), .move_y = TimeTable::constant(0)}};
  const Scratch folder;
  const Summary s = Simulation(input).run({.folder = folder / "run"});
  const double weight = 9.81 * s.masses.at("block");
  const History hands = read_csv(folder / "run/histories/hands.csv");
  CHECK(hands.columns[2] == Column{"reaction_y", "N"});
  for (const double reaction : hands.at("reaction_y")) CHECK(reaction == doctest::Approx(weight).epsilon(1e-12));
  CHECK(s.histories.at("hands").at("reaction_x").max_abs == 0);
  CHECK(s.histories.at("corner").at("displacement_y").max_abs == 0);
  CHECK(s.momentum.supports.y == doctest::Approx(weight * 60e-6).epsilon(1e-2));
  CHECK(s.verdict == "good");
}

TEST_CASE("supports move nodes as their tables say, and the reaction is mass times acceleration") {
  Case input = flying_block();
  input.run.gravity = {};
  input.bodies[0].velocity = {};
  input.run.time_step = 1e-7;
  input.supports = {{.name = "robot",
                     .nodes = all_of("block"),
                     .move_x = TimeTable{{0, 60e-6}, {0, 1e-3}, TimeTable::Shape::smooth},
                     .move_y = TimeTable::constant(0)}};
  Simulation simulation(input);
  double off = 0;
  const double mass = simulation.model().bodies[0].mass;
  simulation.observe([&](const Model& model, const State& state) {
    const double s = state.clock.time.value() / 60e-6;
    for (Index i = 0; i < model.node_count; ++i) {
      const double wanted = 1e-3 * s * s * s * (10 - 15 * s + 6 * s * s);
      off = std::max(off, std::fabs(state.nodes[i].x - model.rest[i].x - wanted));
    }
    if (state.clock.step < 2 || s > 0.99) return;
    Vec2 reaction;
    for (const Vec2 f : state.support_forces) reaction += f;
    const double acceleration = 1e-3 / (60e-6 * 60e-6) * (60 * s - 180 * s * s + 120 * s * s * s);
    CHECK(reaction.x == doctest::Approx(mass * acceleration).epsilon(1e-3).scale(mass * 1e6));
  });
  const Summary s = simulation.run();
  CHECK(off <= 1e-15);
  CHECK(last(s, "block", "position_x") == doctest::Approx(1e-3).epsilon(1e-12));
  CHECK(s.momentum_error < 1e-12);
}

TEST_CASE("a support that turns a block does so rigidly, and without stress") {
  Case input = flying_block();
  input.run.gravity = {};
  input.bodies[0].velocity = {};
  input.run.end_time = 6e-3;
  input.run.time_step = 5e-7;
  constexpr double quarter = std::numbers::pi / 2;
  input.supports = {{.name = "mill",
                     .nodes = all_of("block"),
                     .turn = TimeTable{{0, 5e-3}, {0, quarter}, TimeTable::Shape::smooth},
                     .turn_about = {0.1, 0}}};
  const Summary s = Simulation(input).run();
  // (x, y) about (0.1, 0) by a quarter: (0.1 - y, x - 0.1).
  CHECK(last(s, "corner", "displacement_x") == doctest::Approx(0.1 - 0.02 + 0.02).epsilon(1e-9));
  CHECK(last(s, "corner", "displacement_y") == doctest::Approx(-0.12 - 0.02).epsilon(1e-9));
  CHECK(s.histories.at("bottom").at("max_shear").max <= 1e-6 * 235e6);
  CHECK(s.histories.at("mill").at("moment").max_abs > 0);
}

}  // namespace udar

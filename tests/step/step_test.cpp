#include "udar/step/step.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <string>

#include "tests/step/small_model.hpp"
#include "udar/base/error.hpp"
#include "udar/step/integrators.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

template <class T>
std::string bytes(const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
template <class T, class A>
std::string bytes(const std::vector<T, A>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  return {reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size()};
}

/// The bits of every field of the state.
std::map<std::string, std::string> fields(const State& state) {
  std::map<std::string, std::string> all;
  for_each_field(state, [&](const char* name, const auto& field) { all[name] = bytes(field); });
  return all;
}

void check_same(const State& a, const State& b) {
  const auto one = fields(a);
  const auto two = fields(b);
  REQUIRE(one.size() == two.size());
  for (const auto& field : one) {
    const std::string& name = field.first;
    CAPTURE(name);
    CHECK((field.second == two.at(name)));
  }
}

State run_steps(const Model& model, int steps, int threads) {
  Workspace work(model, threads);
  State state = start(model, work);
  for (int i = 0; i < steps; ++i) step(model, state, work);
  return state;
}

const Integrator all_integrators[] = {Integrator::central_difference, Integrator::adams, Integrator::adams2,
                                      Integrator::adams2_new_velocity};

}  // namespace

TEST_CASE("a copy of the state in mid-run goes on with the same bits") {
  for (const Integrator integrator : all_integrators) {
    const Model model = build({.integrator = integrator});
    Workspace work(model, 1);
    State state = start(model, work);
    for (int i = 0; i < 150; ++i) step(model, state, work);
    CHECK(state.obstacles[0].touching > 0);
    State copy = state;
    Workspace other(model, 1);
    for (int i = 0; i < 150; ++i) step(model, state, work);
    for (int i = 0; i < 150; ++i) step(model, copy, other);
    check_same(state, copy);
  }
}

TEST_CASE("any number of threads gives the same bits") {
  for (const Integrator integrator : {Integrator::central_difference, Integrator::adams}) {
    const bool central = integrator == Integrator::central_difference;
    const Model model = build({.element_size = 0.005, .integrator = integrator, .held = central ? "right" : ""});
    REQUIRE(model.element_blocks.size() > 4);
    const State one = run_steps(model, 300, 1);
    bool flowed = false;
    for (const double strain : one.plastic_strain) flowed = flowed || strain > 0;
    CHECK(flowed);
    CHECK(one.obstacles[0].touching > 0);
    for (const int threads : {2, 3, 4, 7, 8}) {
      CAPTURE(threads);
      check_same(one, run_steps(model, 300, threads));
    }
  }
}

TEST_CASE("the same state twice, another one differs") {
  // The comparison itself can fail.
  const Model model = build();
  const State a = run_steps(model, 20, 1);
  const State b = run_steps(model, 21, 1);
  CHECK((fields(a) == fields(run_steps(model, 20, 1))));
  CHECK_FALSE((fields(a).at("nodes") == fields(b).at("nodes")));
}

TEST_CASE("the run ends on the end time, with the last step cut") {
  Model model = build({.element_size = 0.02, .end_time = 20e-6});
  Workspace work(model, 1);
  State state = start(model, work);
  double shortest = 1;
  while (!finished(model, state)) {
    step(model, state, work);
    shortest = std::min(shortest, state.clock.last_step);
  }
  // To the last place or the one after, never before: a remainder would be a step of its own.
  CHECK(state.clock.time.value() >= 20e-6);
  CHECK(state.clock.time.value() - 20e-6 <= 1e-20);
  CHECK(shortest > 0.3 * state.clock.largest_step);
  CHECK(state.clock.step > 10);
}

TEST_CASE("a step cut short after its velocity was computed: the one after it sets the velocity right") {
  Model model = build({.end_time = 1});
  model.loads.clear();
  model.obstacles.clear();
  model.run.gravity = {0, -1e5};
  model.run.time_step = 1e-7;
  Workspace work(model, 1);
  State state = start(model, work);
  const double g = model.run.gravity.y;
  const double mass = model.bodies[0].mass;
  Clock& clock = state.clock;
  double ahead = 0;  // m, of the place, by the steps that were cut
  double coming = 0;
  for (int n = 0; n < 40; ++n) {
    step(model, state, work);
    ahead += coming;
    const double t = clock.time.value();
    const double speed = model.start_velocity[0].y + g * t;
    const double place = model.rest[0].y + model.start_velocity[0].y * t + 0.5 * g * t * t + ahead;
    const double to_now = g * (0.5 * clock.last_step - clock.velocity_ahead);
    const double energy = 0.5 * mass * (25 + speed * speed - to_now * to_now);
    CHECK(std::fabs(velocity(state, 0).y - speed) < 1e-12 * 80);
    CHECK(std::fabs(state.body_sums[0].momentum.y - mass * speed) < 1e-12 * 80 * mass);
    CHECK(std::fabs(state.nodes[0].y - place) < 1e-15);
    CHECK(std::fabs(state.ledger.kinetic_energy - energy) < 1e-12 * energy);
    const bool cut = n % 10 == 5;
    if (cut) {
      clock.next_velocity_ahead = 0.3 * clock.next_step;
      clock.next_step *= 0.4;
    }
    coming = g * clock.next_step * clock.next_velocity_ahead;
  }
  CHECK(std::fabs(ahead) > 1e-11);
}

TEST_CASE("a fixed step above the stable limit is refused with both numbers") {
  Model model = build({.element_size = 0.02});
  model.run.time_step = 1e-5;
  Workspace work(model, 1);
  CHECK_THROWS_AS(start(model, work), UserError);
}

TEST_CASE("what is held stays, and the support feels it") {
  const Model model = build({.held = "right"});
  const State state = run_steps(model, 200, 1);
  bool pushed = false;
  for (const Index node : model.supports[0].nodes) {
    CHECK(std::fabs(state.nodes[node].x - model.rest[node].x) <= 1e-15);
    CHECK(state.nodes[node].y < model.rest[node].y);  // free
  }
  for (const Vec2 force : state.support_forces) {
    pushed = pushed || std::fabs(force.x) > 0;
    CHECK(force.y == 0);
  }
  CHECK(pushed);
}

TEST_CASE("a side that is stopped, or moved, with every integrator") {
  for (const Integrator integrator : all_integrators) {
    for (const bool moves : {false, true}) {
      const std::string keyword = rule_of(integrator).keyword;
      CAPTURE(keyword);
      CAPTURE(moves);
      // It flies at (5, -80) m/s; the support stops it along x, or carries it on at 20 m/s.
      Model model = build({.integrator = integrator, .held = "right"});
      model.obstacles.clear();
      model.contact_nodes.clear();
      model.contact_spring.assign(model.corners.size(), 0);
      if (moves) model.supports[0].move_x = {.times = {0, 1}, .values = {0, 20}};
      State state;
      CHECK_NOTHROW(state = run_steps(model, 200, 1));
      if (state.nodes.empty()) continue;
      // The sudden stop is a wave of 5 or 15 m/s: small beside the flight at 80 m/s.
      CHECK(state.ledger.kinetic_energy <= 1.2 * state.ledger.start_kinetic);
      const double way = moves ? 20 * state.clock.time.value() : 0;
      for (const Index node : model.supports[0].nodes) {
        CHECK(std::fabs(state.nodes[node].x - model.rest[node].x - way) <= 1e-15);
        CHECK(std::fabs(velocity(state, node).x) <= 21);
      }
    }
  }
}

TEST_CASE("padding neither moves nor takes part") {
  const Model model = build();
  const State state = run_steps(model, 100, 1);
  for (std::size_t i = model.node_count; i < model.rest.size(); ++i) {
    CHECK(state.nodes[i].x == model.rest[i].x);
    CHECK(state.nodes[i].y == model.rest[i].y);
  }
  for (std::size_t e = model.bodies[0].element_end; e < model.corners.size(); ++e) CHECK(state.stress_xx[e] == 0);
}

TEST_CASE("prepare takes stresses set by hand") {
  Model model = build({.element_size = 0.02});
  model.run.gravity = {};
  model.loads.clear();
  model.obstacles.clear();
  model.contact_spring.assign(model.corners.size(), 0);
  model.contact_nodes.clear();
  model.start_velocity.assign(model.rest.size(), {});
  Workspace work(model, 1);
  State state = rest_state(model);
  for (Index e = 0; e < model.element_count; ++e) state.stress_xx[e] = 1e6;
  prepare(model, state, work);
  // A uniform pull is in equilibrium inside; at the free ends, where nothing pulls, it sets off inwards.
  for (Index i = 0; i < model.node_count; ++i) {
    const double x = model.rest[i].x;
    const double a = state.acceleration[i].x;
    if (std::fabs(x) < 0.199) {
      CHECK(std::fabs(a) <= 1e-6);
    } else {
      CHECK(a * x < 0);
    }
  }
  CHECK(state.clock.step == 0);
  CHECK(state.ledger.start_energy == 0);
}

}  // namespace udar

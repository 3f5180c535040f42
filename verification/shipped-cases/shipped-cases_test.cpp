// The shipped cases of bodies that strike each other: what must come out whatever the mesh. See README.md of each case.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "udar/base/box.hpp"
#include "wave_tools.hpp"

namespace udar::verification {
namespace {

Case shipped(const std::string& name) { return load("../../cases/" + name + "/" + name + ".toml"); }

Box box_of(const Run& run, std::size_t body) {
  Box box;
  for (Index i = run.model.bodies[body].node_begin; i < run.model.bodies[body].node_end; ++i) {
    box.include({run.state.nodes[i].x, run.state.nodes[i].y});
  }
  return box;
}

double total_spin(const Run& run) {
  double spin = 0;
  for (const double s : run.state.body_spin) spin += s;
  return spin;
}

}  // namespace

TEST_CASE("two-plates: momentum and spin are kept, friction heats, the plates fly apart") {
  Run run(shipped("two-plates"));
  const Vec2 momentum = run.state.body_momentum[0] + run.state.body_momentum[1];
  const double spin = total_spin(run);
  const double arm = 0.05;  // m, of the flying plate about the origin
  double last = 0;
  run.run([&](const Run& now) {
    if (!now.state.touches.empty()) last = now.time();
  });
  const Vec2 after = run.state.body_momentum[0] + run.state.body_momentum[1];
  CHECK(below("momentum", length(after - momentum) / length(momentum), 1e-12));
  CHECK(below("spin", std::fabs(total_spin(run) - spin) / (arm * length(momentum)), 1e-12));
  CHECK(below("energy error", run.state.ledger.energy_error(), 2e-3));
  CHECK(below("penetration over element", run.state.largest_penetration, 0.05));
  CHECK(run.state.ledger.friction_work.value() > 0);
  CHECK(run.state.ledger.plastic_work.value() > 0);
  CHECK(last < 0.9 * run.model.run.end_time);
}

TEST_CASE("ring-crush: the ring is pressed flat and its walls stop each other") {
  Run run(shipped("ring-crush"));
  constexpr double wall = 0.003;  // m
  bool itself = false;
  double thinnest = 1;
  run.run([&](const Run& now) {
    itself = itself || now.state.pairs[pair_number(0, 0)].touching > 0;
    thinnest = std::min(thinnest, box_of(now, 0).size().y);
  });
  CHECK(itself);
  // Two walls on each other: plastic flow keeps the area, so they can hardly get thinner, unless they pass through.
  CHECK(thinnest > 1.9 * wall);
  CHECK(thinnest < 3 * wall);
  CHECK(below("energy error", run.state.ledger.energy_error(), 2e-3));
  CHECK(below("penetration over element", run.state.largest_penetration, 0.05));
}

TEST_CASE("stack: the heap comes to rest and weighs what its blocks weigh") {
  Run run(shipped("stack"));
  const double start = run.state.ledger.start_kinetic;
  double worst = 0;
  run.run([&](const Run& now) {
    if (now.time() > 0.15) worst = std::max(worst, std::fabs(now.state.ledger.kinetic_energy));
  });
  CHECK(below("kinetic energy at rest over that of the start", worst / start, 1e-6));
  double weight = 0;
  for (const Body& body : run.model.bodies) weight += body.mass * 9.81;
  CHECK(within("force on the ground (N)", run.state.obstacles[0].total.force.y, weight, 1e-6));
  // The heap stands: every block is where its row is, within a spring's give, and has not left its place by a
  // centimetre.
  for (std::size_t b = 0; b < run.model.bodies.size(); ++b) {
    Box rest;
    for (Index i = run.model.bodies[b].node_begin; i < run.model.bodies[b].node_end; ++i)
      rest.include(run.model.rest[i]);
    const double row = std::round((rest.low.y - 0.0005) / 0.0205);
    CHECK(std::fabs(box_of(run, b).low.y - 0.02 * row) < 1e-4);
    CHECK(std::fabs(box_of(run, b).low.x - rest.low.x) < 0.01);
  }
  CHECK(below("energy error", run.state.ledger.energy_error(), 2e-3));
}

}  // namespace udar::verification

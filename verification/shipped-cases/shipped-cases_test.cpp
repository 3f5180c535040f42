// The shipped cases of bodies that strike each other: what must come out whatever the mesh. See README.md of each case.

#include <doctest/doctest.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "udar/base/box.hpp"
#include "udar/simulation/simulation.hpp"
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
    const ContactBook* const ring = book_of_pair(now.state, 0, 0);
    itself = itself || (ring != nullptr && ring->touching > 0);
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

namespace {

/// The two plates at another speed, the flying one meshed `ratio` times as fine as the resting one.
Case plates(bool elastic, double speed, int ratio) {
  Case c = shipped("two-plates");
  if (elastic) {
    const Tresca steel = std::get<Tresca>(c.materials[0].law);
    c.materials[0].law = Elastic{steel.young_modulus, steel.poisson_ratio};
  }
  BodyCase& flying = c.bodies[1];
  flying.velocity = {0.6 * speed, -0.8 * speed};
  std::get<RectangleMesh>(flying.mesh).element_size = 0.002 / ratio;
  // They meet after a fifth of a millimetre; then a while with both in touch.
  std::get<RectangleMesh>(flying.mesh).at = {-0.05, 0.0002};
  c.run.end_time = 0.0003 / (0.8 * speed) + 0.3e-3;
  return c;
}

}  // namespace

TEST_CASE("two-plates: any speed from 1 to 500 m/s, any ratio of meshes from 1 to 8 (long)") {
  for (const bool elastic : {true, false}) {
    for (const double speed : {1.0, 10.0, 50.0, 100.0, 150.0, 250.0, 350.0, 500.0}) {
      for (const int ratio : {1, 2, 4, 8}) {
        Simulation simulation(plates(elastic, speed, ratio));
        const Summary s = simulation.run();
        const std::string what = fmt::format("{}, {} m/s, 1:{}", elastic ? "elastic" : "plastic", speed, ratio);
        INFO(what, ": ", s.stop_reason, " ", s.reasons.empty() ? "" : s.reasons.front());
        MESSAGE(fmt::format("{}: {}, energy error {:.2g}, penetration {:.2g}", what, s.verdict, s.energy_error,
                            s.penetration_ratio));
        REQUIRE(s.contacts.count("resting/flying") == 1);
        CHECK(below("momentum", s.momentum_error, 1e-12));
        // Elastic pairs finish at every speed, plastic ones up to 150 m/s; above they may crush an element and say so.
        // Their books close, but where flush plates of four elements strike node on node: a touch costs up to
        // k h^2/(4 m), a tenth or so, of a node's energy, and there a fifth of all nodes touch at once.
        if (elastic || speed <= 150) CHECK(s.stop_reason == "end_time");
        if (!elastic && speed <= 150) CHECK((s.verdict == "good" || (ratio == 1 && s.energy_error < 0.005)));
        if (s.stop_reason == "numerical") CHECK(s.reasons.front().find("element") != std::string::npos);
        // Nobody has come out on the other side: the flying plate is pushed back, the resting one away.
        CHECK(simulation.state().body_momentum[0].y < 0);
      }
    }
  }
}

}  // namespace udar::verification

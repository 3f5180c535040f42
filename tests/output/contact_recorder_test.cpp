#include "udar/output/contact_recorder.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/output/watched_run.hpp"
#include "tests/simulation/example.hpp"

namespace udar {
namespace {

/// A block and a second one beside it, and a state whose contacts a test writes by hand.
class Script {
 public:
  Script() : model_(build_model(two_blocks())), recorder_(model_) {
    state_.contacts.resize(model_.contact_nodes.size());
    state_.obstacles.resize(1);
    for (const Vec2 p : model_.rest) state_.nodes.push_back({p.x, p.y, 0, 0});
    state_.body_spin.resize(2);
    state_.body_sums.resize(2);
    state_.body_momentum = {{0, -80 * model_.bodies[0].mass}, {0, -80 * model_.bodies[1].mass}};
    recorder_.record(state_);
  }

  /// A step of 1 s in which body `body` (0: the first) feels a force upwards; 0: nothing touches.
  void step(double force, std::size_t body = 0) {
    state_.clock.time.add(1);
    ++state_.clock.step;
    for (SpringState& s : state_.contacts) s.touches = 0;
    ContactBook& book = state_.obstacles[0];
    book.touching = force != 0 ? 1 : 0;
    for (ForceBook* b : {&book.total, &book.normal}) {
      b->force = {0, force};
      b->impulse_y.add(force);
    }
    state_.body_momentum[body].y += force;
    if (force != 0) state_.contacts[body == 0 ? 0 : state_.contacts.size() - 1].touches = 1;
    recorder_.record(state_);
  }
  /// Something else gives a body this momentum upwards.
  void drift(double momentum, std::size_t body) { state_.body_momentum[body].y += momentum; }
  void steps(int count, double force, std::size_t body = 0) {
    for (int k = 0; k < count; ++k) step(force, body);
  }
  [[nodiscard]] ContactSummary summary() const { return recorder_.summary().at("stop"); }
  [[nodiscard]] double mass(std::size_t body = 0) const { return model_.bodies[body].mass; }

 private:
  static Case two_blocks() {
    Case c = falling_block();
    c.bodies[0].velocity = {0, -80};
    c.bodies.push_back(c.bodies[0]);
    c.bodies[1].name = "other";
    std::get<RectangleMesh>(c.bodies[1].mesh).at = {0.1, 0};
    return c;
  }

  Model model_;
  State state_;
  ContactRecorder recorder_;
};

}  // namespace

TEST_CASE("an obstacle that nothing touches has no numbers") {
  Script script;
  script.steps(5, 0);
  const ContactSummary s = script.summary();
  CHECK(std::isnan(s.first_touch));
  CHECK(std::isnan(s.last_separation));
  CHECK(std::isnan(s.duration));
  CHECK(std::isnan(s.duration_99));
  CHECK(std::isnan(s.peak_force));
  CHECK(s.impulse == Vec2{});
  CHECK(s.episodes.empty());
}

TEST_CASE("one touch: from the first step with force to the first without") {
  Script script;
  script.steps(3, 0);   // 1, 2, 3 s
  script.steps(4, 10);  // 4 ... 7 s
  script.step(30);      // 8 s
  script.steps(5, 0);   // 9 ... s
  const ContactSummary s = script.summary();
  CHECK(s.first_touch == 4);
  CHECK(s.last_separation == 9);
  CHECK(s.duration == 5);
  CHECK(s.peak_force == 30);
  CHECK(s.impulse == Vec2{0, 70});
  CHECK(s.merged_gaps == 0);
  REQUIRE(s.episodes.size() == 1);
  const EpisodeSummary& e = s.episodes[0];
  CHECK(e.first_touch == 4);
  CHECK(e.separation == 9);
  CHECK(e.duration == 5);
  CHECK(e.impulse == Vec2{0, 70});
  CHECK(e.velocity_before.y == doctest::Approx(-80));
  CHECK(e.velocity_after.y == doctest::Approx(-80 + 70 / script.mass()));
  CHECK(e.restitution == doctest::Approx((-80 + 70 / script.mass()) / 80));
}

TEST_CASE("99 % of the impulse: the first time from which at least so much has been given") {
  Script script;
  script.step(50);   // 1 s: 50 of 100
  script.step(48);   // 98
  script.step(1);    // 3 s: 99
  script.step(0.5);  // 99.5
  script.step(0.5);  // 100
  script.step(0);
  CHECK(script.summary().duration_99 == 2);
  CHECK(script.summary().duration == 5);
}

TEST_CASE("99 % is not reached before a pull has taken it away again") {
  Script script;
  script.step(100);
  script.step(-50);
  script.step(50);  // 3 s: for good
  script.step(0);
  CHECK(script.summary().duration_99 == 2);
}

TEST_CASE("gaps below 2 % of the whole are merged and counted, others part episodes") {
  Script script;
  script.steps(40, 1);  // 1 ... 40 s
  script.step(0);       // left at 41 s, touched again at 42 s: a gap of 1 s
  script.steps(39, 2);  // 42 ... 80 s
  script.steps(3, 0);   // left at 81 s, touched again at 84 s: a gap of 3 s
  script.steps(20, 3);  // 84 ... 103 s
  script.step(0);       // 104 s; the whole is 103 s, 2 % of it 2.06 s
  const ContactSummary s = script.summary();
  CHECK(s.merged_gaps == 1);
  REQUIRE(s.episodes.size() == 2);
  CHECK(s.episodes[0].first_touch == 1);
  CHECK(s.episodes[0].separation == 81);
  CHECK(s.episodes[0].impulse == Vec2{0, 118});
  CHECK(s.episodes[0].peak_force == 2);
  CHECK(s.episodes[0].velocity_before.y == doctest::Approx(-80));
  CHECK(s.episodes[1].first_touch == 84);
  CHECK(s.episodes[1].impulse == Vec2{0, 60});
  CHECK(s.episodes[1].velocity_before == s.episodes[0].velocity_after);
  CHECK(s.peak_force == 3);
  CHECK(s.impulse == Vec2{0, 178});
}

TEST_CASE("a gap that is short against the contact so far is closed at once, and counted all the same") {
  Script script;
  script.steps(100, 1);  // 1 ... 100 s
  script.step(0);        // left at 101 s, touched again at 102 s: 1 s of 101 s so far
  script.steps(5, 3);
  script.step(0);  // 107 s
  const ContactSummary s = script.summary();
  CHECK(s.merged_gaps == 1);
  REQUIRE(s.episodes.size() == 1);
  const EpisodeSummary& e = s.episodes[0];
  CHECK(e.first_touch == 1);
  CHECK(e.separation == 107);
  CHECK(e.impulse == Vec2{0, 115});
  CHECK(e.peak_force == 3);
  CHECK(e.velocity_before.y == doctest::Approx(-80));
  CHECK(e.velocity_after.y == doctest::Approx(-80 + 115 / script.mass()));
}

TEST_CASE("a contact that still lasts at the end has no separation and no restitution") {
  Script script;
  script.steps(3, 10);
  const ContactSummary s = script.summary();
  CHECK(std::isnan(s.last_separation));
  CHECK(s.duration == 2);
  REQUIRE(s.episodes.size() == 1);
  CHECK(std::isnan(s.episodes[0].separation));
  CHECK(std::isnan(s.episodes[0].restitution));
}

TEST_CASE("bodies that did not touch are not counted") {
  Script script;
  script.steps(3, 10, 1);
  script.step(0);
  const EpisodeSummary e = script.summary().episodes.at(0);
  CHECK(e.velocity_after.y == doctest::Approx(-80 + 30 / script.mass(1)));
  Script both;
  both.step(10, 0);
  both.step(20, 1);
  both.step(0);
  CHECK(both.summary().episodes.at(0).velocity_after.y == doctest::Approx(-80 + 30 / (both.mass(0) + both.mass(1))));
}

TEST_CASE("a body counts from its own first touch to its own last one in the episode") {
  Script script;
  script.step(10, 0);
  script.drift(7, 1);
  script.step(10, 0);
  script.step(20, 1);
  script.drift(5, 0);
  script.step(20, 1);
  script.step(0);
  const EpisodeSummary e = script.summary().episodes.at(0);
  const double mass = script.mass(0) + script.mass(1);
  CHECK(e.velocity_before.y == doctest::Approx(-80 + 7 / mass));
  CHECK(e.velocity_after.y == doctest::Approx(-80 + (20 + 7 + 40) / mass));
}

TEST_CASE("many steps of contact keep their 99 % though the curve is thinned") {
  Script script;
  constexpr int count = 300000;
  script.steps(count, 1);
  script.step(0);
  CHECK(script.summary().duration_99 == doctest::Approx(0.99 * count).epsilon(1e-4));
}

TEST_CASE("an elastic bounce on a spring: restitution of the discrete oscillator, to rounding") {
  // Each corner of a rigidly moving square is one mass on one spring, z = omega h = 0.1. Central difference gives
  // x_n = -v h sin(n theta) / sin(theta) with sin(theta / 2) = z / 2, as long as n theta < pi.
  constexpr double h = 1e-3;
  Case c{.run = {.end_time = 40e-3, .time_step = h, .stop_at_energy_error = 1},
         .materials = {{.name = "soft", .density = 6000, .law = Elastic{.young_modulus = 1e6, .poisson_ratio = 0}}},
         .bodies = {
             {.name = "square",
              .material = "soft",
              .velocity = {0, -1},
              .mesh = RectangleMesh{.size = {1, 1}, .element_size = 1, .diagonals = RectangleMesh::Diagonals::right}}}};
  const Vec2 corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const Vec2 corner : corners) {
    const bool heavy = corner.x == corner.y;  // 2000 kg there, 1000 kg at the others
    c.obstacles.push_back({.name = "anvil" + std::to_string(c.obstacles.size()),
                           .shape = Rectangle{.at = corner - Vec2{0.2, 0.3}, .size = {0.4, 0.3}},
                           .stiffness = heavy ? 2e7 : 1e7,
                           .corners = false});
  }
  WatchedRun run(c);
  ContactRecorder recorder(run.model);
  run.run([&] { recorder.record(run.state); });
  const ContactSummary s = recorder.summary().at("anvil0");
  const double theta = 2 * std::asin(0.05);
  const int last = static_cast<int>(std::numbers::pi / theta);  // step with contact
  const double after = (std::sin(last * theta) - std::sin((last + 1) * theta)) / std::sin(theta);
  REQUIRE(s.episodes.size() == 1);
  CHECK(s.episodes[0].velocity_before.y == -1);
  CHECK(s.episodes[0].restitution == doctest::Approx(after).epsilon(1e-12));
  CHECK(s.first_touch == doctest::Approx(h));
  CHECK(s.last_separation == doctest::Approx((last + 1) * h));
  CHECK(s.impulse.y == doctest::Approx(2000 * (1 + after)).epsilon(1e-12));
  const double deepest = h * std::sin(std::round(std::numbers::pi / 2 / theta) * theta) / std::sin(theta);
  CHECK(s.peak_force == doctest::Approx(2e7 * deepest).epsilon(1e-12));
}

}  // namespace udar

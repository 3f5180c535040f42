#include "udar/output/summarise.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "tests/output/watched_run.hpp"
#include "tests/results/scratch.hpp"
#include "tests/simulation/example.hpp"

namespace udar {
namespace {

/// A run in which nothing is wrong, to spoil one number of.
struct Spoilt {
  Spoilt() : run(case_with_fixed_step()), summary(summarise(run.model, run.state)) {
    summary.energy_error = 0;
    summary.penetration_ratio = 0;
    summary.stop_reason = "end_time";
  }
  static Case case_with_fixed_step() {
    Case c = falling_block();
    c.run.time_step = 1e-7;
    return c;
  }
  std::string verdict() {
    summary.reasons.clear();
    judge(run.model, run.state, summary);
    return summary.verdict;
  }
  [[nodiscard]] std::string reason() const { return summary.reasons.empty() ? "" : summary.reasons.back(); }

  WatchedRun run;
  Summary summary;
};

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("a run with closed books is good, without reasons") {
  Spoilt s;
  CHECK(s.verdict() == "good");
  CHECK(s.summary.reasons.empty());
}

TEST_CASE("the summary names what there is, and where observers sit") {
  Case c = falling_block();
  c.bodies.push_back(c.bodies[0]);
  c.bodies[1].name = "lid";
  c.bodies[1].rigid = true;
  c.bodies[1].mesh = RectangleMesh{.size = {0.04, 0.01}, .at = {-0.02, 0.03}, .element_size = 0.005};
  c.observed_nodes.push_back({.name = "energy", .body = "lid", .at = {0.02, 0.04}});
  const WatchedRun run(c);
  const Summary s = summarise(run.model, run.state);
  REQUIRE(s.bodies.size() == 2);
  CHECK(s.bodies[0].name == "block");
  CHECK_FALSE(s.bodies[0].rigid);
  CHECK(s.bodies[1].name == "lid");
  CHECK(s.bodies[1].rigid);
  CHECK(s.bodies[0].elements + s.bodies[1].elements == s.elements);
  CHECK(s.bodies[0].nodes + s.bodies[1].nodes == s.nodes);
  CHECK(s.obstacles == std::vector<std::string>{"stop"});
  CHECK(s.observed.size() == 3);
  CHECK(s.observed.at("corner").on == "node");
  CHECK(s.observed.at("corner").body == "block");
  CHECK(s.observed.at("bottom").on == "element");
  // Its history cannot be called as that of the books is.
  const ObservedSummary& lid = s.observed.at("energy_2");
  CHECK(lid.body == "lid");
  const Body& body = run.model.bodies[1];
  Index node = body.node_begin;
  while (node < body.node_end && run.model.node_numbers[node] != lid.number) ++node;
  REQUIRE(node < body.node_end);
  CHECK(run.model.rest[node].x == doctest::Approx(0.02));
  CHECK(run.model.rest[node].y == doctest::Approx(0.04));
}

TEST_CASE("the energy error decides at 0.1 % and 1 %") {
  Spoilt s;
  const auto verdict_at = [&](double error) {
    s.summary.energy_error = error;
    return s.verdict();
  };
  CHECK(verdict_at(0.001) == "good");
  CHECK(s.reason().empty());
  CHECK(verdict_at(0.00101) == "doubtful");
  CHECK(contains(s.reason(), "the energy books are 0.101 % apart (good: 0.1 %); a smaller `step_safety`"));
  CHECK(verdict_at(0.01) == "doubtful");
  CHECK(verdict_at(0.0101) == "bad");
  CHECK(verdict_at(nan) == "bad");
  CHECK(verdict_at(std::numeric_limits<double>::infinity()) == "bad");
}

TEST_CASE("books of momentum and of work and kinetic energy must close to rounding") {
  Spoilt s;
  State& state = s.run.state;
  state.ledger.momentum_gap = 1e-10 * state.ledger.momentum_scale;
  CHECK(s.verdict() == "good");
  state.ledger.momentum_gap = 1e-8 * state.ledger.momentum_scale;
  CHECK(s.verdict() == "bad");
  CHECK(contains(s.reason(), "momentum"));
  state.ledger.momentum_gap = nan;
  CHECK(s.verdict() == "bad");
  state.ledger.momentum_gap = 0;
  s.summary.identity_error = 1e-8;
  CHECK(s.verdict() == "bad");
  CHECK(contains(s.reason(), "kinetic"));
}

TEST_CASE("nodes that sink in by more than 5 % of an element are warned of, with who, where, when and the cure") {
  Spoilt s;
  s.summary.penetration_ratio = 0.05;
  CHECK(s.verdict() == "good");
  CHECK(s.summary.warnings.empty());
  s.summary.penetration_ratio = 0.0625;
  s.summary.deepest_penetration = {
      .depth = 0.0003, .time = 2e-5, .place = {0.01, -0.0003}, .body = "block", .into = "stop", .stiffness = 2e9};
  CHECK(s.verdict() == "good");
  CHECK(s.summary.reasons.empty());
  REQUIRE(s.summary.warnings.size() == 1);
  CHECK(
      s.summary.warnings[0] ==
      "a node of body `block` sank into obstacle `stop` by 6.25 % of an element (0.0003 m) at (0.01, -0.0003) m, "
      "t = 2e-05 s: contact springs of 2e+09 N/m soften the impact; give [obstacles.stop] a larger `stiffness`, up to "
      "3.1e+09 N/m, and a smaller `step_safety` if the energy books then open");
}

TEST_CASE("a warning of penetration names the other body, or the body itself, and where their stiffness is given") {
  Spoilt s;
  s.summary.penetration_ratio = 0.1;
  s.summary.deepest_penetration = {
      .depth = 1, .time = 1, .place = {}, .body = "block", .into = "block", .stiffness = 1};
  s.run.state.deepest.into_body = 1;
  s.verdict();
  CHECK(contains(s.summary.warnings.at(0), "sank into that body itself by 10 %"));
  CHECK(contains(s.summary.warnings.at(0), "give [contact] a larger `stiffness`, up to 4 N/m"));
  s.run.model.bodies.push_back(s.run.model.bodies[0]);
  s.run.model.bodies[1].name = "other";
  s.summary.deepest_penetration.into = "other";
  s.verdict();
  REQUIRE(s.summary.warnings.size() == 1);  // judged again, not twice
  CHECK(contains(s.summary.warnings[0], "sank into body `other` by 10 %"));
  CHECK(contains(s.summary.warnings[0], "give a [[contact.pairs]] of `block` and `other` a larger `stiffness`"));
}

namespace {

/// Follows a run and looks through all springs for the deepest touch; compares it with what the summary says.
Summary compare_deepest(const Case& input) {
  WatchedRun run(input);
  PenetrationSummary deepest;
  double ratio = 0;
  run.run([&] {
    const auto look = [&](const SpringState& s, std::size_t point, double stiffness, const std::string& into) {
      if (!(s.penetration / run.model.contact_node_sizes[point] > ratio)) return;
      ratio = s.penetration / run.model.contact_node_sizes[point];
      const Index node = run.model.contact_nodes[point];
      deepest = {.depth = s.penetration,
                 .time = run.time(),
                 .place = place(run.state, node),
                 .body = run.model.body_of_node(node).name,
                 .into = into,
                 .stiffness = stiffness};
    };
    const std::size_t points = run.model.contact_nodes.size();
    for (std::size_t k = 0; k < run.state.contacts.size(); ++k) {
      const Obstacle& obstacle = run.model.obstacles[k / points];
      look(run.state.contacts[k], k % points, obstacle.normal_stiffness[k % points], obstacle.name);
    }
    for (const BodyTouch& t : run.state.touches) look(t.springs, t.point, t.stiffness, run.model.bodies[t.body].name);
  });
  Summary s = summarise(run.model, run.state);
  CHECK(ratio > 0);
  CHECK(s.penetration_ratio == ratio);
  CHECK(s.deepest_penetration.depth == deepest.depth);
  CHECK(s.deepest_penetration.time == deepest.time);
  CHECK(s.deepest_penetration.place == deepest.place);
  CHECK(s.deepest_penetration.body == deepest.body);
  CHECK(s.deepest_penetration.into == deepest.into);
  CHECK(s.deepest_penetration.stiffness == deepest.stiffness);
  return s;
}

}  // namespace

TEST_CASE("the deepest penetration is the deepest of all touches and steps, with obstacles and with bodies") {
  Case input = falling_block();
  CHECK(compare_deepest(input).deepest_penetration.into == "stop");
  // A second block strikes the first one from above, harder than the stop does.
  input.bodies.push_back(input.bodies[0]);
  input.bodies[1].name = "other";
  input.bodies[1].velocity = {0, -400};
  std::get<RectangleMesh>(input.bodies[1].mesh) = {.size = {0.03, 0.01}, .at = {-0.013, 0.021}, .element_size = 0.003};
  input.run.end_time = 20e-6;
  const Summary two = compare_deepest(input);
  CHECK((two.deepest_penetration.into == "block" || two.deepest_penetration.into == "other"));
}

TEST_CASE("the stiffness that a warning names is enough, and smaller elements are no cure") {
  const auto strike = [](double element_size, std::optional<double> stiffness) {
    Case input = falling_block(element_size);
    input.materials[0].law = Elastic{.young_modulus = 196e9, .poisson_ratio = 0.25};
    input.bodies[0].velocity = {0, -400};
    input.obstacles[0].friction = 0;
    input.obstacles[0].stiffness = stiffness;
    input.run.end_time = 8e-6;
    input.run.stop_at_energy_error = 1;
    WatchedRun run(input);
    run.run([] {});
    return summarise(run.model, run.state);
  };
  const Summary automatic = strike(0.0025, {});
  const double excess = automatic.penetration_ratio / 0.05;
  REQUIRE(excess > 1.2);
  CHECK(strike(0.0025, automatic.deepest_penetration.stiffness * excess * excess).penetration_ratio <= 0.05);
  // The same shock on another mesh: times scale with the elements, until waves come back.
  CHECK(strike(0.00125, {}).penetration_ratio == doctest::Approx(automatic.penetration_ratio).epsilon(0.05));
}

TEST_CASE("a run in which nothing touched has no deepest penetration") {
  Case input = falling_block();
  input.obstacles[0].shape = HalfPlane{.point = {0, -1}};
  WatchedRun run(input);
  run.run([] {});
  const PenetrationSummary none = summarise(run.model, run.state).deepest_penetration;
  CHECK(std::isnan(none.depth));
  CHECK(std::isnan(none.time));
  CHECK(std::isnan(none.place.x));
  CHECK(none.body.empty());
}

TEST_CASE("shortened steps are told, and no more") {
  Spoilt s;
  Clock& clock = s.run.state.clock;
  clock.shortened = 12;
  clock.first_shortened = 3e-6;
  clock.first_shortened_element = 5;
  s.summary.time_step = summarise(s.run.model, s.run.state).time_step;
  CHECK(s.verdict() == "good");
  CHECK(s.reason() ==
        "the fixed step was above the stable limit and was shortened in 12 steps, first at t = 3e-06 s by " +
            element_name(s.run.model, 5));
}

TEST_CASE("a run that continues above the stable limit is never good") {
  Spoilt s;
  s.run.model.run.when_unstable = WhenUnstable::carry_on;
  CHECK(s.verdict() == "doubtful");
  CHECK(contains(s.reason(), "continue"));
  s.run.state.clock.shortened = 3;
  s.run.state.clock.largest_excess = 1.25;
  CHECK(s.verdict() == "doubtful");
  CHECK(contains(s.reason(), "in 3 steps, up to 1.25 times"));
  s.summary.energy_error = 1;
  CHECK(s.verdict() == "bad");
  CHECK(s.summary.reasons.size() == 2);
}

TEST_CASE("a crushed element is told with its place in time") {
  Spoilt s;
  Clock& clock = s.run.state.clock;
  clock.tightest.size = 0.26 * clock.start_limit;
  CHECK(s.verdict() == "good");
  CHECK(s.reason().empty());
  clock.tightest.size = 0.2 * clock.start_limit;
  clock.tightest.element = 7;
  clock.tightest_time = 2e-5;
  CHECK(s.verdict() == "good");
  CHECK(s.reason() ==
        element_name(s.run.model, 7) + " was crushed: its stable step fell to 20 % of the first one at t = 2e-05 s");
}

TEST_CASE("what stopped the run counts") {
  Spoilt s;
  const auto verdict_after = [&](const char* stop) {
    s.summary.stop_reason = stop;
    return s.verdict();
  };
  CHECK(verdict_after("end_time") == "good");
  CHECK(verdict_after("interrupted") == "doubtful");
  CHECK(verdict_after("numerical") == "bad");
  CHECK(verdict_after("disk") == "bad");
}

TEST_CASE("reasons that are there stay, in front") {
  Spoilt s;
  s.summary.reasons = {"the disk is full"};
  s.summary.stop_reason = "disk";
  s.summary.energy_error = 1;
  judge(s.run.model, s.run.state, s.summary);
  REQUIRE(s.summary.reasons.size() == 2);
  CHECK(s.summary.reasons[0] == "the disk is full");
}

TEST_CASE("the summary says what the state says") {
  WatchedRun run(falling_block());
  run.run([] {});
  const Summary s = summarise(run.model, run.state);
  CHECK(s.elements == 64);
  CHECK(s.nodes == 45);
  CHECK(s.steps == static_cast<long long>(run.state.clock.step));
  CHECK(s.end_time == doctest::Approx(60e-6).epsilon(1e-15));
  CHECK(s.masses.at("block") == doctest::Approx(0.04 * 0.02 * 0.01 * 7850));
  CHECK(s.energy_error == run.state.ledger.energy_error());
  CHECK(s.energy_error < 0.01);
  CHECK(s.identity_error < 1e-12);
  CHECK(s.momentum_error < 1e-12);
  const LedgerSummary& l = s.ledger;
  CHECK(l.start + l.gravity + l.loads + l.supports + l.obstacles == doctest::Approx(l.total - l.error).epsilon(1e-12));
  // Steps of several yield strains: what flows is booked with the stress at the end of the step.
  CHECK(std::fabs(l.stored_elastic - l.elastic) <= 0.03 * l.start);
  CHECK(s.momentum.start.y == doctest::Approx(-80 * s.masses.at("block")));
  CHECK(s.momentum.end.y == doctest::Approx(s.momentum.start.y + s.momentum.obstacles.y + s.momentum.gravity.y));
  CHECK(s.time_step.min <= s.time_step.max);
  CHECK(s.time_step.limited_by.starts_with("block element "));
  CHECK(std::isnan(s.time_step.first_shortened));
}

TEST_CASE("a body at rest under pushes that balance has closed momentum books") {
  Case input = falling_block();
  input.run.gravity = {};
  input.bodies[0].velocity = {};
  input.obstacles.clear();
  for (const char* side : {"left", "right", "top", "bottom"}) {
    input.loads.push_back(
        {.name = side, .kind = LoadCase::Kind::pressure, .where = {.body = "block", .side = side}, .pressure = 1e8});
  }
  WatchedRun run(input);
  run.run([] {});
  Summary s = summarise(run.model, run.state);
  judge(run.model, run.state, s);
  CHECK(s.momentum_error < 1e-12);
  CHECK(s.verdict == "good");
}

}  // namespace udar

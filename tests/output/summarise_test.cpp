#include "udar/output/summarise.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

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

TEST_CASE("nodes that sink in by more than 5 % of an element are told, with a cure, and no more") {
  Spoilt s;
  s.summary.penetration_ratio = 0.05;
  CHECK(s.verdict() == "good");
  CHECK(s.reason().empty());
  s.summary.penetration_ratio = 0.062;
  CHECK(s.verdict() == "good");
  CHECK(contains(s.reason(), "6.2 %"));
  CHECK(contains(s.reason(), "stiffness"));
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

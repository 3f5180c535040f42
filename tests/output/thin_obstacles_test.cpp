#include "udar/output/thin_obstacles.hpp"

#include <doctest/doctest.h>

#include "tests/output/watched_run.hpp"
#include "tests/simulation/example.hpp"
#include "udar/output/summarise.hpp"

namespace udar {
namespace {

/// The block, with a velocity along y, in front of a plate.
Case block_and_plate(double speed, double thickness) {
  Case c = falling_block();
  c.run.gravity = {};
  c.run.stop_at_energy_error = 1;
  c.bodies[0].velocity = {0, speed};
  c.obstacles[0].shape = Rectangle{.at = {-0.1, -0.002 - thickness}, .size = {0.2, thickness}};
  return c;
}

/// A rigid block on its way to where the plate is and beyond: one with elements would be torn at the highest speeds.
Case on_its_way(Case c, double way) {
  c.bodies[0].rigid = true;
  c.run.end_time = way / length(c.bodies[0].velocity - c.obstacles[0].velocity);
  c.observed_elements.clear();
  c.observed_regions.clear();
  return c;
}

/// What was to be expected, what happened, and what the verdict is.
struct Told {
  explicit Told(const Case& c) : run(c), expected(obstacles_too_thin(run.model, run.state)) {
    run.run([] {});
    reasons = obstacles_sunk_through(run.model, run.state);
    Summary summary = summarise(run.model, run.state);
    judge(run.model, run.state, summary);
    verdict = summary.verdict;
  }
  WatchedRun run;
  std::vector<Diagnostic> expected;
  std::vector<std::string> reasons;
  std::string verdict;
};

bool says(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("an obstacle that keeps a body back is thick enough") {
  const Told told(block_and_plate(-80, 0.02));
  CHECK(told.run.state.sunk[0].depth > 0);
  CHECK(told.run.state.sunk[0].depth < 0.001);
  CHECK(told.expected.empty());
  CHECK(told.reasons.empty());
}

TEST_CASE("a body that sinks beyond the middle of a plate is told") {
  const Told told(block_and_plate(-400, 0.0005));
  CHECK(told.expected.size() == 1);
  REQUIRE(told.reasons.size() == 1);
  CHECK(says(told.reasons[0], "sank by"));
  CHECK(says(told.reasons[0], "deeper than 0.00025 m"));
  CHECK(told.verdict != "good");
}

TEST_CASE("a body that passes a plate between two steps is told, whichever of them moves") {
  const Case moving_body = block_and_plate(-1e6, 0.001);
  Case moving_plate = block_and_plate(0, 0.001);
  moving_plate.obstacles[0].velocity = {0, 1e6};
  for (const Case& c : {moving_body, moving_plate}) {
    const Told told(on_its_way(c, 0.03));
    CHECK(told.run.state.sunk[0].depth == told.run.model.obstacles[0].inner_radius);
    REQUIRE(told.reasons.size() == 1);
    CHECK(says(told.reasons[0], "passed through obstacle `stop` in one step"));
    CHECK(told.verdict == "doubtful");
    REQUIRE(told.expected.size() == 1);
    CHECK(says(told.expected[0].message, "1e+06 m/s"));
  }
}

TEST_CASE("a body that passes beside a plate, however fast, is no matter") {
  Case c = block_and_plate(-1e6, 0.001);
  c.obstacles[0].shape = Rectangle{.at = {0.021, -0.003}, .size = {0.2, 0.001}};
  const Told told(on_its_way(c, 0.03));
  CHECK(told.run.state.sunk[0].depth == 0);
  CHECK(told.reasons.empty());
  CHECK(told.verdict == "good");
}

}  // namespace udar

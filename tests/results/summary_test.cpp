#include "udar/results/summary.hpp"

#include <doctest/doctest.h>
#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/results/scratch.hpp"

using namespace udar;

namespace {

Summary example() {
  Summary s;
  s.version = "0.1.0";
  s.case_name = "a \"short\" beam";
  s.elements = 12800;
  s.steps = 31250;
  s.end_time = 0.1 + 0.2;
  s.energy_error = 4e-5 / 3;
  s.verdict = "good";
  s.reasons = {"one", "two"};
  s.warnings = {"deep"};
  s.deepest_penetration = {
      .depth = 1e-4, .time = 2e-5, .place = {0.1, 0.2}, .body = "beam", .into = "stop", .stiffness = 1e9};
  s.stop_reason = "end_time";
  s.masses["beam"] = 3.14;
  s.bodies = {{.name = "beam", .rigid = false, .elements = 12800, .nodes = 6601}, {.name = "anvil", .rigid = true}};
  s.obstacles = {"stop", "wall"};
  s.observed["corner"] = {.on = "node", .body = "beam", .number = 80};
  s.observed["top"] = {.on = "element", .body = "beam", .number = 6720};
  s.started = "2025-07-01T12:34:56Z";
  s.machine = {.processor = "a processor", .threads = 16};
  s.ledger.kinetic = 1.0 / 3;
  s.momentum.start = {0, -251.2};
  s.time_step.limited_by = "beam element 1873";
  s.histories["corner"]["displacement_y"] = {.min = -0.0418, .max = 0, .max_abs = 0.0418, .last = -0.04};
  ContactSummary& stop = s.contacts["stop"];
  stop.first_touch = 0;
  stop.impulse = {1, 2};
  stop.episodes = {{.first_touch = 0,
                    .velocity_before = {0, -80},
                    .tangential_restitution = -0.25,
                    .slip_velocity_before = -8,
                    .slip_velocity_after = -2,
                    .spin_before = {{"beam", 0}},
                    .spin_after = {{"beam", 1.0 / 3}}},
                   {.first_touch = 1e-3, .spin_before = {}, .spin_after = {}}};
  return s;
}

}  // namespace

TEST_CASE("a summary reads back equal") {
  const Scratch folder;
  const Summary written = example();
  write_summary(folder / "summary.json", written);
  const Summary read = read_summary(folder / "summary.json");
  CHECK(to_json(read) == to_json(written));
  CHECK(read.end_time == written.end_time);
  CHECK(read.energy_error == written.energy_error);
  CHECK(read.histories.at("corner").at("displacement_y").min == -0.0418);
  CHECK(read.contacts.at("stop").episodes.at(0).velocity_before == Vec2{0, -80});
  CHECK(read.contacts.at("stop").episodes.at(0).tangential_restitution == -0.25);
  CHECK(read.contacts.at("stop").episodes.at(0).slip_velocity_before == -8);
  CHECK(read.contacts.at("stop").episodes.at(0).slip_velocity_after == -2);
  CHECK(read.contacts.at("stop").episodes.at(0).spin_after.at("beam") == 1.0 / 3);
  CHECK(std::isnan(read.contacts.at("stop").episodes.at(1).tangential_restitution));
  CHECK(read.contacts.at("stop").episodes.at(1).spin_after.empty());
  CHECK(read.reasons.size() == 2);
  REQUIRE(read.bodies.size() == 2);
  CHECK(read.bodies[0].elements == 12800);
  CHECK(read.bodies[0].nodes == 6601);
  CHECK(read.bodies[1].name == "anvil");
  CHECK(read.bodies[1].rigid);
  CHECK(read.obstacles == std::vector<std::string>{"stop", "wall"});
  CHECK(read.observed.at("corner").on == "node");
  CHECK(read.observed.at("top").body == "beam");
  CHECK(read.observed.at("top").number == 6720);
  CHECK(read.started == written.started);
  CHECK(read.machine.processor == "a processor");
  CHECK(read.machine.threads == 16);
  CHECK(read.warnings == std::vector<std::string>{"deep"});
  CHECK(read.deepest_penetration.place == Vec2{0.1, 0.2});
  CHECK(read.deepest_penetration.into == "stop");
}

TEST_CASE("the names that scripts rely on") {
  const auto json = nlohmann::json::parse(to_json(example()));
  CHECK(json.at("schema") == 1);
  for (const char* name : {"started",
                           "machine",
                           "bodies",
                           "obstacles",
                           "observed",
                           "elements",
                           "nodes",
                           "steps",
                           "threads",
                           "wall_seconds",
                           "stepping_seconds",
                           "element_steps_per_second",
                           "end_time",
                           "energy_error",
                           "momentum_error",
                           "spin_error",
                           "spin",
                           "penetration_ratio",
                           "deepest_penetration",
                           "verdict",
                           "reasons",
                           "warnings",
                           "stop_reason"}) {
    CHECK(json.contains(name));
  }
  for (const char* name : {"min", "max", "max_abs", "last"}) {
    CHECK(json.at("histories").at("corner").at("displacement_y").contains(name));
  }
  for (const char* name : {"first_touch", "last_separation", "duration", "duration_99", "impulse", "peak_force"}) {
    CHECK(json.at("contacts").at("stop").contains(name));
  }
  CHECK(json.at("contacts").at("stop").at("episodes").size() == 2);
  for (const char* name : {"first_touch", "separation", "duration", "impulse", "peak_force", "velocity_before",
                           "velocity_after", "restitution", "tangential_restitution", "slip_velocity_before",
                           "slip_velocity_after", "spin_before", "spin_after"}) {
    CHECK(json.at("contacts").at("stop").at("episodes").at(0).contains(name));
  }
}

TEST_CASE("numbers that are none become null and come back as NaN") {
  Summary s = example();
  s.energy_error = std::numeric_limits<double>::infinity();
  s.momentum_error = no_number;
  const std::string text = to_json(s);
  CHECK(nlohmann::json::parse(text).at("energy_error").is_null());
  CHECK(std::isnan(summary_from_json(text).momentum_error));
}

TEST_CASE("a name that is not UTF-8 does not stop the summary") {
  Summary s = example();
  s.case_name = "caf\xe9";
  CHECK_NOTHROW(summary_from_json(to_json(s)));
}

TEST_CASE("what is not a summary is refused") {
  for (const char* text :
       {"", "{", "[]", "{}", "{\"schema\": 2}", "{\"schema\": 1, \"steps\": \"many\"}",
        "{\"schema\": 1, \"histories\": {\"a\": 3}}", "{\"schema\": 1, \"momentum\": {\"start\": [1]}}"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(summary_from_json(text), OutputError);
  }
}

TEST_CASE("a count that is not whole or that no integer holds is refused, with its place") {
  const std::string text = to_json(example());
  const std::string steps = fmt::format("\"steps\": {}", example().steps);
  const std::size_t at = text.find(steps);
  REQUIRE(at != std::string::npos);
  for (const char* value : {"1e75", "2.5", "-1e300", "18446744073709551615", "1e999", "\"3\"", "null"}) {
    CAPTURE(value);
    std::string changed = text;
    changed.replace(at, steps.size(), fmt::format("\"steps\": {}", value));
    std::string said;
    try {
      summary_from_json(changed);
    } catch (const OutputError& error) {
      said = error.what();
    }
    CHECK(said.find(std::string(value) == "1e999" ? "not a summary" : "steps: ") != std::string::npos);
  }
}

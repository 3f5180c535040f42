// A run that is stopped and taken up again, on any number of threads, leaves the same bits as one that never was.

#include <doctest/doctest.h>

#include <filesystem>
#include <map>

#include "tests/results/folder_content.hpp"
#include "tests/results/scratch.hpp"
#include "tests/simulation/example.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/simulation/checkpoint.hpp"
#include "udar/simulation/simulation.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

/// Every file below `folder` with its bytes, but for what tells of the clock.
std::map<std::string, std::string> results_of(const fs::path& folder) {
  std::map<std::string, std::string> all = content_of(folder);
  all.erase(std::string(RunFolder::log));
  std::string& summary = all.at(std::string(RunFolder::summary));
  Summary s = summary_from_json(summary);
  s.started = "";
  s.threads = s.resumed = 0;
  s.wall_seconds = s.stepping_seconds = s.element_steps_per_second = 0;
  summary = to_json(s);
  return all;
}

/// Names of files of which one is not as in the other folder.
std::string differences(const fs::path& whole, const fs::path& part) {
  const auto a = results_of(whole);
  const auto b = results_of(part);
  std::string names;
  for (const auto& [name, bytes] : a) {
    if (!b.contains(name) || b.at(name) != bytes) names += name + " ";
  }
  for (const auto& [name, bytes] : b) {
    if (!a.contains(name)) names += name + " (left over) ";
  }
  return names;
}

/// Interrupts itself after `steps` steps of its own.
RunOptions options_for(const fs::path& folder, int threads, std::uint64_t steps) {
  RunOptions options{.folder = folder, .threads = threads, .case_name = "a"};
  options.interrupted = [left = steps]() mutable { return left-- == 0; };
  return options;
}

constexpr std::uint64_t never = 1000000;

/// Runs a case whole and in parts of `steps` steps, and compares.
void check_parts(const Case& input, std::initializer_list<std::uint64_t> steps) {
  const Scratch scratch;
  Simulation whole(input);
  REQUIRE(whole.run(options_for(scratch / "whole", 1, never)).stop_reason == "end_time");
  int threads = 2;
  REQUIRE(Simulation(input).run(options_for(scratch / "part", threads, *steps.begin())).stop_reason == "interrupted");
  for (auto next = steps.begin() + 1; next <= steps.end(); ++next) {
    const bool last = next == steps.end();
    threads = threads % 4 + 1;
    std::vector<std::string> notes;
    Checkpoint checkpoint = newest_checkpoint(scratch / "part", notes);
    CHECK(notes.empty());
    Simulation part(read_case(checkpoint.run.case_text, "resolved.toml"));
    RunOptions options = options_for(scratch / "part", threads, last ? never : *next);
    options.resume = &checkpoint;
    const Summary summary = part.run(options);
    CHECK(summary.stop_reason == (last ? "end_time" : "interrupted"));
    CHECK(summary.resumed == next - steps.begin());
    if (last) CHECK(hash_of(part.state()) == hash_of(whole.state()));
  }
  CHECK(differences(scratch / "whole", scratch / "part") == "");
}

Case shipped(const std::string& name, std::vector<std::string> changes) {
  changes.emplace_back("output.report=false");
  return load_case(fs::path(UDAR_SOURCE_DIR) / "cases" / name / (name + ".toml"), changes);
}

Case block_with_frames() {
  Case input = falling_block();
  input.output = {.fields_every = 5e-6, .fields_at = {1.7e-6, 33e-6}, .histories_every = 1e-6};
  return input;
}

}  // namespace

TEST_CASE("resume: a block that falls, flows and rubs") { check_parts(block_with_frames(), {1, 10, 25, 3, 0, 20}); }

TEST_CASE("resume: every integrator") {
  for (const Integrator integrator : {Integrator::adams, Integrator::adams2, Integrator::adams2_new_velocity}) {
    CAPTURE(integrator_words[static_cast<std::size_t>(integrator)]);
    Case input = block_with_frames();
    input.run.integrator = integrator;
    input.run.time_step = 1e-7;  // a fifth of the limit
    if (integrator != Integrator::adams) input.run.when_unstable = WhenUnstable::carry_on;
    input.run.end_time = 20e-6;
    check_parts(input, {1, 2, 3, 40});
  }
}

TEST_CASE("resume: fixed steps, damping, supports, loads") {
  Case input = block_with_frames();
  input.run.time_step = 4.6e-7;  // above the limit later on: shortened
  input.run.damping = {.rate = 1000};
  input.supports = {
      {.name = "left",
       .nodes = {.body = "block", .side = "left"},
       .move_y = TimeTable{.times = {0, 60e-6}, .values = {0, -4e-3}, .shape = TimeTable::Shape::smooth}}};
  input.loads = {{.name = "wind",
                  .kind = LoadCase::Kind::pressure,
                  .where = {.body = "block", .side = "right"},
                  .pressure = 1e8,
                  .factor = {.times = {0, 30e-6}, .values = {0, 1}}}};
  check_parts(input, {7, 19, 30});
}

TEST_CASE("resume: bodies that touch each other and themselves, rigid ones, corners, ties, a moving obstacle") {
  check_parts(shipped("two-plates", {"run.end_time=0.3 ms", "output.fields_every=50 us"}), {100, 150, 200});
  check_parts(shipped("ring-crush", {"run.end_time=0.2 ms", "output.fields_every=50 us"}), {100, 300});
  check_parts(shipped("hammer", {"run.end_time=80 us", "output.fields_every=20 us"}), {50, 200});
  check_parts(shipped("wedge", {"run.end_time=40 us", "output.fields_every=20 us"}), {30, 300});
  check_parts(shipped("stack", {"run.end_time=2 ms", "output.fields_every=1 ms"}), {30, 100});
}

TEST_CASE("resume: a checkpoint of other histories or another case is refused") {
  const Scratch scratch;
  const Case input = block_with_frames();
  Simulation(input).run(options_for(scratch / "part", 1, 20));
  std::vector<std::string> notes;
  Checkpoint checkpoint = newest_checkpoint(scratch / "part", notes);
  const auto refusal = [&](const Case& other) {
    return message_of<UserError>([&] {
      RunOptions options = options_for(scratch / "part", 1, never);
      options.resume = &checkpoint;
      Simulation(other).run(options);
    });
  };
  CHECK(contains(refusal(falling_block(0.01)), "does not fit the case"));
  Case watched = input;
  watched.observed_nodes.push_back({.name = "more", .body = "block", .at = {0, 0}});
  CHECK(refusal(watched) != "");
  fs::resize_file(scratch / "part" / RunFolder::histories / "energy.csv", 100);
  CHECK(contains(refusal(input), "energy.csv: it is shorter than it was"));
}

TEST_CASE("resume: the older generation is there when the newer one is damaged") {
  const Scratch scratch;
  Case input = block_with_frames();
  input.output.checkpoint = 1e-9;  // after every step
  Simulation(input).run(options_for(scratch / "part", 1, 20));
  std::vector<std::string> notes;
  const std::uint64_t newest = newest_checkpoint(scratch / "part", notes).run.steps;
  const std::size_t generation = newest_checkpoint(scratch / "part", notes).generation;
  fs::resize_file(scratch / "part" / RunFolder::checkpoints[generation], 1000);
  CHECK(newest_checkpoint(scratch / "part", notes).run.steps + 1 == newest);
  REQUIRE(notes.size() == 1);
  CHECK(contains(notes[0], "cannot be used: it was cut off"));
  fs::resize_file(scratch / "part" / RunFolder::checkpoints[1 - generation], 0);
  const std::string none = message_of<UserError>([&] { newest_checkpoint(scratch / "part", notes); });
  CHECK(contains(none, "there is no checkpoint"));
  CHECK(contains(none, "udar run"));
}

TEST_CASE("resume: a case that wants no checkpoints gets none") {
  const Scratch scratch;
  Case input = falling_block();
  input.output.checkpoint.reset();
  CHECK(Simulation(input).run(options_for(scratch / "run", 1, 20)).stop_reason == "interrupted");
  for (const std::string_view name : RunFolder::checkpoints) CHECK(!fs::exists(scratch / "run" / name));
}

TEST_CASE("run folder: two runs at once are refused") {
  const Scratch scratch;
  const RunFolder first = create_run_folder(scratch / "run", false);
  CHECK(contains(message_of<UserError>([&] { create_run_folder(scratch / "run", true); }), "is under way"));
  CHECK(contains(message_of<UserError>([&] { reopen_run_folder(scratch / "run"); }), "is under way"));
}

}  // namespace udar

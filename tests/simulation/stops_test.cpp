// Runs that do not reach their end, and folders that refuse: what is left is whole.

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <thread>

#include "tests/results/folder_content.hpp"
#include "tests/results/scratch.hpp"
#include "tests/simulation/example.hpp"
#include "udar/results/file.hpp"
#include "udar/results/histories.hpp"
#include "udar/results/pvd.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/results/vtu.hpp"
#include "udar/simulation/simulation.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

bool all_finite(const State& state) {
  bool finite = true;
  for_each_field(state, [&](const char*, const auto& field) {
    if constexpr (requires { field.size(); }) {
      using Value = typename std::decay_t<decltype(field)>::value_type;
      if constexpr (std::is_same_v<Value, double>) {
        for (const double v : field) finite = finite && std::isfinite(v);
      } else if constexpr (std::is_same_v<Value, Vec2>) {
        for (const Vec2 v : field) finite = finite && std::isfinite(v.x) && std::isfinite(v.y);
      }
    }
  });
  for (const NodeRecord& r : state.nodes) finite = finite && std::isfinite(r.x) && std::isfinite(r.vy);
  return finite && std::isfinite(state.ledger.energy_balance());
}

/// A run folder that holds everything up to where `state` stands.
void check_whole(const fs::path& folder, const Summary& told, const State& state) {
  for (const std::string_view name :
       {RunFolder::given_case, RunFolder::resolved_case, RunFolder::version, RunFolder::summary, RunFolder::log,
        RunFolder::setup_picture, RunFolder::final_picture, RunFolder::fields_index}) {
    CAPTURE(name);
    CHECK(fs::is_regular_file(folder / name));
  }
  const Summary s = read_summary(folder / RunFolder::summary);
  CHECK(to_json(s) == to_json(told));
  CHECK(s.end_time == state.clock.time.value());
  CHECK(s.steps == static_cast<long long>(state.clock.step));
  CHECK(contains(read_file(folder / RunFolder::log, 1 << 20), "stopped by: " + told.stop_reason));
  for (const auto& observer : s.histories) {
    CAPTURE(observer.first);
    const History history = read_csv(folder / RunFolder::histories / (observer.first + ".csv"));
    CHECK(history.at("time").back() == s.end_time);
    for (const auto& [quantity, extremes] : observer.second) CHECK(history.at(quantity).back() == extremes.last);
  }
  const auto index = read_pvd(folder / RunFolder::fields_index);
  REQUIRE_FALSE(index.empty());
  CHECK(index.back().time == s.end_time);
  for (const PvdEntry& entry : index) CHECK(read_vtu(folder / entry.file).time == entry.time);
}

/// Becomes unstable: never stable, and with the elements' own frequency times the step near 1.
Case growing_block() {
  Case c = falling_block();
  c.run.integrator = Integrator::adams2;
  c.run.time_step = 6e-7;
  c.run.when_unstable = WhenUnstable::carry_on;
  c.run.end_time = 1e-3;
  c.materials[0].law = Elastic{.young_modulus = 196e9, .poisson_ratio = 0.25};
  c.output.fields_every = 20e-6;
  return c;
}

/// A fixed step just below the stable limit, which falls when the block strikes.
Case tight_block(WhenUnstable what) {
  Case c = falling_block();
  c.run.time_step = 4e-7;
  c.run.when_unstable = what;
  c.output.fields_every = 20e-6;
  const double limit = [&] {
    Simulation simulation(c);
    c.run.end_time = 1e-9;
    double found = 0;
    simulation.observe([&](const Model&, const State& state) {
      if (state.clock.step == 0) found = state.clock.limit.size;
    });
    simulation.run();
    return found;
  }();
  c.run.end_time = 60e-6;
  c.run.time_step = 0.999 * limit;
  return c;
}

}  // namespace

TEST_CASE("to the end: everything is there") {
  const Scratch folder;
  Case input = falling_block();
  input.output.fields_every = 30e-6;
  Simulation simulation(input);
  const Summary s = simulation.run({.folder = folder / "run", .case_name = "block", .command = "udar run block.toml"});
  CHECK(s.stop_reason == "end_time");
  CHECK(s.end_time == doctest::Approx(60e-6).epsilon(1e-15));
  CHECK(s.case_name == "block");
  CHECK(s.element_steps_per_second > 0);
  check_whole(folder / "run", s, simulation.state());
  CHECK(contains(read_file(folder / "run/log.txt", 1 << 20), "udar run block.toml"));
  CHECK(read_file(folder / "run/version.txt", 1 << 20) == version_text() + "\n");
}

TEST_CASE("a numerical failure leaves a whole folder with the last good state") {
  const Scratch folder;
  Simulation simulation(growing_block());
  std::uint64_t steps = 0;
  std::uint64_t hash = 0;
  simulation.observe([&](const Model&, const State& state) {
    steps = state.clock.step;
    hash = hash_of(state);
  });
  const Summary s = simulation.run({.folder = folder / "run"});
  CHECK(s.stop_reason == "numerical");
  CHECK(s.verdict == "bad");
  CHECK(s.end_time < 1e-3);
  REQUIRE_FALSE(s.reasons.empty());
  CHECK(contains(s.reasons[0], "of body `block`"));
  CHECK(contains(s.reasons[0], "(step " + std::to_string(steps + 1) + ", "));
  CHECK(contains(s.reasons[0], "Likely cause"));
  CHECK(contains(s.reasons[0], "Cure"));
  CHECK(simulation.state().clock.step == steps);
  CHECK(hash_of(simulation.state()) == hash);
  CHECK(all_finite(simulation.state()));
  check_whole(folder / "run", s, simulation.state());
  // The picture marks what the message names.
  const std::string words = s.reasons[0].substr(0, s.reasons[0].find(" of body"));
  CHECK(contains(read_file(folder / "run/final.svg", 1 << 24), "failed: block " + words));
}

TEST_CASE("without a folder a failure is told the same way") {
  const Summary s = Simulation(growing_block()).run({.threads = 2});
  CHECK(s.stop_reason == "numerical");
  CHECK(s.verdict == "bad");
}

TEST_CASE("when_unstable = shorten: counted, with the first time and element") {
  const Summary s = Simulation(tight_block(WhenUnstable::shorten)).run();
  CHECK(s.stop_reason == "end_time");
  CHECK(s.time_step.shortened_steps > 0);
  CHECK(s.time_step.first_shortened > 0);
  CHECK(s.time_step.first_shortened_by.starts_with("block element "));
  CHECK(s.time_step.min < s.time_step.max);
  bool told = false;
  for (const std::string& reason : s.reasons) told = told || contains(reason, "was shortened in");
  CHECK(told);
}

TEST_CASE("when_unstable = stop: a numerical stop") {
  const Scratch folder;
  Simulation simulation(tight_block(WhenUnstable::stop));
  const Summary s = simulation.run({.folder = folder / "run"});
  CHECK(s.stop_reason == "numerical");
  CHECK(contains(s.reasons.at(0), "the stable limit fell to"));
  CHECK(contains(s.reasons.at(0), "when_unstable"));
  CHECK(s.steps > 0);
  CHECK(all_finite(simulation.state()));
  check_whole(folder / "run", s, simulation.state());
}

TEST_CASE("when_unstable = continue: the step stays, the verdict is never good") {
  const Summary s = Simulation(tight_block(WhenUnstable::carry_on)).run();
  CHECK(s.verdict != "good");
  CHECK(s.time_step.shortened_steps > 0);
}

TEST_CASE("when_unstable = continue: the step is what is blamed for a failure") {
  Case input = tight_block(WhenUnstable::carry_on);
  input.bodies[0].velocity = {0, -500};
  const Summary s = Simulation(input).run();
  REQUIRE(s.stop_reason == "numerical");
  CHECK(contains(s.reasons.at(0), "times the stable limit, which when_unstable = \"continue\" lets it"));
}

TEST_CASE("a fixed step above the limit at the start is refused, whatever comes later") {
  for (const WhenUnstable what : {WhenUnstable::shorten, WhenUnstable::stop, WhenUnstable::carry_on}) {
    Case input = falling_block();
    input.run.time_step = 1e-5;
    input.run.when_unstable = what;
    const Scratch folder;
    Simulation simulation(input);
    const std::string message = message_of<UserError>([&] { simulation.run({.folder = folder / "run"}); });
    CHECK(contains(message, "time_step = 1e-05 s is above the stable limit"));
    CHECK_FALSE(fs::exists(folder / "run"));
  }
}

TEST_CASE("an interrupted run leaves a whole folder") {
  const Scratch folder;
  Case input = falling_block();
  input.output.fields_every = 20e-6;
  Simulation simulation(input);
  std::uint64_t steps = 0;
  simulation.observe([&](const Model&, const State& state) { steps = state.clock.step; });
  const Summary s = simulation.run({.folder = folder / "run", .interrupted = [&] { return steps == 17; }});
  CHECK(s.stop_reason == "interrupted");
  CHECK(s.steps == 17);
  CHECK(s.verdict != "good");
  CHECK(contains(s.reasons.at(0), "interrupted"));
  check_whole(folder / "run", s, simulation.state());
}

TEST_CASE("interrupted before the first step") {
  const Scratch folder;
  Case input = falling_block();
  input.output.fields_at = {0};
  Simulation simulation(input);
  const Summary s = simulation.run({.folder = folder / "run", .interrupted = [] { return true; }});
  CHECK(s.steps == 0);
  check_whole(folder / "run", s, simulation.state());
}

TEST_CASE("an interruption that comes when all is done is none") {
  Simulation simulation(falling_block());
  bool done = false;
  simulation.observe([&](const Model& model, const State& state) { done = finished(model, state); });
  CHECK(simulation.run({.interrupted = [&] { return done; }}).stop_reason == "end_time");
}

TEST_CASE("a disk that refuses in mid-run: told, and everything else is written") {
  const Scratch folder;
  Case input = falling_block();
  input.output.fields_every = 20e-6;
  input.run.end_time = 2e-3;
  Simulation simulation(input);
  simulation.observe([&](const Model&, const State& state) {
    if (state.clock.step != 10) return;
    // Not while the first frame is on its way.
    while (!fs::exists(folder / "run/fields.pvd")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    fs::remove_all(folder / "run/fields");
  });
  const Summary s = simulation.run({.folder = folder / "run"});
  CHECK(s.stop_reason == "disk");
  CHECK(s.verdict == "bad");
  CHECK(contains(s.reasons.at(0), "fields/bodies_000001.vtu"));
  CHECK(s.end_time < 1e-3);  // a thread of its own writes frames: the run is some steps ahead
  CHECK(to_json(read_summary(folder / "run/summary.json")) == to_json(s));
  CHECK(read_csv(folder / "run/histories/corner.csv").at("time").back() == s.end_time);
  CHECK(fs::exists(folder / "run/final.svg"));
}

TEST_CASE("a disk that refuses at the very end: the summary comes back and says so") {
  const Scratch folder;
  Simulation simulation(falling_block());
  simulation.observe([&](const Model& model, const State& state) {
    if (finished(model, state)) fs::create_directory(folder / "run/summary.json");
  });
  const Summary s = simulation.run({.folder = folder / "run"});
  CHECK(s.stop_reason == "disk");
  CHECK(contains(s.reasons.at(0), "summary.json"));
}

TEST_CASE("a folder that is taken is refused, and nothing in it changes") {
  const Scratch folder;
  Simulation simulation(falling_block());
  simulation.run({.folder = folder / "run"});
  const auto before = content_of(folder.path);
  CHECK_THROWS_AS(simulation.run({.folder = folder / "run"}), UserError);
  CHECK(content_of(folder.path) == before);

  fs::create_directory(folder / "mine");
  write_file(folder / "mine/thesis.tex", "years of work");
  const auto mine = content_of(folder / "mine");
  for (const bool force : {false, true}) {
    CHECK_THROWS_AS(simulation.run({.folder = folder / "mine", .force = force}), UserError);
  }
  CHECK(content_of(folder / "mine") == mine);
}

TEST_CASE("force replaces an earlier run wholly, and leaves other files") {
  const Scratch folder;
  Case with_frames = falling_block();
  with_frames.output.fields_every = 20e-6;
  Simulation(with_frames).run({.folder = folder / "run"});
  write_file(folder / "run/notes.txt", "mine");
  Simulation simulation(falling_block());
  const Summary s = simulation.run({.folder = folder / "run", .force = true});
  CHECK(to_json(read_summary(folder / "run/summary.json")) == to_json(s));
  CHECK_FALSE(fs::exists(folder / "run/fields.pvd"));
  CHECK(fs::is_empty(folder / "run/fields"));
  CHECK(read_file(folder / "run/notes.txt", 100) == "mine");
}

TEST_CASE("a folder that cannot be made stops the run before it begins") {
  const Scratch folder;
  write_file(folder / "file", "");
  Simulation simulation(falling_block());
  bool looked = false;
  simulation.observe([&](const Model&, const State&) { looked = true; });
  CHECK_THROWS_AS(simulation.run({.folder = folder / "file/run"}), OutputError);
  CHECK_FALSE(looked);
}

}  // namespace udar

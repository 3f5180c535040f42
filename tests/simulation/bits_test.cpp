// The result of a run depends on nothing but the case.

#include <doctest/doctest.h>

#include "tests/results/scratch.hpp"
#include "tests/simulation/example.hpp"
#include "udar/case/build_model.hpp"
#include "udar/results/file.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/simulation/simulation.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

std::uint64_t hash_after(const Case& input, const RunOptions& options = {}) {
  Simulation simulation(input);
  simulation.run(options);
  return hash_of(simulation.state());
}

}  // namespace

TEST_CASE("the hash sees every bit") {
  Simulation simulation(falling_block());
  simulation.run();
  const State& state = simulation.state();
  State other = state;
  CHECK(hash_of(other) == hash_of(state));
  other.stress_xy.back() = -0.0;
  CHECK(hash_of(other) != hash_of(state));
  other = state;
  other.contacts.back().slides ^= 1U;
  CHECK(hash_of(other) != hash_of(state));
  other = state;
  other.ledger.momentum_gap = std::nextafter(state.ledger.momentum_gap, 1);
  CHECK(hash_of(other) != hash_of(state));
}

TEST_CASE("a case from a file and the same built in code give the same bits") {
  const Scratch folder;
  write_file(folder / "block.toml", falling_block_text);
  CHECK(hash_after(load_case(folder / "block.toml")) == hash_after(falling_block()));
}

TEST_CASE("what is written and how often changes no bit") {
  const Scratch folder;
  const std::uint64_t expected = hash_after(falling_block());
  int runs = 0;
  const auto with = [&](double histories_every, std::optional<double> fields_every, std::vector<double> fields_at) {
    Case input = falling_block();
    input.output = {fields_every, std::move(fields_at), histories_every};
    return hash_after(input, {.folder = folder / std::to_string(++runs)});
  };
  CHECK(with(60e-9, {}, {}) == expected);
  CHECK(with(1e-6, 20e-6, {}) == expected);
  CHECK(with(1, {}, {0, 1e-6, 33.3e-6, 60e-6}) == expected);
  CHECK(with(7.7e-6, 31e-6, {5e-6}) == expected);
}

TEST_CASE("frames never, now and then, or in every step, with any number of threads: the same bits") {
  const Scratch folder;
  Case input = falling_block(0.00125);
  input.run.end_time = 10e-6;
  const std::uint64_t expected = hash_after(input, {.threads = 1});
  int runs = 0;
  for (const int threads : {1, 2, 4}) {
    CAPTURE(threads);
    CHECK(hash_after(input, {.threads = threads}) == expected);
    for (const double every : {2e-6, 1e-10}) {
      CAPTURE(every);
      Case with_frames = input;
      with_frames.output.fields_every = every;
      CHECK(hash_after(with_frames, {.folder = folder / std::to_string(++runs), .threads = threads}) == expected);
    }
  }
}

TEST_CASE("what is observed changes no bit") {
  Case input = falling_block();
  const std::uint64_t expected = hash_after(input);
  input.observed_nodes.clear();
  input.observed_elements.clear();
  input.observed_regions.clear();
  CHECK(hash_after(input) == expected);
  Simulation simulation(input);
  std::uint64_t looks = 0;
  simulation.observe([&](const Model&, const State& state) { looks += state.clock.step == looks ? 1 : 0; });
  simulation.run();
  CHECK(looks == simulation.state().clock.step + 1);
  CHECK(hash_of(simulation.state()) == expected);
}

TEST_CASE("a simulation may be run again, with the same bits") {
  Simulation simulation(falling_block());
  simulation.run();
  const std::uint64_t first = hash_of(simulation.state());
  simulation.run();
  CHECK(hash_of(simulation.state()) == first);
}

TEST_CASE("any number of threads gives the same bits") {
  const Case input = falling_block(0.00125);  // 8 blocks of elements
  const std::uint64_t expected = hash_after(input, {.threads = 1});
  for (const int threads : {2, 3, 4, 7}) {
    CAPTURE(threads);
    CHECK(hash_after(input, {.threads = threads}) == expected);
  }
}

TEST_CASE("any instruction set gives the same bits") {
  Case input = falling_block(0.0025);
  for (const bool elastic : {false, true}) {
    CAPTURE(elastic);
    if (elastic) input.materials[0].law = Elastic{.young_modulus = 196e9, .poisson_ratio = 0.25};
    const std::uint64_t expected = hash_after(input);
    for (const char* widest : {"baseline", "avx2", "avx512"}) {
      CAPTURE(widest);
      const Environment narrower("UDAR_LANES", widest);
      CHECK(hash_after(input) == expected);
    }
  }
}

TEST_CASE("a state copied in mid-run goes on to the same bits, with any number of threads") {
  for (const Integrator kind : {Integrator::central_difference, Integrator::adams}) {
    Case input = falling_block(0.0025);
    input.run.integrator = kind;
    const Model model = build_model(input);
    Workspace one(model, 1);
    State state = start(model, one);
    while (state.clock.step < 57) step(model, state, one);
    State copy = state;
    Workspace three(model, 3);
    while (!finished(model, state)) step(model, state, one);
    while (!finished(model, copy)) step(model, copy, three);
    CHECK(hash_of(copy) == hash_of(state));
  }
}

TEST_CASE("every integrator gives the same bits for threads and instruction sets") {
  for (const Integrator kind : {Integrator::adams, Integrator::adams2, Integrator::adams2_new_velocity}) {
    Case input = falling_block(0.00125);
    input.run.integrator = kind;
    input.run.time_step = 5e-8;
    input.run.end_time = 5e-6;
    input.run.when_unstable = WhenUnstable::carry_on;
    const std::uint64_t expected = hash_after(input, {.threads = 1});
    const Environment narrower("UDAR_LANES", "baseline");
    CHECK(hash_after(input, {.threads = 3}) == expected);
  }
}

TEST_CASE("the resolved case of a run folder runs again to the same bits") {
  const Scratch folder;
  write_file(folder / "block.toml", falling_block_text);
  const std::vector<std::string> changes{"bodies.block.velocity.1=-60 m/s", "run.integrator=adams",
                                         "materials.steel.yield_stress=240.5 MPa", "obstacles.stop.friction=0.123"};
  Simulation first(load_case(folder / "block.toml", changes));
  first.run({.folder = folder / "run", .case_text = falling_block_text});
  CHECK(read_file(folder / "run/case.toml", 1 << 20) == falling_block_text);
  const Case again = load_case(folder / "run/resolved.toml");
  CHECK(hash_after(again) == hash_of(first.state()));
  CHECK(to_toml(again) == read_file(folder / "run/resolved.toml", 1 << 20));
}

TEST_CASE("a case built in code leaves a case file, too") {
  const Scratch folder;
  Simulation first(falling_block());
  first.run({.folder = folder / "run"});
  CHECK(hash_after(load_case(folder / "run/case.toml")) == hash_of(first.state()));
}

}  // namespace udar

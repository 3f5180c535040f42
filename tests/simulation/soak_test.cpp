// Runs that last: memory and open files stay what they were.

#include <doctest/doctest.h>
#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

#include "tests/results/scratch.hpp"
#include "tests/simulation/golden_cases.hpp"
#include "udar/results/pvd.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/simulation/simulation.hpp"

namespace udar {
namespace {

struct Use {
  long memory = 0;  ///< pages in memory
  long files = 0;   ///< open ones
};

/// Of this process, as Linux tells it.
Use use_now() {
  Use use;
  long virtual_pages = 0;
  std::ifstream("/proc/self/statm") >> virtual_pages >> use.memory;
  const std::filesystem::directory_iterator files("/proc/self/fd");
  use.files = static_cast<long>(std::distance(begin(files), end(files)));
  return use;
}

/// An elastic block that bounces on the floor without end, touched by damping only when it lands.
Case bouncing() {
  return {.run = {.end_time = 1, .gravity = {0, -2000}},
          .materials = {aluminium},
          .bodies = {golden::block("block", "aluminium",
                                   RectangleMesh{.size = {0.03, 0.02}, .at = {-0.015, 0.001}, .element_size = 0.01},
                                   {0, -1})},
          .obstacles = {{.name = "floor", .shape = HalfPlane{}, .friction = 0.3}},
          .observed_nodes = {{.name = "corner", .body = "block", .at = {0.015, 0.02}}}};
}

}  // namespace

TEST_CASE("soak: two million steps with frames and histories leave memory and files as they were (long)") {
  if (!std::filesystem::exists("/proc/self/statm")) return;
  const Scratch folder;
  Case input = bouncing();
  double step = 0;
  {
    Case first = input;
    first.run.end_time = 1e-6;
    Simulation probe(first);
    probe.observe([&](const Model&, const State& state) { step = 0.9 * state.clock.limit.size; });
    probe.run();
  }
  constexpr double steps = 2.2e6;
  input.run.end_time = steps * step;
  input.output.fields_every = input.run.end_time / 40;
  input.output.histories_every = input.run.end_time / 20000;
  Simulation simulation(input);
  Use early, late;
  constexpr std::uint64_t settled = 200000;
  simulation.observe([&](const Model&, const State& state) {
    if (state.clock.step == settled) early = use_now();
    if (state.clock.step == 10 * settled) late = use_now();
  });
  const Summary s = simulation.run({.folder = folder / "run", .threads = 2});
  const double growth = static_cast<double>(late.memory - early.memory) / static_cast<double>(early.memory);
  std::cout << fmt::format(
      "reliability: soak {} steps, {} frames, memory {} pages grown by {:.3g} %, files {} then {}\n", s.steps,
      read_pvd(folder / "run" / RunFolder::fields_index).size(), late.memory, 100 * growth, early.files, late.files);
  CHECK(s.stop_reason == "end_time");
  CHECK(s.steps >= 2000000);
  // A frame leaves some hundred bytes: its line of fields.pvd, which is written anew as a whole.
  CHECK(growth < 0.01);
  CHECK(late.files == early.files);
  CHECK(read_pvd(folder / "run" / RunFolder::fields_index).size() >= 40);
  CHECK(s.identity_error <= 1e-11);
  CHECK(s.momentum_error <= 1e-11);
}

}  // namespace udar

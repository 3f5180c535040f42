#include "check.hpp"

#include <fmt/core.h>

#include <cmath>

#include "run.hpp"
#include "udar/simulation/simulation.hpp"

namespace roof {
namespace {

/// The same formulas, otherwise arranged: results differ by rounding only, which an impact with flow and friction lets
/// grow a little. Seen: 1e-13. A start one step late makes 2e-4 and 1e-3; a stop without its sides, 1e-2.
constexpr double largest_difference = 1e-9;
constexpr int steps = 800;  // 0.1 ms: the beam has lost a fifth of its speed, two fifths of the elements flow

struct Outcome {
  double velocity = 0;      ///< m/s, of the centre of mass, upwards
  double plastic_work = 0;  ///< J
};

Outcome of_roof(const Settings& settings) {
  Problem p = build(settings, slots_of_lanes());
  Books books;
  run(p, steps, &books);
  double momentum = 0, whole = 0;
  for (Index i = 0; i < p.node_count; ++i) {
    momentum += mass(p, i) * p.nodes[i].vy;
    whole += mass(p, i);
  }
  return {momentum / whole, books.plastic_work};
}

Outcome of_program(double step) {
  udar::Case input = udar::load_case(UDAR_SOURCE_DIR "/cases/short-beam/short-beam.toml");
  input.run.time_step = step;
  input.run.end_time = steps * step;
  udar::Simulation simulation(std::move(input));
  simulation.run();
  const udar::State& state = simulation.state();
  return {state.body_momentum[0].y / simulation.model().bodies[0].mass, state.ledger.plastic_work.value()};
}

}  // namespace

bool check_against_program() {
  const Settings settings;
  const Outcome exact = of_program(build(settings, slots_of_lanes()).step);
  fmt::print("program:            velocity {:.15g} m/s, plastic work {:.15g} J\n", exact.velocity, exact.plastic_work);
  bool same = true;
  for (const Variant variant : {Variant::sweep, Variant::fused}) {
    for (const int threads : {1, 2, 3}) {
      const Outcome found = of_roof({settings.columns, threads, variant});
      const double velocity = std::fabs(found.velocity / exact.velocity - 1);
      const double work = std::fabs(found.plastic_work / exact.plastic_work - 1);
      fmt::print("{}, {} threads: off by {:.1e} and {:.1e}\n", variant == Variant::fused ? "fused" : "sweep", threads,
                 velocity, work);
      same = same && velocity < largest_difference && work < largest_difference;
    }
  }
  fmt::print("{}; bound {:.0e}\n", same ? "the same" : "NOT the same", largest_difference);
  return same;
}

}  // namespace roof

#include "udar/output/history_recorder.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/output/watched_run.hpp"
#include "tests/results/scratch.hpp"
#include "tests/simulation/example.hpp"
#include "udar/results/run_folder.hpp"

namespace udar {
namespace {

/// Every value of a node's displacement_y and the time it was taken.
struct Trace {
  std::vector<double> time;
  std::vector<double> value;

  [[nodiscard]] double least() const { return *std::ranges::min_element(value); }
  [[nodiscard]] double most() const { return *std::ranges::max_element(value); }
};

}  // namespace

TEST_CASE("extremes are those of every step, not of the rows") {
  Case input = falling_block();
  input.output.histories_every = 1;  // rows only at the start and the end
  WatchedRun run(input);
  HistoryRecorder recorder(run.model, std::nullopt);
  const Index corner = run.model.observed_nodes[0].node;
  Trace trace;
  run.run([&] {
    recorder.record(run.state);
    trace.time.push_back(run.time());
    trace.value.push_back(run.state.nodes[corner].y - run.model.rest[corner].y);
  });
  const auto all = recorder.summary();
  const HistorySummary& seen = all.at("corner").at("displacement_y");
  CHECK(seen.min == trace.least());
  CHECK(seen.max == trace.most());
  CHECK(seen.max_abs == std::max(std::fabs(trace.least()), std::fabs(trace.most())));
  CHECK(seen.last == trace.value.back());
  const auto at_least = std::ranges::min_element(trace.value) - trace.value.begin();
  CHECK(seen.time_of_min == trace.time[static_cast<std::size_t>(at_least)]);
  CHECK(seen.min < 0);
}

TEST_CASE("a window limits extremes and the last value, and an empty one gives none") {
  Case input = falling_block();
  const NodeObserverCase corner = input.observed_nodes[0];
  input.observed_nodes = {corner, corner, corner};
  input.observed_nodes[1].name = "early";
  input.observed_nodes[1].window = {1e-6, 5e-6};
  input.observed_nodes[2].name = "never";
  input.observed_nodes[2].window = {1, 2};
  WatchedRun run(input);
  HistoryRecorder recorder(run.model, std::nullopt);
  const Index node = run.model.observed_nodes[0].node;
  std::vector<double> inside;
  run.run([&] {
    recorder.record(run.state);
    if (run.time() >= 1e-6 && run.time() <= 5e-6) inside.push_back(run.state.nodes[node].y - run.model.rest[node].y);
  });
  REQUIRE(inside.size() > 3);
  const auto all = recorder.summary();
  const HistorySummary& early = all.at("early").at("displacement_y");
  CHECK(early.min == *std::ranges::min_element(inside));
  CHECK(early.max == *std::ranges::max_element(inside));
  CHECK(early.last == inside.back());
  CHECK(early.time_of_max >= 1e-6);
  CHECK(early.time_of_min <= 5e-6);
  CHECK(std::isnan(all.at("never").at("displacement_y").min));
  CHECK(std::isnan(all.at("never").at("displacement_y").last));
}

TEST_CASE("rows are taken at the multiples of the interval, and at the end") {
  const Scratch folder;
  Case input = falling_block();
  input.output.histories_every = 7e-6;
  WatchedRun run(input);
  HistoryRecorder recorder(run.model, folder.path);
  recorder.begin();
  std::vector<double> times;
  run.run([&] {
    recorder.record(run.state);
    times.push_back(run.time());
  });
  recorder.close(run.state);
  const History history = read_csv(folder / "corner.csv");
  CHECK(history.columns[0] == Column{"time", "s"});
  CHECK(history.columns[2] == Column{"displacement_y", "m"});
  const std::vector<double>& rows = history.at("time");
  REQUIRE(rows.size() == 10);  // 0, 7, ..., 56 us and the end
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    CAPTURE(k);
    CHECK(rows[k] == *std::ranges::lower_bound(times, 7e-6 * static_cast<double>(k)));
  }
  CHECK(rows.back() == run.time());
  const Index corner = run.model.observed_nodes[0].node;
  CHECK(history.at("displacement_y").back() == run.state.nodes[corner].y - run.model.rest[corner].y);
  CHECK(history.at("velocity_y").back() == velocity(run.state, corner).y);
}

TEST_CASE("a fixed step as long as the interval gives one row for each step, the end not twice") {
  const Scratch folder;
  Case input = falling_block();
  input.run.time_step = 0.25e-6;
  input.output.histories_every = 0.25e-6;
  WatchedRun run(input);
  HistoryRecorder recorder(run.model, folder.path);
  recorder.begin();
  run.run([&] { recorder.record(run.state); });
  recorder.close(run.state);
  recorder.close(run.state);
  CHECK(read_csv(folder / "stop.csv").at("time").size() == run.state.clock.step + 1);
}

TEST_CASE("everything is watched that the case asks for, and bodies, obstacles, supports and books besides") {
  Case input = falling_block();
  input.supports = {
      {.name = "hand", .nodes = {.body = "block", .point = Vec2{0, 0.02}}, .move_x = TimeTable::constant(0)}};
  const Model model = build_model(input);
  std::vector<std::string> names;
  for (const Observer& o : make_observers(model)) names.push_back(o.name);
  CHECK(names ==
        std::vector<std::string>{"energy", "momentum", "corner", "bottom", "left_half", "block", "stop", "hand"});
}

TEST_CASE("two things of one name do not write into one file") {
  Case input = falling_block();
  input.obstacles[0].name = "block";
  input.observed_nodes[0].name = "energy";
  const Scratch folder;
  WatchedRun run(input);
  HistoryRecorder recorder(run.model, folder.path);
  recorder.begin();
  recorder.record(run.state);
  recorder.close(run.state);
  CHECK(read_csv(folder / "energy.csv").columns[1].name == "kinetic");
  CHECK(read_csv(folder / "energy_2.csv").columns[1].name == "displacement_x");
  CHECK(read_csv(folder / "block.csv").columns[1].name == "position_x");
  CHECK(read_csv(folder / "block_2.csv").columns[1].name == "force_x");
}

TEST_CASE("the books say what the ledger says, and close") {
  WatchedRun run(falling_block());
  HistoryRecorder recorder(run.model, std::nullopt);
  run.run([&] { recorder.record(run.state); });
  const auto all = recorder.summary();
  const auto& energy = all.at("energy");
  const auto& momentum = all.at("momentum");
  const Ledger& ledger = run.state.ledger;
  CHECK(energy.at("kinetic").last == ledger.kinetic_energy);
  CHECK(energy.at("plastic").last == ledger.plastic_work.value());
  CHECK(energy.at("plastic").last > 0);
  const double in = ledger.start_energy + energy.at("gravity").last + energy.at("loads").last +
                    energy.at("supports").last + energy.at("obstacles").last;
  CHECK(energy.at("total").last == doctest::Approx(in + energy.at("error").last).epsilon(1e-12));
  CHECK(energy.at("error").max_abs == ledger.energy_gap);
  // Rounding of a hundred steps.
  const double scale = ledger.momentum_scale;
  CHECK(std::fabs(momentum.at("error_x").max_abs) <= 1e-13 * scale);
  CHECK(std::fabs(momentum.at("error_y").max_abs) <= 1e-13 * scale);
  // The whole body is its parts: its momentum at t_n differs from the ledger's at t_{n+1/2} by half a step's impulse.
  CHECK(all.at("block").at("momentum_y").last == doctest::Approx(ledger.momentum.y).epsilon(0.02));
}

TEST_CASE("stresses of an element: principal ones in order, the largest shear from them") {
  WatchedRun run(falling_block());
  const Index e = run.model.observed_elements[0].element;
  const Observer observer = observe_element(run.model, run.model.observed_elements[0]);
  State state = run.state;
  // Plane part 30 +- 50 (3-4-5 triangle), out of plane 10: 80, 10, -20.
  state.stress_xx[e] = 60;
  state.stress_yy[e] = 0;
  state.stress_xy[e] = 40;
  state.stress_zz[e] = 10;
  state.plastic_strain[e] = 0.25;
  state.flowing[e / 8] = static_cast<std::uint8_t>(1U << e % 8);
  std::vector<double> values(observer.columns.size());
  observer.measure(state, values);
  CHECK(values == std::vector<double>{60, 0, 40, 10, 80, 10, -20, 50, 0.25, 1});
}

TEST_CASE("an acceleration of a region is its change of momentum") {
  WatchedRun run(falling_block());
  const RegionObserver& region = run.model.observed_regions[0];
  const Observer observer = observe_region(run.model, region);
  CHECK(region.mass == doctest::Approx(0.5 * run.model.bodies[0].mass).epsilon(0.15));
  const auto carried = [&] {
    Vec2 sum;
    for (const Index i : region.nodes) sum += run.model.mass[i] * Vec2{run.state.nodes[i].vx, run.state.nodes[i].vy};
    return sum;
  };
  std::vector<double> values(observer.columns.size());
  Vec2 before = carried();
  bool first = true;
  run.run([&] {
    if (!first) {
      observer.measure(run.state, values);
      const double span = 0.5 * (run.state.clock.last_step + run.state.clock.next_step);
      CHECK(values[5] == doctest::Approx((carried().y - before.y) / span / region.mass).epsilon(1e-9).scale(1e6));
    }
    first = false;
    before = carried();
  });
}

}  // namespace udar

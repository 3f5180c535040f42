#include "udar/report/history_plot.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "tests/report/small_run.hpp"

using namespace udar;

namespace {

/// A run with a node, an obstacle, a body and energy.
struct PlottedRun : SmallRun {
  PlottedRun() : SmallRun({0}) {
    add_history("corner", {{"time", "s"}, {"displacement_x", "m"}, {"displacement_y", "m"}, {"velocity_x", "m/s"}},
                {{0, 0, 0, 1}, {1e-3, 0.002, -0.03, 2}, {2e-3, 0.001, -0.04, 3}});
    add_history("stop", {{"time", "s"}, {"force_x", "N"}, {"force_y", "N"}, {"touching_nodes", ""}},
                {{0, 0, 1e5, 3}, {1e-3, 0, 2e5, 4}, {2e-3, 0, 0, 0}});
    add_history("beam.a", {{"time", "s"}, {"position_x", "m"}, {"velocity_x", "m/s"}, {"velocity_y", "m/s"}},
                {{0, 0, 0, -80}, {1e-3, 0, 0, -20}, {2e-3, 0, 0, 3}});
    add_history("energy", {{"time", "s"}, {"kinetic", "J"}, {"plastic", "J"}, {"ties", "J"}, {"total", "J"}},
                {{0, 10, 0, 0, 10}, {1e-3, 2, 8, 0, 10}, {2e-3, 0, 10, 0, 10}});
  }
  [[nodiscard]] PlotRequest asks(std::vector<std::string> names) const {
    return {.runs = {folder}, .names = std::move(names)};
  }
};

std::vector<std::string> names_of(const PlotPanel& panel) {
  std::vector<std::string> names;
  for (const PlotCurve& curve : panel.curves) names.push_back(curve.name);
  return names;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("curves in one unit share a panel; plain numbers of different kinds do not") {
  const PlottedRun run;
  const Plot plot =
      history_plot(run.asks({"corner.displacement", "stop.force_y", "stop.touching_nodes", "beam.a.position_x"}));
  REQUIRE(plot.panels.size() == 3);
  CHECK(names_of(plot.panels[0]) == Names{"corner.displacement_x", "corner.displacement_y", "beam.a.position_x"});
  CHECK(plot.panels[0].unit == "m");
  CHECK(plot.panels[0].curves[1].values == std::vector<double>{0, -0.03, -0.04});
  CHECK(names_of(plot.panels[1]) == Names{"stop.force_y"});
  CHECK(plot.panels[1].caption == "force");
  CHECK(plot.from == 0);
  CHECK(plot.to == 2e-3);
}

TEST_CASE("a history alone is all its columns") {
  const PlottedRun run;
  CHECK(history_plot(run.asks({"corner"})).panels.size() == 2);
}

TEST_CASE("without names: bodies, forces, energy, nodes, and nothing that stays at zero") {
  const PlottedRun run;
  const Plot plot = history_plot(run.asks({}));
  REQUIRE(plot.panels.size() == 4);
  CHECK(names_of(plot.panels[0]) == Names{"beam.a.velocity_y"});
  CHECK(names_of(plot.panels[1]) == Names{"stop.force_y"});
  CHECK(names_of(plot.panels[2]) == Names{"energy.kinetic", "energy.plastic", "energy.total"});
  CHECK(names_of(plot.panels[3]) == Names{"corner.displacement_x", "corner.displacement_y"});
}

TEST_CASE("two runs are overlaid with their names") {
  const PlottedRun run;
  const PlottedRun other;
  std::filesystem::rename(other.folder, other.scratch / "fine");
  const Plot plot = history_plot({.runs = {run.folder, other.scratch / "fine"}, .names = {"corner.displacement_y"}});
  CHECK(names_of(plot.panels.at(0)) == Names{"small: corner.displacement_y", "fine: corner.displacement_y"});
  CHECK(plot.panels[0].curves[0].colour != plot.panels[0].curves[1].colour);
}

TEST_CASE("only the rows of the time asked for") {
  const PlottedRun run;
  PlotRequest request = run.asks({"corner.displacement_y"});
  request.from = 0.5e-3;
  CHECK(history_plot(request).panels[0].curves[0].times == std::vector<double>{1e-3, 2e-3});
  request.from = 5e-3;
  CHECK(contains(message_of<UserError>([&] { history_plot(request); }), "widen --from and --to"));
}

TEST_CASE("wrong names are told with the one that was meant") {
  const PlottedRun run;
  const auto refusal = [&](const std::string& name) {
    return message_of<UserError>([&] { history_plot(run.asks({name})); });
  };
  CHECK(contains(refusal("cornr.displacement_y"), "did you mean `corner.displacement_y`?"));
  CHECK(contains(refusal("corner.displacment_y"), "did you mean `corner.displacement_y`?"));
  CHECK(contains(refusal("corner.temperature"), "write displacement_x, displacement_y or velocity_x"));
  CHECK(contains(refusal("weather"), "write beam.a, corner, energy or stop"));
}

TEST_CASE("extremes are those of the numbers there are") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const CurveExtremes found = extremes_of({.name = "", .times = {0, 1, 2, 3}, .values = {nan, 2, -5, nan}});
  CHECK(found.any);
  CHECK(found.most == 1);
  CHECK(found.least == 2);
  CHECK(found.last == 2);
  CHECK_FALSE(extremes_of({.name = "", .times = {0}, .values = {nan}}).any);
}

TEST_CASE("the table tells largest, smallest and last values with their times; broken numbers draw nothing wrong") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  PlotCurve curve{.name = "a <b>", .times = {0, 1e-3, 1.5e-3, 2e-3}, .values = {0.01, nan, -0.0402, -0.03}};
  const Plot plot{.title = "t", .panels = {{"displacement", "m", {curve}}}, .from = 0, .to = 2e-3};
  const std::string svg = to_svg(plot);
  CHECK(contains(svg, "a &lt;b&gt;"));
  CHECK(contains(svg, "10.00 at 0 s"));
  CHECK(contains(svg, "−40.20 at 1.5 ms"));
  CHECK(contains(svg, "−30.00<"));
  CHECK(contains(svg, "displacement [mm]"));
  CHECK(contains(svg, "time [ms]"));
  CHECK_FALSE(contains(svg, "nan"));
}

TEST_CASE("a long history is thinned without losing its peaks") {
  PlotCurve curve;
  for (int i = 0; i < 200000; ++i) {
    curve.times.push_back(1e-8 * i);
    curve.values.push_back(i == 123456 ? 7 : std::sin(0.01 * i));
  }
  const Plot plot{.title = "t", .panels = {{"", "", {curve}}}, .from = 0, .to = 2e-3};
  const std::string svg = to_svg(plot);
  CHECK(svg.size() < 150000);
  // The peak of 7 lies higher than everything else: there is a segment that goes up to it.
  CHECK(contains(svg, "7.000 at 1.235 ms"));
}

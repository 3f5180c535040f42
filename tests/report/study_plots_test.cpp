#include "udar/report/study_plots.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "tests/report/decode.hpp"
#include "tests/report/small_study.hpp"
#include "udar/report/plot.hpp"

using namespace udar;

namespace {

// Of to_svg, px.
constexpr double left = 92;
constexpr double right = 972;

struct Dot {
  double x = 0;
  double y = 0;
};

/// The dots of a plot, in its order.
std::vector<Dot> dots_of(const std::string& svg) {
  std::vector<Dot> dots;
  constexpr std::string_view begin = "<circle cx=\"";
  for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at + 1)) {
    Dot dot;
    REQUIRE(std::sscanf(svg.c_str() + at, "<circle cx=\"%lf\" cy=\"%lf\"", &dot.x, &dot.y) == 2);
    dots.push_back(dot);
  }
  return dots;
}

std::string text_of(const std::filesystem::path& path) { return read_file(path, std::size_t{1} << 26); }

std::size_t count(const std::string& text, std::string_view part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

bool has(const std::vector<std::filesystem::path>& paths, std::string_view name) {
  return std::any_of(paths.begin(), paths.end(), [&](const auto& path) { return path.filename() == name; });
}

StudyQuantity quantity(std::string name, std::vector<double> values, double extrapolated) {
  StudyQuantity q{.name = std::move(name), .unit = "s", .values = std::move(values), .headline = true};
  q.mesh.extrapolated = extrapolated;
  return q;
}

}  // namespace

TEST_CASE("logarithmic axes, markers and error bars stand where they belong") {
  const PlotCurve curve{.name = "<order>",
                        .times = {1e-3, 1e-2, 1e-1},
                        .values = {1, 10, 100},
                        .markers = true,
                        .errors = {no_number, 5, 200}};
  const Plot plot{.title = "t",
                  .panels = {{.caption = "error", .unit = "%", .curves = {curve}, .logarithmic = true}},
                  .from = 1e-3,
                  .to = 1e-1,
                  .axis = {.label = "size", .unit = "m", .logarithmic = true},
                  .extremes = false};
  const std::string svg = to_svg(plot);
  const std::vector<Dot> dots = dots_of(svg);
  REQUIRE(dots.size() == 3);
  CHECK(dots[0].x == doctest::Approx(left));
  CHECK(dots[1].x == doctest::Approx(0.5 * (left + right)));
  CHECK(dots[2].x == doctest::Approx(right));
  CHECK(dots[0].y - dots[1].y == doctest::Approx(dots[1].y - dots[2].y).epsilon(0.01));
  // The bar of 10 +- 5: from log 5 to log 15.
  const double decade = dots[0].y - dots[1].y;
  CHECK(contains(svg, fmt::format("V{:.1f}M", dots[1].y + decade * std::log10(2))));
  CHECK(contains(svg, fmt::format(" {:.1f}V", dots[1].y - decade * std::log10(1.5))));
  CHECK(contains(svg, "size [mm]"));
  CHECK(contains(svg, "error [%]"));
  CHECK(contains(svg, "&lt;order&gt;"));
  CHECK_FALSE(contains(svg, "largest"));
  CHECK_FALSE(contains(svg, "nan"));
  CHECK_FALSE(contains(svg, "inf"));
}

TEST_CASE("an axis of names") {
  const PlotCurve curve{.name = "a", .times = {0, 1}, .values = {3, 5}, .markers = true};
  const Plot plot{.title = "t",
                  .panels = {{.caption = "c", .unit = "", .curves = {curve}}},
                  .from = -1,
                  .to = 2,
                  .axis = {.label = "integrator", .unit = "", .places = {0, 1}, .names = {"adams", "<b>"}},
                  .extremes = false};
  const std::string svg = to_svg(plot);
  CHECK(contains(svg, ">adams<"));
  CHECK(contains(svg, ">&lt;b&gt;<"));
  CHECK(contains(svg, ">integrator<"));
  CHECK(dots_of(svg)[0].x == doctest::Approx(left + (right - left) / 3).epsilon(1e-3));
}

TEST_CASE("histories of a study that it compares lie over each other") {
  SmallStudy s(3);
  // Second order: the errors are 1600, 400 and 100 times 1 %.
  s.study.quantities = {quantity("a.b", {17, 5, 2}, 1),
                        quantity("never", {no_number, no_number, no_number}, no_number)};
  s.write();
  std::filesystem::create_directories(s.folder / "plots");
  write_file(s.folder / "plots/of-another-study.svg", "");
  const auto paths = write_study_plots(s.folder);
  for (const auto& path : paths) CHECK(std::filesystem::exists(path));
  CHECK(has(paths, "corner.displacement_y.svg"));
  CHECK(has(paths, "stop.force_y.svg"));
  CHECK(has(paths, "block.position_y.svg"));
  CHECK(has(paths, "energy.total.svg"));
  CHECK_FALSE(has(paths, "corner.displacement_x.svg"));
  CHECK_FALSE(std::filesystem::exists(s.folder / "plots/of-another-study.svg"));
  CHECK_FALSE(has(paths, "corner.displacement_y-steps.svg"));
  const std::string svg = text_of(s.folder / "plots/corner.displacement_y.svg");
  for (const char* label : {">10 mm<", ">5 mm<", ">2.5 mm<"}) {
    CAPTURE(label);
    CHECK(count(svg, label) == 1);
  }
  CHECK(count(svg, "fill=\"none\" stroke=\"#0072b2\"") == 1);
  CHECK(count(svg, "fill=\"none\" stroke=\"#009e73\"") == 1);

  const std::string convergence = text_of(s.folder / "plots/convergence.svg");
  const std::vector<Dot> dots = dots_of(convergence);
  REQUIRE(dots.size() == 3);
  CHECK(dots[0].y - dots[1].y == doctest::Approx(dots[1].y - dots[2].y).epsilon(0.01));
  CHECK(dots[1].x - dots[0].x == doctest::Approx(dots[2].x - dots[1].x).epsilon(0.01));
  CHECK(contains(convergence, "a.b (from the extrapolated value)"));
  CHECK_FALSE(contains(convergence, "never"));
  // The line of second order goes through all of them.
  CHECK(contains(convergence, fmt::format("M{:.1f} {:.1f}", dots[0].x, dots[0].y)));
}

TEST_CASE("time steps of the finest mesh have plots of their own") {
  SmallStudy s(2);
  StudyRun again = s.study.runs[1];
  s.study.runs[1].longest_step = 4e-7;
  again.name = "mesh2-step2";
  again.step = 1;
  again.longest_step = 2e-7;
  std::filesystem::copy(s.folder / "runs/mesh2-step1", s.folder / "runs/mesh2-step2",
                        std::filesystem::copy_options::recursive);
  s.study.runs.push_back(again);
  s.study.steps = 2;
  s.write();
  const auto paths = write_study_plots(s.folder);
  CHECK(has(paths, "corner.displacement_y-steps.svg"));
  const std::string svg = text_of(s.folder / "plots/corner.displacement_y-steps.svg");
  CHECK(contains(svg, ">step 400 ns<"));
  CHECK(contains(svg, ">step 200 ns<"));
}

TEST_CASE("a sweep: a number over what was varied, a curve for each choice of the rest") {
  SmallStudy s(1);
  const StudyRun first = s.study.runs[0];
  // Columns that are 0 or rounding beside their sisters are no plots.
  write_file(s.folder / "runs/mesh1-step1/histories/odd.csv",
             "time [s],x [m],y [m],none [N]\n0,1,1e-15,0\n1e-5,2,-1e-15,0\n");
  s.study.kind = "sweep";
  s.study.varied = {"stop.friction", "law"};
  s.study.runs.clear();
  for (const char* law : {"elastic", "tresca"}) {
    for (const double friction : {0.4, 0.0}) {
      StudyRun run = first;
      run.values = {friction, no_number};
      run.texts = {fmt::format("{}", friction), law};
      s.study.runs.push_back(run);
    }
  }
  s.study.quantities = {quantity("a.b", {4, 3, 2, 1}, no_number), quantity("c", {1, 1, 1, 1}, no_number)};
  s.study.quantities[1].headline = false;
  s.write();
  auto paths = write_study_plots(s.folder);
  CHECK(has(paths, "number-a.b.svg"));
  CHECK(has(paths, "odd.x.svg"));
  CHECK_FALSE(has(paths, "odd.y.svg"));
  CHECK_FALSE(has(paths, "odd.none.svg"));
  CHECK_FALSE(has(paths, "number-c.svg"));
  const std::string svg = text_of(s.folder / "plots/number-a.b.svg");
  CHECK(contains(svg, "law = elastic"));
  CHECK(contains(svg, "law = tresca"));
  CHECK(contains(svg, ">stop.friction<"));
  const std::vector<Dot> dots = dots_of(svg);
  REQUIRE(dots.size() == 4);
  CHECK(dots[0].x < dots[1].x);  // 0 before 0.4
  CHECK(dots[0].x == doctest::Approx(dots[2].x));
  CHECK(dots[1].y < dots[0].y);  // 4 above 3
  CHECK(has(write_study_plots(s.folder, {.quantities = {"c"}}), "number-c.svg"));

  // Words have names on the axis.
  s.study.varied = {"law"};
  for (StudyRun& run : s.study.runs) {
    run.values = {no_number};
    run.texts = {run.texts[1]};
  }
  s.write();
  write_study_plots(s.folder);
  CHECK(contains(text_of(s.folder / "plots/number-a.b.svg"), ">tresca<"));
}

TEST_CASE("a study of which nothing is done has no plots") {
  SmallStudy s(1);
  s.study.runs[0].state = "failed";
  s.study.quantities = {quantity("a.b", {no_number}, no_number)};
  s.write();
  CHECK(write_study_plots(s.folder).empty());
}

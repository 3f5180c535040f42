#include "udar/report/study_page.hpp"

#include <algorithm>
#include <filesystem>

#include "tests/report/decode.hpp"
#include "tests/report/small_study.hpp"
#include "udar/base/error.hpp"
#include "udar/report/study_runs.hpp"
#include "udar/results/histories.hpp"
#include "udar/results/pvd.hpp"

using namespace udar;

namespace {

constexpr std::string_view page = "<!doctype html><p>before<!-- the run --><p>after";

ReadReport read(const SmallStudy& s, ReportOptions options = {}) {
  options.page = page;
  const ReportInfo info = write_study_page(s.folder, options);
  const std::string text = read_file(info.path, std::size_t{1} << 30);
  CHECK(info.bytes == text.size());
  CHECK(info.bytes <= options.limit);
  return ReadReport(text);
}

bool any_contains(const nlohmann::json& sentences, std::string_view part) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const auto& s) { return contains(s.template get<std::string>(), part); });
}

std::vector<std::string> names(const nlohmann::json& runs) {
  std::vector<std::string> out;
  for (const auto& run : runs) out.push_back(run.at("name"));
  return out;
}

Study only_runs(std::string kind, const std::vector<StudyRun>& runs) {
  Study study;
  study.kind = std::move(kind);
  study.runs = runs;
  return study;
}

}  // namespace

TEST_CASE("the page of a study holds its runs with blocks numbered through, from the coarsest on") {
  const SmallStudy s(3);
  write_file(s.folder / "runs/mesh2-step1/report.html", "<p>");
  const ReadReport report = read(s);
  CHECK(report.run.at("format") == 1);
  CHECK(report.run.at("kind") == "study");
  CHECK(report.run.at("study") == nlohmann::json::parse(to_json(s.study)));
  CHECK(report.run.at("left_out").empty());
  const auto& runs = report.run.at("runs");
  CHECK(names(runs) == std::vector<std::string>{"mesh1-step1", "mesh2-step1", "mesh3-step1"});
  std::vector<std::size_t> blocks;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const auto& run = runs.at(r);
    CAPTURE(r);
    CHECK(run.at("report") == (r == 1));
    CHECK(run.at("left_out").empty());
    CHECK(run.at("elements") == s.study.runs[r].elements);
    // Every array is the run's own: corners have as many columns as elements, histories are those of its file.
    CHECK(run.at("corners").at("columns") == s.study.runs[r].elements);
    const std::filesystem::path folder = s.folder / "runs" / s.study.runs[r].name;
    for (const auto& history : run.at("histories")) {
      const History file = read_csv(folder / "histories" / (history.at("name").get<std::string>() + ".csv"));
      const std::vector<double> values = report.values(history.at("values"));
      REQUIRE(values.size() == file.columns.size() * file.values[0].size());
      CHECK(static_cast<float>(values.back()) == static_cast<float>(file.values.back().back()));
      blocks.push_back(history.at("values").at("block"));
    }
    const auto& times = run.at("times");
    std::size_t frame = 0;
    for (const PvdEntry& entry : read_pvd(folder / "fields.pvd")) {
      if (entry.part == 0) CHECK(times.at(frame++) == entry.time);
    }
    CHECK(times.size() == frame);
  }
  std::sort(blocks.begin(), blocks.end());
  CHECK(std::adjacent_find(blocks.begin(), blocks.end()) == blocks.end());
  CHECK(blocks.back() < report.blocks.size());
}

TEST_CASE("the limit holds, and coarse runs do not starve beside fine ones") {
  const SmallStudy s(4);
  ReportOptions options{.page = page};
  const std::size_t whole = write_study_page(s.folder, options).bytes;
  for (const double part : {1.0, 0.8, 0.6, 0.4}) {
    CAPTURE(part);
    const ReadReport report = read(s, {.limit = static_cast<std::size_t>(part * static_cast<double>(whole)) + 2000});
    const auto& runs = report.run.at("runs");
    CHECK(runs.front().at("times").size() >= runs.back().at("times").size());
    if (part > 0.5) CHECK(runs.front().at("times").size() == 13);
    if (part > 0.5) CHECK_FALSE(any_contains(runs.front().at("left_out"), "velocities"));
    if (part == 1.0) CHECK(runs.back().at("left_out").empty());
    if (part == 0.4) CHECK_FALSE(runs.back().at("left_out").empty());
  }
  options.limit = 1000;
  CHECK(contains(message_of<UserError>([&] { write_study_page(s.folder, options); }), "are needed without any run"));
  // Room for the tables and the small runs only.
  const ReadReport little = read(s, {.limit = 20'000});
  CHECK(little.run.at("runs").size() < 4);
  CHECK(any_contains(little.run.at("left_out"), "the run mesh4-step1 is in the tables only"));
}

TEST_CASE("runs that failed, have no frames or are gone") {
  SmallStudy s(3, 1.0);
  for (const StudyRun& run : s.study.runs) {
    std::filesystem::remove_all(s.folder / "runs" / run.name / "fields");
    std::filesystem::remove(s.folder / "runs" / run.name / "fields.pvd");
  }
  s.study.runs[1].state = "failed";
  s.study.runs[1].reason = "</script>turned inside out";
  s.write();
  std::filesystem::remove_all(s.folder / "runs/mesh3-step1");
  const ReadReport report = read(s);
  const auto& runs = report.run.at("runs");
  CHECK(names(runs) == std::vector<std::string>{"mesh1-step1"});
  CHECK(runs.at(0).at("times").empty());
  CHECK_FALSE(runs.at(0).at("histories").empty());
  CHECK(report.run.at("study").at("runs").at(1).at("reason") == s.study.runs[1].reason);
  CHECK(any_contains(report.run.at("left_out"), "folder of the run mesh3-step1 is missing"));

  for (StudyRun& run : s.study.runs) run.state = "missing";
  s.write();
  CHECK(read(s).run.at("runs").empty());
  write_file(s.folder / "study.json", "{");
  CHECK(contains(message_of<OutputError>([&] { read(s); }), "cannot read"));
}

TEST_CASE("a study of strangers names no file outside of its folder") {
  const std::filesystem::path folder = "/study";
  for (const char* name : {"..", ".", "", "../x", "/etc", "a/../../b"}) {
    CAPTURE(name);
    CHECK(study_run_folder(folder, {.name = name}).empty());
  }
  CHECK(study_run_folder(folder, {.name = "mesh1-step1"}) == "/study/runs/mesh1-step1");
}

TEST_CASE("interrupted, the page stays as it was") {
  const SmallStudy s(1);
  const ReportInfo info = write_study_page(s.folder, {.page = page, .interrupted = [] { return true; }});
  CHECK(info.path.empty());
  CHECK_FALSE(std::filesystem::exists(s.folder / "study.html"));
}

TEST_CASE("which runs stand beside each other") {
  const auto run = [](int mesh, int step, const char* state) {
    return StudyRun{.name = "", .mesh = mesh, .step = step, .state = state};
  };
  const Study converge =
      only_runs("converge", {run(2, 0, "done"), run(0, 0, "done"), run(0, 1, "done"), run(1, 0, "done"),
                             run(1, 1, "failed"), run(2, 1, "done"), run(3, 1, "missing")});
  CHECK(mesh_levels(converge) == std::vector<std::size_t>{2, 3, 5});
  CHECK(step_levels(converge) == std::vector<std::size_t>{0, 5});
  CHECK(shown_runs(converge, 2) == std::vector<std::size_t>{3, 5});
  CHECK(shown_runs(only_runs("converge", {}), 6).empty());
  // Of one mesh its time steps.
  CHECK(shown_runs(only_runs("converge", {run(0, 1, "done"), run(0, 0, "done")}), 6) == std::vector<std::size_t>{1, 0});

  std::vector<StudyRun> many(11, run(0, 0, "done"));
  CHECK(shown_runs(only_runs("sweep", many), 6) == std::vector<std::size_t>{0, 2, 4, 6, 8, 10});
  CHECK(shown_runs(only_runs("sweep", many), 20).size() == 11);
  many[0].state = many[10].state = "failed";
  const std::vector<std::size_t> shown = shown_runs(only_runs("sweep", many), 6);
  CHECK(shown.size() == 6);
  CHECK(shown.front() == 1);
  CHECK(shown.back() == 9);
  CHECK(std::adjacent_find(shown.begin(), shown.end()) == shown.end());
}

TEST_CASE("labels tell runs apart") {
  Study study;
  study.kind = "converge";
  study.element_sizes = {0.005, 0.0025};
  CHECK(level_label(study, {.name = "a", .mesh = 1}) == "2.5 mm");
  CHECK(level_label(study, {.name = "a", .mesh = 7}) == "a");
  study.kind = "sweep";
  study.varied = {"obstacles.stop.friction", "run.integrator"};
  CHECK(level_label(study, {.name = "a", .texts = {"0.3", "adams"}}) == "friction 0.3, integrator adams");
  CHECK(level_label(study, {.name = "a"}) == "a");
  study.varied = {"bodies.ball.velocity.0"};
  CHECK(level_label(study, {.name = "a", .texts = {"20 m/s"}}) == "velocity.0 20 m/s");
  study.varied = {"case"};
  CHECK(level_label(study, {.name = "a", .texts = {"x"}}) == "case x");
}

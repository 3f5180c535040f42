#include "udar/report/report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "tests/report/decode.hpp"
#include "tests/results/scratch.hpp"
#include "tests/simulation/example.hpp"
#include "udar/results/file.hpp"
#include "udar/results/histories.hpp"
#include "udar/results/pvd.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/results/vtu.hpp"
#include "udar/simulation/simulation.hpp"

using namespace udar;

namespace {

constexpr std::string_view page = "<!doctype html><p>before<!-- the run --><p>after";

/// A block that strikes, with 31 frames: more than one chunk.
struct SmallRun {
  explicit SmallRun(double element_size = 0.005) : folder(scratch / "run") {
    Case input = falling_block(element_size);
    input.output.fields_every = 2e-6;
    input.output.histories_every = 2e-6;
    Simulation simulation(std::move(input));
    summary = simulation.run({.folder = folder, .case_name = name});
  }
  ReportInfo report(ReportOptions options = {}) {
    options.page = page;
    return write_report(folder, options);
  }
  /// The report taken apart.
  ReadReport read(const ReportOptions& options = {}) {
    report(options);
    return ReadReport(text());
  }
  [[nodiscard]] std::string text() const { return read_file(folder / "report.html", std::size_t{1} << 30); }
  [[nodiscard]] std::vector<PvdEntry> frames() const {
    std::vector<PvdEntry> bodies;
    for (const PvdEntry& e : read_pvd(folder / "fields.pvd")) {
      if (e.part == 0) bodies.push_back(e);
    }
    return bodies;
  }

  static constexpr const char* name = "</script><img src=x onerror=alert(1)>&\xE2\x80\xA8\xE2\x80\xA9";
  Scratch scratch;
  std::filesystem::path folder;
  Summary summary;
};

const VtuArray& field(const VtuGrid& grid, std::string_view name) {
  for (const auto* fields : {&grid.point_fields, &grid.cell_fields}) {
    for (const VtuArray& f : *fields) {
      if (f.name == name) return f;
    }
  }
  FAIL("no field " << name);
  return grid.cell_fields.front();
}

double value_of(const VtuArray& f, std::size_t i) {
  return std::visit([&](const auto& values) { return static_cast<double>(values[i]); }, f.values);
}

/// Compares a quantity of the report with component `c` of a field in all frames.
void compare(const SmallRun& run, const ReadReport& report, const char* name, const char* field_name, std::size_t c) {
  CAPTURE(name);
  const nlohmann::json* quantity = report.quantity(name);
  REQUIRE(quantity != nullptr);
  const auto entries = run.frames();
  std::size_t frames = 0;
  for (const auto& chunk : quantity->at("chunks")) {
    CHECK(chunk.at("first") == frames);
    const std::vector<double> values = report.values(chunk);
    const std::size_t rows = chunk.at("rows");
    const std::size_t columns = chunk.at("columns");
    const double bound = chunk.contains("step") ? (0.5 + 1e-6) * chunk.at("step").get<double>() : 0;
    double worst = 0;
    for (std::size_t row = 0; row < rows; ++row) {
      const VtuGrid grid = read_vtu(run.folder / entries.at(frames + row).file);
      const VtuArray& f = field(grid, field_name);
      for (std::size_t i = 0; i < columns; ++i) {
        const double there = value_of(f, i * static_cast<std::size_t>(f.components) + c);
        worst = std::max(worst, std::fabs(values[row * columns + i] - there));
      }
    }
    CHECK(worst <= bound);
    frames += rows;
  }
  CHECK(frames == entries.size());
}

bool any_contains(const nlohmann::json& sentences, std::string_view part) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const auto& s) { return contains(s.template get<std::string>(), part); });
}

}  // namespace

TEST_CASE("fields of a report are those of the frames within half a step") {
  SmallRun run;
  const ReadReport report = run.read();
  CHECK(report.run.at("left_out").empty());
  REQUIRE(run.frames().size() > 26);
  for (std::size_t f = 0; f < run.frames().size(); ++f) CHECK(report.run.at("times").at(f) == run.frames()[f].time);
  compare(run, report, "velocity_x", "velocity_m_per_s", 0);
  compare(run, report, "velocity_y", "velocity_m_per_s", 1);
  compare(run, report, "acceleration_x", "acceleration_m_per_s2", 0);
  compare(run, report, "acceleration_y", "acceleration_m_per_s2", 1);
  compare(run, report, "plastic_strain", "plastic_strain", 0);
  compare(run, report, "flows_now", "flows_now", 0);
  compare(run, report, "principal_1", "principal_1_Pa", 0);
  compare(run, report, "principal_2", "principal_2_Pa", 0);
  compare(run, report, "principal_3", "principal_3_Pa", 0);
  CHECK(report.quantity("max_shear") == nullptr);  // it follows from the three
}

TEST_CASE("places are the centre of mass of the body and what is against it") {
  SmallRun run;
  const ReadReport report = run.read();
  const std::vector<double> centres[] = {report.values(report.run.at("centre_x")),
                                         report.values(report.run.at("centre_y"))};
  const char* names[] = {"x", "y"};
  for (std::size_t c = 0; c < 2; ++c) {
    for (const auto& chunk : report.quantity(names[c])->at("chunks")) {
      const std::vector<double> values = report.values(chunk);
      const std::size_t columns = chunk.at("columns");
      for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t frame = chunk.at("first").get<std::size_t>() + i / columns;
        const VtuGrid grid = read_vtu(run.folder / run.frames()[frame].file);
        const Vec2 p = grid.points[i % columns];
        const double off = centres[c][frame] + values[i] - (c == 0 ? p.x : p.y);
        // Half a step of the place, and what 32 bits and the step of the centre lose, 1e-7 of the size.
        if (!(std::fabs(off) <= 0.5 * chunk.at("step").get<double>() + 4e-9))
          FAIL("node " << i << " is off by " << off);
      }
    }
    // The run's own centre of mass, from its lumped masses.
    const History history = read_csv(run.folder / "histories/block.csv");
    const std::vector<double> times = report.run.at("times");
    for (std::size_t frame = 0; frame < times.size(); ++frame) {
      const auto row = std::find(history.at("time").begin(), history.at("time").end(), times[frame]);
      if (row == history.at("time").end()) continue;
      const double position =
          history.at(c == 0 ? "position_x" : "position_y")[static_cast<std::size_t>(row - history.at("time").begin())];
      CHECK(std::fabs(centres[c][frame] - position) <= 4e-9);
    }
    CHECK(times.front() == history.at("time").front());
  }
}

TEST_CASE("mesh, bodies, observers and forces are those of the run") {
  SmallRun run;
  const ReadReport report = run.read();
  const VtuGrid first = read_vtu(run.folder / run.frames()[0].file);
  const std::size_t elements = first.ends.size();
  CHECK(report.run.at("nodes") == first.points.size());
  CHECK(report.run.at("elements") == elements);
  const std::vector<double> corners = report.values(report.run.at("corners"));
  for (std::size_t e = 0; e < elements; ++e) {
    for (std::size_t c = 0; c < 3; ++c) CHECK(corners[c * elements + e] == first.corners[3 * e + c]);
  }
  CHECK(report.run.at("bodies") ==
        nlohmann::json::parse(R"([{"name": "block", "rigid": false, "node_begin": 0,
      "node_end": )" + std::to_string(first.points.size()) +
                              R"(, "element_begin": 0, "element_end": )" + std::to_string(elements) + "}]"));
  // The observed corner is where the case says.
  const std::size_t corner = report.run.at("observed").at("corner").at("index");
  CHECK(report.run.at("observed").at("corner").at("on") == "nodes");
  CHECK(first.points[corner].x == doctest::Approx(-0.02));
  CHECK(first.points[corner].y == doctest::Approx(0.02));
  const std::size_t bottom = report.run.at("observed").at("bottom").at("index");
  CHECK(report.run.at("observed").at("bottom").at("on") == "elements");
  // Its element holds (1, 1) mm: so does the box of its corners.
  double most_x = -1;
  double least_x = 1;
  for (std::size_t c = 0; c < 3; ++c) {
    const double x = first.points[static_cast<std::size_t>(first.corners[3 * bottom + c])].x;
    most_x = std::max(most_x, x);
    least_x = std::min(least_x, x);
  }
  CHECK(least_x <= 0.001);
  CHECK(most_x >= 0.001);

  std::size_t frame = 0;
  for (const auto& chunk : report.run.at("forces").at("chunks")) {
    const bool any = chunk.contains("nodes");
    const std::vector<double> nodes = any ? report.values(chunk.at("nodes")) : std::vector<double>{};
    const std::vector<double> y = any ? report.values(chunk.at("y")) : std::vector<double>{};
    std::size_t at = 0;
    for (const std::size_t count : chunk.at("counts")) {
      const VtuGrid grid = read_vtu(run.folder / run.frames()[frame++].file);
      const VtuArray& force = field(grid, "contact_force_N");
      std::size_t felt = 0;
      for (std::size_t i = 0; i < grid.points.size(); ++i) {
        if (value_of(force, 3 * i) != 0 || value_of(force, 3 * i + 1) != 0) ++felt;
      }
      REQUIRE(felt == count);
      for (std::size_t k = 0; k < count; ++k, ++at) {
        const double there = value_of(force, 3 * static_cast<std::size_t>(nodes.at(at)) + 1);
        CHECK(std::fabs(y.at(at) - there) <= (0.5 + 1e-6) * chunk.at("y").at("step").get<double>());
      }
    }
  }
  CHECK(frame == run.frames().size());
  CHECK(report.run.at("outlines").at("of_frame").size() == frame);
}

TEST_CASE("histories are the files in 32 bits, those of the observers first") {
  SmallRun run;
  const ReadReport report = run.read();
  const auto& histories = report.run.at("histories");
  CHECK(histories.at(0).at("name") == "bottom");
  CHECK(histories.at(1).at("name") == "corner");
  CHECK(histories.at(2).at("name") == "energy");
  for (const auto& history : histories) {
    const History file = read_csv(run.folder / "histories" / (history.at("name").get<std::string>() + ".csv"));
    const std::vector<double> values = report.values(history.at("values"));
    const std::size_t rows = file.values[0].size();
    REQUIRE(values.size() == file.columns.size() * rows);
    for (std::size_t c = 0; c < file.columns.size(); ++c) {
      CHECK(history.at("columns").at(c).at("name") == file.columns[c].name);
      CHECK(history.at("columns").at(c).at("unit") == file.columns[c].unit);
      for (std::size_t r = 0; r < rows; ++r) {
        REQUIRE(static_cast<float>(values[c * rows + r]) == static_cast<float>(file.values[c][r]));
      }
    }
  }
  CHECK(histories.size() == run.summary.histories.size());
}

TEST_CASE("a hostile name stays text") {
  SmallRun run;
  write_file(run.folder / "case.toml", "# </script><script>alert(2)</script><!-- \xFF\n");
  run.report();
  const std::string text = run.text();
  CHECK_FALSE(contains(text, "<img"));
  CHECK_FALSE(contains(text, "alert(2)</script>"));
  CHECK_FALSE(contains(text, "<!--"));
  CHECK_FALSE(contains(text, "\xE2\x80\xA8"));
  CHECK_FALSE(contains(text, "\xE2\x80\xA9"));
  CHECK(text.starts_with("<!doctype html><p>before<script"));
  CHECK(text.ends_with("</script>\n<p>after"));
  const ReadReport report(text);
  CHECK(report.run.at("case_name") == SmallRun::name);
  // As many elements begin as end: nothing of the run is one.
  std::size_t begins = 0;
  for (std::size_t at = text.find("<script"); at != std::string::npos; at = text.find("<script", at + 1)) ++begins;
  CHECK(begins == report.blocks.size() + 1);
}

TEST_CASE("a report is never larger than its limit, and tells what that has cost") {
  SmallRun run(0.001);
  const std::size_t whole = run.report().bytes;
  CHECK(whole == std::filesystem::file_size(run.folder / "report.html"));
  std::size_t frames_before = 1000;
  for (const double part : {1.0, 0.9, 0.75, 0.6, 0.5, 0.4, 0.35}) {
    const auto limit = static_cast<std::size_t>(part * static_cast<double>(whole));
    CAPTURE(part);
    const ReportInfo info = run.report({.limit = limit});
    CHECK(info.bytes <= limit);
    CHECK(info.bytes == std::filesystem::file_size(run.folder / "report.html"));
    CHECK(info.left_out.empty() == (part == 1.0));
    const ReadReport report(run.text());
    CHECK(report.run.at("left_out") == info.left_out);
    CHECK(report.run.at("times").size() == info.frames);
    CHECK(info.frames <= frames_before);
    frames_before = info.frames;
    if (info.frames > 0) CHECK(report.run.at("times").back() == run.frames().back().time);
    CHECK(any_contains(report.run.at("left_out"), "accelerations are left out") ==
          (report.quantity("acceleration_x") == nullptr));
  }
  CHECK(contains(message_of<UserError>([&] { run.report({.limit = 5000}); }), "are needed without any frame"));
}

TEST_CASE("frames and fields that were asked for") {
  SmallRun run;
  const ReadReport some = run.read({.fields = {"plastic_strain", "max_shear"}, .frames = 7});
  CHECK(some.run.at("times").size() <= 7);
  CHECK(some.run.at("times").size() > 3);
  CHECK(some.quantity("x") != nullptr);
  CHECK(some.quantity("max_shear") != nullptr);
  CHECK(some.quantity("principal_1") == nullptr);
  CHECK_FALSE(some.run.contains("forces"));
  CHECK(any_contains(some.run.at("left_out"), "only those asked for"));
  CHECK(any_contains(some.run.at("left_out"), "frames is here"));
  const auto asked = [&](const char* name) { return message_of<UserError>([&] { run.report({.fields = {name}}); }); };
  CHECK(contains(asked("plastic_strian"), "did you mean `plastic_strain`?"));
  CHECK(contains(asked("zzz"), "choose of velocity, acceleration, plastic_strain"));
}

TEST_CASE("a killed run: no summary, half a row, a frame that is gone and one that is cut") {
  SmallRun run;
  const auto frames = run.frames();
  std::filesystem::remove(run.folder / "summary.json");
  std::filesystem::remove(run.folder / frames[3].file);
  const std::string frame = read_file(run.folder / frames[28].file, 1 << 26);
  write_file(run.folder / frames[28].file, frame.substr(0, frame.size() / 2));
  const std::string csv = read_file(run.folder / "histories/corner.csv", 1 << 26);
  write_file(run.folder / "histories/corner.csv", csv.substr(0, csv.size() - 5));
  write_file(run.folder / "histories/bottom.csv", "time [s],x\n1,2\nnonsense\n");

  const ReadReport report = run.read();
  CHECK(report.run.at("summary").is_null());
  CHECK(report.run.at("case_name") == SmallRun::name);  // as the log has it
  CHECK(report.run.at("bodies").at(0).at("name") == "body 1");
  CHECK(report.run.at("observed").empty());
  const auto& times = report.run.at("times");
  CHECK(times.size() == frames.size() - 2);
  CHECK(std::find(times.begin(), times.end(), frames[3].time) == times.end());
  CHECK(std::find(times.begin(), times.end(), frames[28].time) == times.end());
  CHECK(report.values(report.quantity("x")->at("chunks").back()).size() > 0);
  for (const char* part :
       {"summary.json is missing", "bodies_000003.vtu is missing", "bodies_000028.vtu", "bottom.csv"}) {
    CAPTURE(part);
    CHECK(any_contains(report.run.at("left_out"), part));
  }
  for (const auto& history : report.run.at("histories")) {
    CHECK(history.at("name") != "bottom");
    if (history.at("name") != "corner") continue;
    const std::size_t rows = std::count(csv.begin(), csv.end(), '\n') - 1;
    CHECK(history.at("values").at("columns") == rows - 1);
  }
}

TEST_CASE("a run without frames, or with nothing but its case") {
  SmallRun run;
  std::filesystem::remove_all(run.folder / "fields");
  std::filesystem::remove(run.folder / "fields.pvd");
  ReadReport report = run.read();
  CHECK(report.run.at("times").empty());
  CHECK(report.run.at("nodes") == 0);
  CHECK(report.run.at("bodies").at(0).at("name") == "block");
  CHECK(report.run.at("histories").size() > 3);
  std::filesystem::remove_all(run.folder / "histories");
  std::filesystem::remove(run.folder / "log.txt");
  std::filesystem::remove(run.folder / "summary.json");
  report = run.read();
  CHECK(report.run.at("histories").empty());
  CHECK(report.run.at("log") == "");
}

TEST_CASE("histories take a fifth of the limit at most") {
  SmallRun run;
  const std::string corner = read_file(run.folder / "histories/corner.csv", 1 << 26);
  for (int i = 0; i < 300; ++i) write_file(run.folder / fmt::format("histories/more_{}.csv", i), corner);
  const std::size_t limit = 400'000;
  const ReadReport report = run.read({.limit = limit});
  std::size_t bytes = 0;
  for (const auto& history : report.run.at("histories")) {
    bytes += report.blocks.at(history.at("values").at("block").get<std::size_t>()).size() + history.dump().size();
  }
  CHECK(bytes <= limit / 5);
  CHECK(report.run.at("histories").at(0).at("name") == "bottom");
  CHECK(any_contains(report.run.at("left_out"), "histories are left out: they are in histories/"));
}

TEST_CASE("no folder of a run, no place for the run, no file in between") {
  SmallRun run;
  const auto refusal = [&](const std::filesystem::path& folder) {
    return message_of<UserError>([&] { write_report(folder, {.page = page}); });
  };
  CHECK(contains(refusal(run.scratch / "nothing"), "is not there"));
  CHECK(contains(refusal(run.scratch.path), "is not the folder of a run"));
  CHECK(contains(message_of<OutputError>([&] { write_report(run.folder, {.page = "<p>"}); }), "place for the run"));
  const ReportInfo info = run.report({.interrupted = [] { return true; }});
  CHECK(info.path.empty());
  CHECK_FALSE(std::filesystem::exists(run.folder / "report.html"));
  CHECK_FALSE(std::filesystem::exists(run.folder / "report.html.tmp"));
}

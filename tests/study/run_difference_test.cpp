#include "udar/study/run_difference.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/results/scratch.hpp"
#include "udar/results/file.hpp"
#include "udar/results/run_folder.hpp"

using namespace udar;

namespace {

/// Two run folders that are the same, made by hand.
struct TwoRuns {
  Scratch scratch;
  std::filesystem::path a = scratch / "a";
  std::filesystem::path b = scratch / "b";

  TwoRuns() {
    for (const auto& folder : {a, b}) {
      std::filesystem::create_directories(folder / "histories");
      std::filesystem::create_directories(folder / "fields");
      write(folder, ".udar-run", "");
      write(folder, "histories/corner.csv", "time [s],x [m],v [m/s],noise [m]\n0,0,1,0\n1,1,1,1e-17\n2,2,1,-1e-17\n");
      write(folder, "histories/stop.csv", "time [s],force [N]\n0,0\n1,10\n2,0\n");
      write(folder, "fields/bodies_000000.vtu", "frame");
      write(folder, "fields.pvd",
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\"><Collection>\n"
            "<DataSet timestep=\"0.5\" part=\"0\" file=\"fields/bodies_000000.vtu\"/>\n</Collection></VTKFile>\n");
      write(folder, "resolved.toml",
            "[run]\nend_time = \"2 s\"\ngravity = [\"0 m/s^2\", \"-9.81 m/s^2\"]\n"
            "[[observe.nodes]]\nname = \"corner\"\nbody = \"block\"\n");
      write_summary(folder / "summary.json", summary(0.25));
    }
  }
  static void write(const std::filesystem::path& folder, const char* name, const std::string& text) {
    write_file(folder / name, text);
  }
  static Summary summary(double first_touch) {
    Summary s{.version = "1", .case_name = "c", .steps = 10, .verdict = "good"};
    s.contacts["stop"] = {.first_touch = first_touch, .duration = 1, .impulse = {3, -4}};
    s.contacts["wall"] = {.first_touch = 1.5};
    s.contacts["zero"] = {};  // never touched
    s.histories["corner"]["x"] = {.min = -1, .max = 2};
    return s;
  }
  [[nodiscard]] RunDifference compare(DifferenceRequest request = {}) const {
    request.a = a;
    request.b = b;
    return compare_runs(request);
  }
  [[nodiscard]] std::string refused(DifferenceRequest request) const {
    return message_of<UserError>([&] { static_cast<void>(compare(std::move(request))); });
  }
};

const ColumnDifference& column(const RunDifference& difference, std::string_view name) {
  for (const ColumnDifference& c : difference.columns) {
    if (c.name == name) return c;
  }
  FAIL("no column ", std::string(name));
  return difference.columns.front();
}

}  // namespace

TEST_CASE("the same bits, whatever machine and day") {
  const TwoRuns runs;
  Summary elsewhere = TwoRuns::summary(0.25);
  elsewhere.version = "2";
  elsewhere.started = "2026-01-01T00:00:00Z";
  elsewhere.machine = {"other", 64};
  elsewhere.threads = 7;
  elsewhere.wall_seconds = elsewhere.stepping_seconds = elsewhere.element_steps_per_second = 5;
  write_summary(runs.b / "summary.json", elsewhere);
  const RunDifference d = runs.compare();
  REQUIRE(d.bits);
  CHECK(d.bits->same);
  CHECK(d.keys.empty());
  CHECK(d.columns.size() == 4);
  for (const ColumnDifference& c : d.columns) {
    CHECK(c.same_bits);
    CHECK(c.difference.l2 == 0);
  }
  for (const NumberDifference& n : d.numbers) CHECK(n.same());
}

TEST_CASE("the earliest row that is not the same, in the history where it comes first") {
  const TwoRuns runs;
  TwoRuns::write(runs.b, "histories/corner.csv",
                 "time [s],x [m],v [m/s],noise [m]\n0,0,1,0\n1,1,1,1e-17\n2,2,1.0000000000000002,-1e-17\n");
  CHECK(runs.compare().bits->where == "corner.v");
  CHECK(runs.compare().bits->time == 2);
  TwoRuns::write(runs.b, "histories/stop.csv", "time [s],force [N]\n0,-0\n1,10\n2,0\n");
  CHECK(runs.compare().bits->where == "stop.force");
  CHECK(runs.compare().bits->time == 0);
  CHECK_FALSE(column(runs.compare(), "stop.force").same_bits);
  CHECK(column(runs.compare(), "corner.x").same_bits);
}

TEST_CASE("a history that is looked at later may part first") {
  const TwoRuns runs;
  TwoRuns::write(runs.b, "histories/stop.csv", "time [s],force [N]\n0,0\n1,10\n2,1\n");
  TwoRuns::write(runs.b, "histories/corner.csv",
                 "time [s],x [m],v [m/s],noise [m]\n0,0,1,0\n1,2,1,1e-17\n2,2,1,-1e-17\n");
  CHECK(runs.compare().bits->where == "corner.x");
  CHECK(runs.compare().bits->time == 1);
}

TEST_CASE("other reasons for other bits") {
  const TwoRuns runs;
  const auto told = [&] {
    const BitDifference bits = *runs.compare().bits;
    CHECK_FALSE(bits.same);
    return bits.where + "|" + bits.how;
  };
  write_summary(runs.b / "summary.json", TwoRuns::summary(0.5));
  CHECK(told() == "summary.json: contacts.stop.first_touch|");
  TwoRuns::write(runs.b, "fields/bodies_000000.vtu", "Frame");
  CHECK(told() == "fields/bodies_000000.vtu|");
  CHECK(runs.compare().bits->time == 0.5);
  std::filesystem::remove(runs.b / "fields.pvd");
  CHECK(told() == "fields/bodies_000000.vtu|only in A");
  TwoRuns::write(runs.b, "histories/extra.csv", "time [s],x [m]\n0,0\n");
  CHECK(told() == "histories/extra.csv|only in B");
  TwoRuns::write(runs.b, "histories/stop.csv", "time [s],force [N]\n0,0\n1,10\n");
  CHECK(told() == "stop|ends earlier in B");
  CHECK(runs.compare().bits->time == 2);
  CHECK(runs.compare().only_in_b == std::vector<std::string>{"extra"});
}

TEST_CASE("numbers of the summaries by flat names") {
  const TwoRuns runs;
  Summary other = TwoRuns::summary(0.5);
  other.contacts["stop"].impulse.y = -5;
  other.histories["corner"]["x"].min = no_number;
  write_summary(runs.b / "summary.json", other);
  const RunDifference d = runs.compare();
  const auto number = [&](std::string_view name) {
    for (const NumberDifference& n : d.numbers) {
      if (n.name == name) return n;
    }
    FAIL("no number ", std::string(name));
    return NumberDifference{};
  };
  CHECK(number("contacts.stop.first_touch").a == 0.25);
  CHECK(number("contacts.stop.first_touch").b == 0.5);
  CHECK(number("contacts.stop.impulse.x").same());
  CHECK(number("contacts.stop.impulse.y").b == -5);
  CHECK(number("histories.corner.x.min").a == -1);
  CHECK(std::isnan(number("histories.corner.x.min").b));
  CHECK_FALSE(number("histories.corner.x.min").same());
  for (const NumberDifference& n : d.numbers) {
    CHECK_FALSE(n.name.starts_with("machine"));
    CHECK(n.name != "wall_seconds");
  }
}

TEST_CASE("cases are compared key by key") {
  const std::string a =
      "[run]\nend_time = \"2 s\"\nsafe = true\n[bodies.b]\nat = [\"0 m\", \"1 m\"]\n"
      "[[observe.nodes]]\nname = \"n\"\nbody = \"b\"\n";
  const std::string b =
      "[run]\nend_time = \"3 s\"\nsafe = true\n[bodies.b]\nat = [\"0 m\", \"2 m\"]\nnew = 0.5\n"
      "[[observe.nodes]]\nname = \"first\"\nbody = \"b\"\n[[observe.nodes]]\nname = \"n\"\nbody = \"b\"\n";
  const std::vector<KeyDifference> keys = compare_cases(a, b);
  REQUIRE(keys.size() == 5);
  CHECK(keys[0].key == "run.end_time");
  CHECK(keys[0].a == "2 s");
  CHECK(keys[0].b == "3 s");
  CHECK(keys[1].key == "bodies.b.at");
  CHECK(keys[1].b == "[0 m, 2 m]");
  CHECK(keys[2].key == "bodies.b.new");
  CHECK(keys[2].a == "");
  CHECK(keys[3].key == "observe.nodes.first.name");
  CHECK(compare_cases(a, a).empty());
  CHECK(compare_cases(a, "no toml").empty());
}

TEST_CASE("columns are compared, aligned at the first touch on demand") {
  const TwoRuns runs;
  TwoRuns::write(runs.b, "histories/stop.csv", "time [s],force [N]\n0.5,0\n1.5,10\n2.5,0\n");
  write_summary(runs.b / "summary.json", TwoRuns::summary(0.75));
  CHECK(column(runs.compare(), "stop.force").difference.l2 > 1);
  const RunDifference aligned = runs.compare({.only = {"stop"}, .align = true});
  CHECK(aligned.moved == -0.5);
  CHECK(aligned.columns.size() == 1);
  CHECK(column(aligned, "stop.force").difference.l2 == 0);
  CHECK(runs.compare({.only = {"stop.force"}, .shift = -0.5}).columns[0].difference.l2 == 0);
  CHECK(differs(column(runs.compare(), "stop.force"), 0.02));
  CHECK_FALSE(differs(column(aligned, "stop.force"), 0));
}

TEST_CASE("rounding is told from differences") {
  const TwoRuns runs;
  TwoRuns::write(runs.b, "histories/corner.csv", "time [s],x [m],v [m/s],noise [m]\n0,0,1,0\n1,1.5,1,3e-17\n2,2,1,0\n");
  const RunDifference d = runs.compare();
  CHECK(column(d, "corner.noise").negligible);
  CHECK_FALSE(differs(column(d, "corner.noise"), 0.01));
  CHECK_FALSE(column(d, "corner.x").negligible);
  // Alone it is what was asked for.
  CHECK_FALSE(runs.compare({.only = {"corner.noise"}}).columns[0].negligible);
}

TEST_CASE("what cannot be compared is said with its cure") {
  const TwoRuns runs;
  CHECK(contains(runs.refused({.only = {"cornr"}}), "did you mean `corner`?"));
  CHECK(contains(runs.refused({.only = {"corner.y"}}), "did you mean `corner.x`?"));
  CHECK(
      contains(runs.refused({.shift = 5}), "there is no time that both have: A has rows from 0 s to 2 s, B from 5 s"));
  CHECK(contains(runs.refused({.how = {.from = 3}}), "widen --from"));
  CHECK(contains(runs.refused({.maps = {"x=corner.x"}}), "both are runs"));
  TwoRuns::write(runs.a, "histories/more.csv", "time [s],x [m]\n0,0\n");
  CHECK(contains(runs.refused({.only = {"more"}}), "is only in"));
  std::filesystem::remove(runs.b / "summary.json");
  CHECK(contains(runs.refused({.align = true}), "has no first touch to align at"));
  std::filesystem::remove_all(runs.b / "histories");
  CHECK(contains(runs.refused({}), "has no histories"));
}

TEST_CASE("the whole comparison as files") {
  const TwoRuns runs;
  TwoRuns::write(runs.b, "histories/stop.csv", "time [s],force [N]\n0,0\n1,0\n2,0\n");
  const RunDifference d = runs.compare();
  const std::string csv = to_csv(d);
  CHECK(contains(csv, "\ncorner.x,m,1,0,0,"));
  CHECK(contains(csv, "stop.force,N,0,0,"));
  const auto json = nlohmann::json::parse(to_json(d));
  CHECK(json.at("same_bits") == false);
  CHECK(json.at("first").at("where") == "stop.force");
  CHECK(json.at("first").at("time") == 1);
  REQUIRE(json.at("columns").size() == 4);
  CHECK(json.at("columns")[0].at("name") == "stop.force");
  CHECK(json.at("columns")[0].at("l2").get<double>() == doctest::Approx(10 / std::sqrt(3)).epsilon(1e-14));
  CHECK(json.at("columns")[0].at("relative_l2").is_null());  // of 0: there is none
}

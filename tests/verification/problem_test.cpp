#include "udar/verification/problem.hpp"

#include <doctest/doctest.h>

#include <set>
#include <stdexcept>

#include "udar/base/error.hpp"
#include "udar/verification/run_problems.hpp"

using namespace udar;
using namespace udar::verification;

TEST_CASE("what a part throws is a check that fails") {
  const VerifiedPart part = run_part({.name = "p", .check = [](Checks& checks) {
                                        checks.holds("first", true);
                                        throw NumericalError("element 7 has turned over");
                                      }});
  REQUIRE(part.rows.size() == 2);
  CHECK(part.rows[0].holds);
  CHECK_FALSE(part.rows[1].holds);
  CHECK(part.rows[1].what == "goes to its end (element 7 has turned over)");
}

TEST_CASE("a part that checks nothing fails") {
  const VerifiedPart part = run_part({.name = "p", .check = [](Checks&) {}});
  REQUIRE(part.rows.size() == 1);
  CHECK_FALSE(part.rows[0].holds);
}

TEST_CASE("every problem has a name, a title, a page and parts of its own") {
  std::set<std::string> names;
  const std::vector<Problem> problems = all_problems();
  for (const Problem& problem : problems) {
    CAPTURE(problem.id);
    CHECK(names.insert(problem.id).second);
    CHECK(problem.title.size() > 5);
    CHECK(problem.title != problem.id);
    CHECK(problem.text.size() > 200);
    CHECK_FALSE(problem.parts.empty());
    std::set<std::string> parts;
    for (const Part& part : problem.parts) CHECK_MESSAGE(parts.insert(part.name).second, part.name);
    CHECK_FALSE(title_of(problem.topic).empty());
  }
  for (std::size_t i = 1; i < problems.size(); ++i) CHECK(problems[i - 1].topic <= problems[i].topic);
}

TEST_CASE("problems are chosen by name") {
  const auto chosen = choose_problems({"two-bars", "simple-shear"}, Which::quick);
  REQUIRE(chosen.size() == 2);
  CHECK(chosen[0].id == "two-bars");
  CHECK(chosen[0].parts.size() == 2);
  CHECK(choose_problems({"two-bars"}, Which::all)[0].parts.size() == 3);
  CHECK(choose_problems({"two-bars"}, Which::only_long)[0].parts.size() == 1);
  CHECK(choose_problems({"simple-shear"}, Which::only_long).empty());
  CHECK_THROWS_WITH_AS(choose_problems({"two-bar"}, Which::quick), doctest::Contains("did you mean `two-bars`?"),
                       UserError);
  CHECK_THROWS_WITH_AS(choose_problems({"xyz"}, Which::quick), doctest::Contains("--list"), UserError);
}

TEST_CASE("cases come from the program, with changes") {
  const Case input = load("two-bars/two-bars.toml", {"run.end_time=1 s"});
  CHECK(input.run.end_time == 1);
  CHECK(input.bodies.size() == 2);
  CHECK_NOTHROW(load("cases/short-beam/short-beam.toml"));
  CHECK_THROWS_AS(load("two-bars/none.toml"), std::logic_error);
  CHECK_THROWS_AS(load("two-bars/two-bars.toml", {"run.end=1 s"}), UserError);
}

TEST_CASE("problems run side by side, and each tells what its parts found") {
  std::vector<Problem> problems(3);
  for (std::size_t k = 0; k < problems.size(); ++k) {
    problems[k].id = std::to_string(k);
    for (int part = 0; part < 5; ++part) {
      problems[k].parts.push_back({std::to_string(part), [k, part](Checks& checks) {
                                     checks.equal("number", static_cast<double>(10 * k) + part, 11);
                                   }});
    }
  }
  for (const int cores : {1, 4, 40}) {
    ProblemRuns runs(problems, cores);
    runs.finish();
    CHECK(runs.parts() == 15);
    CHECK(runs.parts_done() == 15);
    std::size_t held = 0;
    for (std::size_t k = 0; k < runs.count(); ++k) {
      REQUIRE(runs.is_done(k));
      REQUIRE(runs.result(k).parts.size() == 5);
      for (int part = 0; part < 5; ++part) {
        CHECK(runs.result(k).parts[static_cast<std::size_t>(part)].rows.at(0).computed ==
              static_cast<double>(10 * k) + part);
      }
      held += count_of(runs.result(k)).held;
    }
    CHECK(held == 1);
  }
}

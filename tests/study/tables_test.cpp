#include "udar/study/tables.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "udar/base/error.hpp"
#include "udar/study/headlines.hpp"

using namespace udar;

namespace {

Study small_study() {
  Study study{.kind = "converge",
              .version = "udar 1",
              .case_name = "a|b",
              .meshes = 3,
              .mesh_ratio = 2,
              .element_sizes = {0.01, 0.005, 0.0025},
              .steps = 2,
              .tolerance = 0.02};
  study.runs = {{.name = "mesh1-step1", .state = "failed", .reason = "the energy is off"},
                {.name = "mesh2-step1", .mesh = 1, .state = "done", .verdict = "good", .elements = 8, .steps = 100},
                {.name = "mesh3-step1", .mesh = 2, .state = "done", .verdict = "good", .elements = 32, .steps = 200}};
  StudyQuantity touch{
      .name = "contacts.stop.duration_99", .unit = "s", .values = {no_number, 1.4e-3, 1.38e-3}, .value = 1.38e-3};
  touch.mesh = {.values = {1.4e-3, 1.38e-3},
                .differences = {0.015},
                .order = 1,
                .extrapolated = 1.36e-3,
                .error = 3.1e-5,
                .verdict = "converging",
                .reason = "r"};
  touch.step = {.values = {}, .differences = {}, .error = 2.1e-6, .verdict = "converged"};
  touch.verdict = "converging";
  study.quantities.push_back(touch);
  StudyQuantity force{.name = "contacts.a,b.peak_force", .unit = "N", .values = {1, 2, 4}, .value = 4};
  force.mesh = {.values = {1, 2, 4}, .differences = {0.5, 0.5}, .verdict = "not converging"};
  force.verdict = "not converging";
  study.quantities.push_back(force);
  study.histories.push_back(
      {.name = "corner.displacement_y",
       .unit = "m",
       .size = 0.012,
       .mesh_l2 = {.differences = {0.04, 0.01}, .order = 2, .error = 0.0042, .verdict = "converged"},
       .mesh_max = {.differences = {0.05, 0.02}}});
  return study;
}

}  // namespace

TEST_CASE("study.json gives back the study") {
  Study study = small_study();
  study.headlines = {"x = 1 ± 2"};
  const Study back = study_from_json(to_json(study));
  CHECK(to_json(back) == to_json(study));
  CHECK(back.runs[0].reason == "the energy is off");
  CHECK(back.runs[2].mesh == 2);
  CHECK(back.quantities[0].values[0] != back.quantities[0].values[0]);
  CHECK(back.quantities[0].mesh.error == 3.1e-5);
  CHECK(back.histories[0].mesh_l2.differences == std::vector<double>{0.04, 0.01});
  CHECK(back.headlines == study.headlines);
  CHECK_THROWS_AS(study_from_json("{}"), OutputError);
  CHECK_THROWS_AS(study_from_json(R"({"schema": 2})"), OutputError);
  CHECK_THROWS_AS(study_from_json(R"({"schema": 1, "runs": 3})"), OutputError);
  CHECK_THROWS_AS(study_from_json("udar"), OutputError);
}

TEST_CASE("study.csv has every number of every run") {
  const std::string text = to_csv(small_study());
  CHECK(text ==
        "name,unit,mesh1-step1,mesh2-step1,mesh3-step1,mesh order,mesh extrapolated,mesh error,mesh verdict,step order,"
        "step extrapolated,step error,step verdict\n"
        "contacts.stop.duration_99,s,,0.0014,0.00138,1,0.00136,3.1e-05,converging,,,2.1e-06,converged\n"
        "\"contacts.a,b.peak_force\",N,1,2,4,,,,not converging,,,,\n");
}

TEST_CASE("study.md keeps names from being markup") {
  const std::string text = to_markdown(small_study());
  CHECK(text.find("# a\\|b: convergence") != std::string::npos);
  CHECK(text.find("| mesh1-step1 | failed: the energy is off |") != std::string::npos);
  // The coarse level that failed has no value.
  CHECK(text.find("| contacts.stop.duration_99 | ms | – | 1.4 | 1.38 | 1.5 % | 1 | 1.36 | 0.031 | converging | r |") !=
        std::string::npos);
  CHECK(text.find("| corner.displacement_y | 12 mm | 4 % → 1 % | 2 % | 2 | 0.42 % | converged |  |") !=
        std::string::npos);
}

TEST_CASE("headlines have as many digits as the error leaves") {
  Study study = small_study();
  mark_headlines(study, {"duration_99", "peak_force"});
  REQUIRE(study.headlines.size() == 2);
  CHECK(study.headlines[0] ==
        "contact time (to 99 % of the push) of stop = 1.380 ms ± 0.031 ms (mesh) ± 0.0021 ms (step)");
  CHECK(study.headlines[1] == "peak force of a,b = 4.000 N, not converging with the mesh (last change 50 %)");
  CHECK(study.quantities[0].headline);
  StudyQuantity q{.name = "x", .unit = "m", .value = 0.0402};
  q.mesh = {.error = 0, .verdict = "converged"};
  q.step = {.error = 3e-9, .verdict = "converged"};
  CHECK(headline_of(q) == "x = 40.2000 mm ± 0 (mesh) ± 0.0030 µm (step)");
  Study other = small_study();
  other.quantities[0].window = "0 to 2 ms";
  mark_headlines(other, {"stop.duration_9"});
  REQUIRE(other.warnings.size() == 1);
  CHECK(other.warnings[0] == "no run has a number `stop.duration_9`; did you mean `stop.duration_99`?");
  REQUIRE(other.headlines.size() == 1);  // the usual one
  CHECK(other.headlines[0].starts_with("contact time (to 99 % of the push) of stop, 0 to 2 ms = "));
}

TEST_CASE("what a number is in words") {
  CHECK(words_of("contacts.stop.duration") == "contact time of stop");
  CHECK(words_of("contacts.stop.episodes.1.restitution") == "restitution of stop, episode 2");
  CHECK(words_of("histories.corner.displacement_y.min") == "smallest displacement y of corner");
  CHECK(words_of("histories.a.b.velocity_x.last") == "last velocity x of a.b");
  CHECK(words_of("ledger.plastic") == "energy dissipated by plastic flow");
  CHECK(words_of("ledger.ties") == "ledger.ties");
  CHECK(words_of("energy_error") == "energy error");
}

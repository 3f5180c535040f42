#include "udar/study/plan.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

#include "tests/results/scratch.hpp"
#include "udar/base/error.hpp"
#include "udar/case/case_file.hpp"

using namespace udar;

namespace {

constexpr const char* two_bodies = R"(
[run]
end_time = "1 us"
[materials.steel]
law = "elastic"
density = "7850 kg/m^3"
young_modulus = "200 GPa"
poisson_ratio = 0.3
[bodies.plate]
material = "steel"
mesh = { shape = "rectangle", size = ["4 cm", "2 cm"], element_size = "1 cm" }
[bodies.ball]
material = "steel"
mesh = { shape = "disc", radius = "1 cm", at = ["2 cm", "5 cm"], element_size = "5 mm", finest_size = "1 mm", finest_at = ["2 cm", "4 cm"] }
)";

StudyInput input_in(const std::filesystem::path& folder) {
  std::ofstream(folder / "two.toml") << two_bodies;
  return {.file = folder / "two.toml", .assignments = {}};
}

const BodyCase& body(const Case& c, const std::string& name) {
  for (const BodyCase& b : c.bodies) {
    if (b.name == name) return b;
  }
  throw std::out_of_range(name);
}

}  // namespace

TEST_CASE("levels divide every size of elements, and the step") {
  const Scratch scratch;
  const StudyInput input = input_in(scratch.path);
  const auto plan = plan_convergence(input, {.meshes = 3, .ratio = 2, .steps = 2});
  REQUIRE(plan.size() == 6);
  for (const PlannedRun& run : plan) {
    CAPTURE(run.name);
    const Case c = load_case(input.file, run.changes);
    const double part = std::pow(0.5, run.mesh);
    CHECK(std::get<RectangleMesh>(body(c, "plate").mesh).element_size == doctest::Approx(0.01 * part).epsilon(1e-15));
    const auto& disc = std::get<DiscMesh>(body(c, "ball").mesh);
    CHECK(disc.element_size == doctest::Approx(0.005 * part).epsilon(1e-15));
    CHECK(*disc.finest_size == doctest::Approx(0.001 * part).epsilon(1e-15));
    CHECK(c.run.step_safety == doctest::Approx(0.9 * std::pow(0.5, run.step)).epsilon(1e-15));
    CHECK(run.resolved == to_toml(c));
  }
  CHECK(plan[0].changes.empty());
  CHECK(plan[4].cost == doctest::Approx(64 * plan[0].cost));
  CHECK(plan[5].cost == doctest::Approx(2 * plan[4].cost));
  CHECK(element_sizes(input, {.meshes = 2, .ratio = 4, .steps = 1}) == std::vector<double>{0.01, 0.0025});
}

TEST_CASE("a fixed step follows the elements") {
  const Scratch scratch;
  StudyInput input = input_in(scratch.path);
  input.assignments = {"run.time_step=1e-8 s"};
  for (const PlannedRun& run : plan_convergence(input, {.meshes = 2, .ratio = 4, .steps = 3})) {
    std::vector<std::string> all = input.assignments;
    all.insert(all.end(), run.changes.begin(), run.changes.end());
    const double expected = 1e-8 * std::pow(0.25, run.mesh) * std::pow(0.5, run.step);
    CHECK(*load_case(input.file, all).run.time_step == doctest::Approx(expected).epsilon(1e-15));
  }
}

TEST_CASE("a level that cannot be is refused before anything runs") {
  const Scratch scratch;
  StudyInput input = input_in(scratch.path);
  CHECK_THROWS_AS(plan_convergence(input, {.meshes = 8, .ratio = 16, .steps = 1}), UserError);
  input.assignments = {"bodies.plate.mesh.element_size=3 cm"};
  CHECK_THROWS_AS(plan_convergence(input, {}), UserError);
}

TEST_CASE("values to vary") {
  const auto values = [](const std::string& text) { return read_variation("a.b=" + text).values; };
  using Values = std::vector<std::string>;
  CHECK(read_variation("a.b=1,2").path == "a.b");
  CHECK(values("1,2.5, 3") == Values{"1", "2.5", "3"});
  CHECK(values("0:0.3:0.1") == Values{"0", "0.1", "0.2", "0.3"});
  CHECK(values("1:3:1 mm") == Values{"1 mm", "2 mm", "3 mm"});
  CHECK(values("3:1:-1,7") == Values{"3", "2", "1", "7"});
  CHECK(values("0:1:0.4") == Values{"0", "0.4", "0.8"});
  CHECK(values(R"(["0 m", "1 m"],["2 m", "3 m"])") == Values{R"(["0 m", "1 m"])", R"(["2 m", "3 m"])"});
  CHECK(values(R"("a, b",c)") == Values{R"("a, b")", "c"});
  for (const char* bad : {"a.b", "=1", "a.b=", "a.b=1,,2", "a.b=1,1", "a.b=0:1:0", "a.b=0:1:-1", "a.b=0:1:1e-9",
                          "a.b=1:2 cm", "a.b=-20 m/s:-80 m/s:-20 m/s"}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(read_variation(bad), UserError);
  }
}

TEST_CASE("a sweep has every combination, the last one fastest") {
  const Scratch scratch;
  const StudyInput input = input_in(scratch.path);
  const auto plan = plan_sweep(input, {read_variation("bodies.plate.thickness=1 cm,2 cm"),
                                       read_variation("materials.steel.poisson_ratio=0:0.2:0.1")});
  REQUIRE(plan.size() == 6);
  CHECK(plan[4].name == "run-5");
  CHECK(plan[4].texts == std::vector<std::string>{"2 cm", "0.1"});
  CHECK(plan[4].changes ==
        std::vector<std::string>{"bodies.plate.thickness=2 cm", "materials.steel.poisson_ratio=0.1"});
  CHECK_THROWS_AS(plan_sweep(input, {read_variation("bodies.plate.thicknes=1 cm")}), UserError);
  CHECK_THROWS_AS(plan_sweep(input, {read_variation("bodies.plate.thickness=1 cm"), read_variation("bodies.plate=3")}),
                  UserError);
  CHECK_THROWS_AS(
      plan_sweep(input, {read_variation("bodies.plate.thickness=1 cm"), read_variation("bodies.plate.thickness=2 cm")}),
      UserError);
  const Variation many = read_variation("bodies.plate.thickness=1:200:1 mm");
  CHECK_THROWS_AS(plan_sweep(input, {many, read_variation("materials.steel.poisson_ratio=0:0.4:0.001")}), UserError);
}

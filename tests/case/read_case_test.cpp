#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "tests/case/example.hpp"
#include "udar/case/reference.hpp"

namespace udar {
namespace {

TEST_CASE("the short beam is read as it is written") {
  const Case c = read_case(short_beam, "short-beam.toml");
  CHECK(c.run.end_time == 0.002);
  CHECK(c.run.integrator == Integrator::central_difference);
  CHECK_FALSE(c.run.time_step.has_value());
  CHECK(c.run.gravity == Vec2{0, -9.81});
  CHECK(c.run.step_safety == RunSettings{}.step_safety);

  REQUIRE(c.materials.size() == 1);
  CHECK(c.materials[0].name == "steel");
  CHECK(c.materials[0].density == 7850);
  const auto& steel = std::get<Tresca>(c.materials[0].law);
  CHECK(steel.young_modulus == 1.96133e11);
  CHECK(steel.poisson_ratio == 0.25);
  CHECK(steel.yield_stress == 235359600);

  REQUIRE(c.bodies.size() == 1);
  CHECK(c.bodies[0].name == "beam");
  CHECK(c.bodies[0].material == "steel");
  CHECK(c.bodies[0].thickness == 0.01);
  CHECK(c.bodies[0].velocity == Vec2{0, -80});
  const auto& mesh = std::get<RectangleMesh>(c.bodies[0].mesh);
  CHECK(mesh.size == Vec2{0.4, 0.1});
  CHECK(mesh.at == Vec2{-0.2, 0});
  CHECK(mesh.element_size == 0.0025);
  CHECK(mesh.diagonals == RectangleMesh::Diagonals::alternating);

  REQUIRE(c.obstacles.size() == 1);
  const auto& stop = std::get<Polygon>(c.obstacles[0].shape);
  CHECK(stop.points == std::vector<Vec2>{{-0.03, 0}, {-0.23, -0.2}, {0.23, -0.2}, {0.03, 0}});
  CHECK(c.obstacles[0].friction == 0.35);
  CHECK(c.obstacles[0].stiffness == 1961330000);
  CHECK_FALSE(c.obstacles[0].tangential_stiffness.has_value());

  REQUIRE(c.observed_nodes.size() == 1);
  CHECK(c.observed_nodes[0].name == "corner");
  CHECK(c.observed_nodes[0].at == Vec2{-0.2, 0.1});
  CHECK(c.output.fields_every == 2e-5);
  CHECK_FALSE(c.output.histories_every.has_value());
}

TEST_CASE("everything else of the vocabulary is read") {
  const Case c = read_case(R"(
[run]
end_time = "1 s"
integrator = "adams2"
time_step = "1 us"
when_unstable = "continue"
damping = { rate = "50 1/s", against = "mean_motion", factor = { times = ["0 s", "1 s"], values = [1, 0] } }
[contact]
damping = 0.1
friction = 0.2
stiffness = "3 MN/m"
[[contact.pairs]]
body = "wheel"
other = "wheel"
touch = "no"
[materials.rubber]
law = "elastic"
density = "1100 kg/m^3"
young_modulus = "50 MPa"
poisson_ratio = 0.4
[bodies.wheel]
material = "rubber"
spin = "60 rpm"
cosine_mode = { amplitude = ["0 m/s", "1 m/s"], wave_vector = ["3 rad/m", "0 1/m"] }
mesh = { shape = "ring", outer_radius = "10 cm", inner_radius = "5 cm", element_size = "1 cm", turn = "180 deg" }
[obstacles.floor]
shape = "half_plane"
point = ["0 m", "-10 cm"]
stiffness = "auto"
velocity = ["1 m/s", "0 m/s"]
[supports.hub]
body = "wheel"
nodes = { side = "inner" }
move_x = "0 m"
move_y = { times = ["0 s", "1 ms"], values = ["0 m", "1 mm"], shape = "smooth" }
[supports.axle]
body = "wheel"
nodes = { box = [["-1 cm", "-1 cm"], ["1 cm", "1 cm"]] }
turn = { about = ["0 m", "1 m"], angle = "30 deg" }
[loads.push]
body = "wheel"
nodes = { point = ["10 cm", "0 cm"] }
force = ["1 kN", "0 N"]
factor = 2
[loads.wind]
body = "wheel"
edges = { side = "outer" }
pressure = "1 bar"
[loads.shear]
body = "wheel"
edges = { line = [["0 m", "0 m"], ["1 m", "0 m"]] }
traction = ["1 kPa", "0 Pa"]
[[observe.elements]]
name = "rim"
body = "wheel"
at = ["9 cm", "0 cm"]
window = ["1 ms", "end"]
[[observe.regions]]
name = "half"
body = "wheel"
polygon = [["0 m", "-1 m"], ["1 m", "-1 m"], ["1 m", "1 m"], ["0 m", "1 m"]]
window = ["0 s", "0.52 ms"]
[output]
fields_at = ["0 s", "0.5 s"]
histories_every = "1 ms"
)",
                           "wheel.toml");
  CHECK(c.run.integrator == Integrator::adams2);
  CHECK(c.run.time_step == 1e-6);
  CHECK(c.run.when_unstable == WhenUnstable::carry_on);
  CHECK(c.run.damping.rate == 50);
  CHECK(c.run.damping.against == MassDamping::Against::mean_motion);
  CHECK(c.run.damping.factor.values == std::vector<double>{1, 0});
  CHECK(c.contact.damping == 0.1);
  CHECK(c.contact.friction == 0.2);
  CHECK(*c.contact.stiffness == 3e6);
  REQUIRE(c.contact_pairs.size() == 1);
  CHECK(c.contact_pairs[0].other == "wheel");
  CHECK(c.contact_pairs[0].touch == ContactPairCase::Touch::no);
  CHECK(!c.contact_pairs[0].friction);
  CHECK(c.bodies[0].spin == doctest::Approx(6.283185307));
  CHECK(c.bodies[0].cosine_mode->wave_vector == Vec2{3, 0});
  CHECK(std::get<RingMesh>(c.bodies[0].mesh).inner_radius == 0.05);
  CHECK(std::get<HalfPlane>(c.obstacles[0].shape).normal == Vec2{0, 1});
  CHECK_FALSE(c.obstacles[0].stiffness.has_value());
  CHECK(c.supports[0].nodes.body == "wheel");
  CHECK(c.supports[0].nodes.side == "inner");
  CHECK(c.supports[0].move_x->at(7) == 0);
  CHECK(c.supports[0].move_y->shape == TimeTable::Shape::smooth);
  CHECK_FALSE(c.supports[0].turn.has_value());
  CHECK(c.supports[1].turn_about == Vec2{0, 1});
  CHECK(c.supports[1].turn->at(0) == doctest::Approx(0.5235987756));
  CHECK(c.loads[0].kind == LoadCase::Kind::force);
  CHECK(c.loads[0].value == Vec2{1000, 0});
  CHECK(c.loads[0].where.point == Vec2{0.1, 0});
  CHECK(c.loads[0].factor.at(3) == 2);
  CHECK(c.loads[1].kind == LoadCase::Kind::pressure);
  CHECK(c.loads[1].pressure == 1e5);
  CHECK(c.loads[2].kind == LoadCase::Kind::traction);
  CHECK(c.observed_elements[0].window.begin == 0.001);
  CHECK(c.observed_elements[0].window.end == Window{}.end);
  CHECK(c.observed_regions[0].window.end == 0.00052);
  CHECK(c.observed_regions[0].polygon.size() == 4);
  CHECK(c.output.fields_at == std::vector<double>{0, 0.5});
}

TEST_CASE("things keep the order of the file") {
  std::string text(short_beam);
  for (const char* name : {"zeta", "alpha", "mid"})
    text += std::string("[obstacles.") + name + "]\nshape = \"half_plane\"\npoint = [\"0 m\", \"-1 m\"]\n";
  const Case c = read_case(text, "order.toml");
  CHECK(c.obstacles[0].name == "stop");
  CHECK(c.obstacles[1].name == "zeta");
  CHECK(c.obstacles[2].name == "alpha");
  CHECK(c.obstacles[3].name == "mid");
}

TEST_CASE("a byte order mark, CR LF and comments in any language are taken") {
  std::string text = "\xef\xbb\xbf# \u0431\u0430\u043b\u043a\u0430 \U0001f600\r\n";
  for (const char c : short_beam) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  CHECK(to_toml(read_case(text, "windows.toml")) == to_toml(read_case(short_beam, "short-beam.toml")));
}

TEST_CASE("the example of the documentation has nothing to complain of") {
  std::vector<Diagnostic> warnings;
  CHECK_NOTHROW(read_case(example_case(), "example.toml", {}, &warnings));
  CHECK(warnings.empty());
}

TEST_CASE("what is possible but hardly meant is a warning") {
  std::vector<Diagnostic> warnings;
  read_case(beam_with("2e6 kgf/cm^2", "210 kPa"), "soft.toml", {}, &warnings);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].message == "the wave speed of \"steel\" is 5.67 m/s");
  CHECK(warnings[0].cure.find("did you mean GPa?") != std::string::npos);
  CHECK(warnings[0].line == 6);

  read_case(
      std::string(short_beam) +
          "[materials.air]\nlaw = \"elastic\"\ndensity = \"1 kg/m^3\"\nyoung_modulus = \"1 GPa\"\npoisson_ratio = 0\n",
      "two.toml", {}, &warnings);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].message == "the wave speed of \"air\" is 3.16e+04 m/s");

  read_case(beam_with("\"20 us\"", "\"1 ns\"\nfields_at = [\"3 ms\"]"), "many.toml", {}, &warnings);
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[0].message == "very many pictures of the fields");
  CHECK(warnings[1].message == "fields are asked for after the end");
}

TEST_CASE("files that cannot be read are refused with their name") {
  const auto complaint = [](const std::filesystem::path& file) -> std::string {
    try {
      load_case(file);
      return "";
    } catch (const UserError& error) {
      CHECK(error.code == ExitCode::bad_case);
      return error.what();
    }
  };
  const auto folder = std::filesystem::temp_directory_path() / "udar-read-case-test";
  std::filesystem::create_directories(folder);
  CHECK(complaint(folder / "none.toml").find("there is no such case file") != std::string::npos);
  CHECK(complaint(folder / "none.toml").find("none.toml") != std::string::npos);
  CHECK(complaint(folder).find("this is a folder") != std::string::npos);

  const auto file = folder / "two words.toml";
  std::ofstream(file) << short_beam;
  CHECK(complaint(file).empty());
  std::ofstream(file) << std::string(2 << 20, '#');
  CHECK(complaint(file).find("the case is too large") != std::string::npos);
  std::filesystem::remove_all(folder);
}

TEST_CASE("a case built in code is held to the same rules") {
  Case c = read_case(short_beam, "short-beam.toml");
  CHECK_NOTHROW(check_case(c));
  c.bodies[0].thickness = -1;
  c.bodies[0].material = "stel";
  c.run.gravity.y = std::numeric_limits<double>::quiet_NaN();
  c.materials.push_back(c.materials[0]);
  std::get<Polygon>(c.obstacles[0].shape).points.clear();
  c.observed_nodes[0].name = "../corner";
  try {
    check_case(c);
    FAIL("no mistake was found");
  } catch (const UserError& error) {
    const std::string text = error.what();
    for (const char* part :
         {"impossible value for `thickness` (`bodies.beam.thickness`)", "this is -1 m",
          "there is no material \"stel\" (`bodies.beam.material`)", "did you mean \"steel\"?", "`run.gravity.1`",
          "the name \"steel\" is taken", "obstacles.stop.points", "impossible name"}) {
      INFO(text);
      CHECK(text.find(part) != std::string::npos);
    }
    CHECK(error.diagnostics.size() == 6);
  }
  CHECK_THROWS_AS(check_case(Case{}), UserError);
}

}  // namespace
}  // namespace udar

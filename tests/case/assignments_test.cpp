#include <doctest/doctest.h>

#include <utility>

#include "tests/case/example.hpp"

namespace udar {
namespace {

TEST_CASE("assignments replace values of the file") {
  const std::vector<std::string> assignments{"bodies.beam.mesh.element_size=0.5 cm",
                                             "run.end_time=\"1 ms\"",
                                             "obstacles.stop.friction=0.1",
                                             "observe.nodes.0.at=[\"1 cm\", \"2 cm\"]",
                                             "output.fields_at=[\"1 us\"]",
                                             "contact.damping=0.2",
                                             "run.integrator=adams",
                                             "run.gravity.1=-1 m/s^2"};
  const Case c = read_case(short_beam, "short-beam.toml", assignments);
  CHECK(std::get<RectangleMesh>(c.bodies[0].mesh).element_size == 0.005);
  CHECK(c.run.end_time == 0.001);
  CHECK(c.obstacles[0].friction == 0.1);
  CHECK(c.observed_nodes[0].at == Vec2{0.01, 0.02});
  CHECK(c.output.fields_at == std::vector<double>{1e-6});
  CHECK(c.contact.damping == 0.2);
  CHECK(c.run.integrator == Integrator::adams);
  CHECK(c.run.gravity == Vec2{0, -1});
}

TEST_CASE("every bad assignment is refused by its name") {
  const std::vector<std::pair<std::string, std::vector<std::string>>> all{
      {"run.end_time", {"unreadable assignment", "key=value is needed"}},
      {"=3", {"unreadable assignment"}},
      {"", {"unreadable assignment"}},
      {"run..end_time=3", {"unreadable key", "--set:1:5"}},
      {"run.end time=3", {"unreadable key", "--set:1:5"}},
      {"run.end_tme=2 s", {"unknown key `end_tme`", "--set:1:5", "did you mean `end_time`?"}},
      {"run.end_time=3", {"missing unit for `end_time`", "--set:1:14", "write \"3 s\""}},
      {"run.end_time=3 m", {"wrong unit for `end_time`", "--set:1:14"}},
      {"run.end_time.x=3 m", {"there is no `x`", "--set:1:14", "this is below a text"}},
      {"observe.nodes.1.at=3", {"there is no `1`", "--set:1:15", "the list has 1 items"}},
      {"observe.nodes.x.at=3", {"there is no `x`"}},
      {"observe.nodes.0.at=[\"1 m\"", {"this is not TOML", "--set:1:"}},
      {"observe.nodes.0.at=[\"1 m\", \"2 s\"]", {"wrong unit for `at`", "--set:1:28"}},
      {"bodies.plate.material=steel", {"missing key `mesh`", "--set:1:8"}},
      {"run.end_time=1\nx=2", {"for `end_time`"}},
      {"run.end_time=\x1b[31m", {"for `end_time`"}},
      {repeated("a.", 50) + "a=1", {"key with too many parts"}},
  };
  for (const auto& [assignment, said] : all) {
    const std::string text = complaints(short_beam, {assignment});
    CAPTURE(text);
    for (const std::string& part : said) {
      CAPTURE(part);
      CHECK(text.find(part) != std::string::npos);
    }
    CHECK(text.find('\x1b') == std::string::npos);
  }
}

}  // namespace
}  // namespace udar

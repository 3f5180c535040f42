// Cases that read well but cannot start: each is refused with what is wrong and what to do.

#include <doctest/doctest.h>

#include "tests/results/scratch.hpp"
#include "tests/simulation/example.hpp"
#include "udar/simulation/simulation.hpp"

namespace udar {
namespace {

/// What the user is told when the case is run.
std::string refusal_of(const Case& input) {
  try {
    Simulation(input).run();
  } catch (const UserError& error) {
    CHECK(error.code == ExitCode::bad_case);
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a body may start on its springs but not inside an obstacle") {
  Case input = falling_block();
  input.run.end_time = 1e-6;
  const double element = std::get<RectangleMesh>(input.bodies[0].mesh).element_size;
  auto& mesh = std::get<RectangleMesh>(input.bodies[0].mesh);
  const double touching = mesh.at.y;
  mesh.at.y = touching - 0.1 * element;
  CHECK(refusal_of(input).empty());
  mesh.at.y = touching - 0.5 * element;
  const std::string told = refusal_of(input);
  CHECK(contains(told, "body `block` starts inside obstacle"));
  CHECK(contains(told, "move the body"));
}

TEST_CASE("a fixed step that would never reach the end is refused") {
  Case input = falling_block();
  input.run.time_step = 1e-13 * input.run.end_time;
  CHECK(contains(refusal_of(input), "would take 1e+13 steps"));
}

TEST_CASE("a node observer far from the body is refused, one beside it is not") {
  Case input = falling_block();
  input.run.end_time = 1e-6;
  const auto& mesh = std::get<RectangleMesh>(input.bodies[0].mesh);
  input.observed_nodes = {{.name = "near", .body = "block", .at = mesh.at - Vec2{0.5 * mesh.element_size, 0}}};
  CHECK(refusal_of(input).empty());
  input.observed_nodes[0].at = {10, 0};
  CHECK(contains(refusal_of(input), "has no node near (10, 0) m"));
}

}  // namespace udar

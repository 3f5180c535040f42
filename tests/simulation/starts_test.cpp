// Cases that read well but cannot start: each is refused with what is wrong and what to do.

#include <doctest/doctest.h>

#include <cmath>

#include "tests/results/scratch.hpp"
#include "tests/simulation/example.hpp"
#include "udar/case/build_model.hpp"
#include "udar/simulation/simulation.hpp"
#include "udar/step/step.hpp"

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

/// The mesh of a block cut open along the line y = `height` from its left end to x = `tip`; both lips lie on the line.
Mesh slit_mesh(const RectangleMesh& shape, double height, double tip) {
  Mesh mesh = generate(shape);
  mesh.sides.clear();
  std::vector<Index> upper(mesh.nodes.size());
  for (Index i = 0; i < upper.size(); ++i) {
    upper[i] = i;
    if (std::fabs(mesh.nodes[i].y - height) > 1e-9 || mesh.nodes[i].x > tip - 1e-9) continue;
    upper[i] = static_cast<Index>(mesh.nodes.size());
    mesh.nodes.push_back(mesh.nodes[i]);
    mesh.node_numbers.push_back(upper[i]);
  }
  for (auto& t : mesh.triangles) {
    if (mesh.nodes[t[0]].y + mesh.nodes[t[1]].y + mesh.nodes[t[2]].y < 3 * height) continue;
    for (Index& corner : t) corner = upper[corner];
  }
  return mesh;
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

TEST_CASE("a slit of no width is refused with its place, unless the body is not to touch itself") {
  Case input = falling_block();
  input.run.end_time = 20e-6;
  const Mesh mesh = slit_mesh(std::get<RectangleMesh>(input.bodies[0].mesh), 0.01, 0);
  const auto run = [&] {
    const Model model = build_model(input, {mesh});
    Workspace work(model, 1);
    State state = start(model, work);
    while (!finished(model, state)) step(model, state, work);
    return state;
  };
  try {
    run();
    FAIL("not refused");
  } catch (const UserError& error) {
    CHECK(error.code == ExitCode::bad_case);
    const std::string told = error.what();
    CHECK(contains(told, "body `block` touches itself at (-0.0"));
    CHECK(contains(told, ", 0.01) m: its boundary lies on itself there, a gap of no width"));
    CHECK(contains(told, "open the gap, or join its two sides"));
  }
  input.contact_pairs = {{.body = "block", .other = "block", .touch = ContactPairCase::Touch::no}};
  const State state = run();
  CHECK(state.touches.empty());
  CHECK(state.ledger.identity_error() < 1e-11);
}

}  // namespace udar

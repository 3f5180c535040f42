#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/simulation/varied_cases.hpp"
#include "udar/case/build_model.hpp"
#include "udar/case/case_file.hpp"

namespace udar {

/// A case whose bits are written down in golden_hashes.txt, after these steps.
struct GoldenCase {
  std::string name;
  std::function<Case()> input;
  std::vector<int> steps;
};

namespace golden {

inline BodyCase block(const char* name, const char* material, const MeshShape& mesh, Vec2 velocity = {}) {
  return {.name = name, .material = material, .thickness = 0.01, .velocity = velocity, .mesh = mesh};
}

/// A shipped case with coarser meshes and whatever else makes its events come early.
inline Case shipped(const std::string& name, const std::vector<std::string>& changes) {
  return load_case(std::string(UDAR_SOURCE_DIR) + "/cases/" + name, changes);
}

/// The stack, falling so fast that its blocks meet in a few hundred steps.
inline Case falling_stack() {
  Case input = shipped("stack/stack.toml", {});
  for (std::size_t k = 0; k < input.bodies.size(); ++k)
    input.bodies[k].velocity = {0.1 * static_cast<double>(k % 3), -3};
  input.bodies[3].spin = 20;
  return input;
}

/// A soft ring between two hammers folds until its walls meet.
inline Case folding_ring() {
  return {
      .run = {.end_time = 1},
      .contact = {.damping = 0.1, .friction = 0.3},
      .materials = {{.name = "soft",
                     .density = 7850,
                     .law = Tresca{.young_modulus = 2e9, .poisson_ratio = 0.3, .yield_stress = 6e6}}},
      .bodies = {block("ring", "soft", RingMesh{.outer_radius = 0.02, .inner_radius = 0.017, .element_size = 0.001}),
                 block("upper", "soft",
                       RectangleMesh{.size = {0.06, 0.01}, .at = {-0.03, 0.0201}, .element_size = 0.005}, {2, -60}),
                 block("lower", "soft",
                       RectangleMesh{.size = {0.05, 0.01}, .at = {-0.03, -0.0301}, .element_size = 0.0025}, {0, 60})}};
}

/// Two blocks of different meshes, tied, thrown as one piece and struck by a third; the tied one may be rigid.
inline Case tied_blocks(bool rigid) {
  Case input{
      .run = {.end_time = 1},
      .contact = {.friction = 0.3},
      .contact_pairs = {{.body = "upper", .other = "lower", .touch = ContactPairCase::Touch::tied}},
      .materials = {plastic_steel, aluminium},
      .bodies = {block("lower", "steel", RectangleMesh{.size = {0.04, 0.02}, .at = {-0.02, 0}, .element_size = 0.004},
                       {10, 5}),
                 block("upper", "aluminium",
                       RectangleMesh{.size = {0.03, 0.015}, .at = {-0.003, 0.02}, .element_size = 0.003}, {10, 5}),
                 block("hammer", "steel",
                       RectangleMesh{.size = {0.02, 0.02}, .at = {-0.015, 0.0352}, .element_size = 0.0025}, {0, -40})}};
  input.bodies[2].spin = 200;
  input.bodies[0].rigid = rigid;
  if (rigid) input.run.integrator = Integrator::adams;
  return input;
}

/// A block with sides of its own meets a wedge between its nodes; nothing but contact and gravity.
inline Case on_a_wedge() {
  return {
      .run = {.end_time = 1, .gravity = {0, -9.81}},
      .contact = {.damping = 0.1},
      .materials = {plastic_steel},
      .bodies = {block("block", "steel",
                       RectangleMesh{.size = {0.06, 0.03}, .at = {-0.03, 0.0001}, .element_size = 0.005}, {3, -20})},
      .obstacles = {{.name = "edge",
                     .shape = Polygon{.points = {{-0.004, -0.02}, {0.004, -0.02}, {0.001, 0}}},
                     .friction = 0.3,
                     .velocity = {0, 5}}}};
}

/// A bar pulled by a side that moves, pushed by a traction and a force, with damping against rest.
inline Case pulled_bar() {
  return {
      .run = {.end_time = 1, .gravity = {9.81, 0}, .damping = {.rate = 2000}},
      .materials = {plastic_steel},
      .bodies = {block(
          "bar", "steel",
          RectangleMesh{.size = {0.1, 0.02}, .element_size = 0.0025, .diagonals = RectangleMesh::Diagonals::left})},
      .supports = {{.name = "pull",
                    .nodes = {.body = "bar", .side = "right"},
                    .move_x =
                        TimeTable{.times = {0, 5e-5, 1}, .values = {0, 4e-4, 4e-4}, .shape = TimeTable::Shape::smooth}},
                   {.name = "rollers", .nodes = {.body = "bar", .side = "bottom"}, .move_y = TimeTable::constant(0)}},
      .loads = {{.name = "side", .where = {.body = "bar", .point = Vec2{0, 0.02}}, .value = {-3000, 500}},
                {.name = "top",
                 .kind = LoadCase::Kind::traction,
                 .where = {.body = "bar", .side = "top"},
                 .value = {1e6, -2e7},
                 .factor = {.times = {0, 3e-5}, .values = {0, 1}}}}};
}

/// A disc on a half-plane with steps of one length, which may have to be shortened.
inline Case fixed_steps(Integrator integrator, double time_step) {
  return {
      .run = {.end_time = 1, .integrator = integrator, .time_step = time_step, .when_unstable = WhenUnstable::carry_on},
      .materials = {aluminium},
      .bodies = {block("disc", "aluminium", DiscMesh{.radius = 0.02, .at = {0, 0.0201}, .element_size = 0.002},
                       {2, -10})},
      .obstacles = {{.name = "floor", .shape = HalfPlane{}, .friction = 0.4}}};
}

/// Two long plates with so many points near each other that all threads look for touches.
inline Case long_plates() {
  return {.run = {.end_time = 1},
          .contact = {.friction = 0.1},
          .materials = {plastic_steel, aluminium},
          .bodies = {
              block("lower", "steel", RectangleMesh{.size = {0.4, 0.01}, .at = {-0.2, -0.01}, .element_size = 0.001}),
              block("upper", "aluminium",
                    RectangleMesh{.size = {0.38, 0.01}, .at = {-0.19, 0.00002}, .element_size = 0.0009}, {20, -50})}};
}

}  // namespace golden

/// Every integrator, law, mesh, support, load and kind of contact is in at least one of them.
inline std::vector<GoldenCase> golden_cases() {
  using golden::shipped;
  const auto coarse = [](const char* file, const std::vector<std::string>& changes) {
    return [=] { return shipped(file, changes); };
  };
  return {
      {"short-beam", coarse("short-beam/short-beam.toml", {"bodies.beam.mesh.element_size=1 cm"}), {1, 100, 400}},
      {"flight", coarse("short-beam/flight.toml", {"bodies.beam.mesh.element_size=0.5 cm"}), {1, 100, 400}},
      {"two-plates",
       coarse("two-plates/two-plates.toml",
              {"bodies.resting.mesh.element_size=4 mm", "bodies.flying.mesh.element_size=4 mm"}),
       {1, 200, 500}},
      {"ring-crush", coarse("ring-crush/ring-crush.toml", {"bodies.ring.mesh.element_size=1.5 mm"}), {1, 150, 400}},
      {"stack", golden::falling_stack, {1, 100, 300}},
      {"hammer",
       coarse("hammer/hammer.toml", {"bodies.anvil.mesh.element_size=4 mm", "bodies.anvil.mesh.finest_size=2 mm",
                                     "bodies.hammer.mesh.element_size=5 mm"}),
       {1, 100, 400}},
      {"wedge",
       coarse("wedge/wedge.toml",
              {"bodies.block.mesh.finest_size=1 mm", "bodies.wedge.mesh.element_size=2 mm", "contact.friction=0.2"}),
       {1, 100, 300}},
      {"impact", impact, {1, 200}},
      {"spinning-ring", spinning_ring, {1, 100, 300}},
      {"crowd", crowd, {1, 300}},
      {"many-blocks", many_blocks, {1, 40}},
      {"folding-ring", golden::folding_ring, {1, 500, 1500}},
      {"tied-blocks", [] { return golden::tied_blocks(false); }, {1, 100, 300}},
      {"tied-to-a-rigid-body", [] { return golden::tied_blocks(true); }, {1, 100, 300}},
      {"on-a-wedge", golden::on_a_wedge, {1, 100, 300}},
      {"pulled-bar", golden::pulled_bar, {1, 100, 300}},
      {"adams2", [] { return golden::fixed_steps(Integrator::adams2, 1e-8); }, {1, 3, 300}},
      {"adams2-new-velocity", [] { return golden::fixed_steps(Integrator::adams2_new_velocity, 5e-8); }, {1, 3, 300}},
      {"long-plates", golden::long_plates, {1, 60}},
  };
}

}  // namespace udar

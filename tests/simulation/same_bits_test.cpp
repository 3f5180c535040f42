// The same bits for any number of threads and any instruction set: cases that have little in common.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/simulation/example.hpp"
#include "tests/step/kernels_here.hpp"
#include "tests/step/small_model.hpp"
#include "udar/case/build_model.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

const MaterialCase plastic_steel{.name = "steel",
                                 .density = 7850,
                                 .law = Tresca{.young_modulus = 196e9, .poisson_ratio = 0.25, .yield_stress = 235e6}};
const MaterialCase aluminium{
    .name = "aluminium", .density = 2700, .law = Elastic{.young_modulus = 70e9, .poisson_ratio = 0.33}};

/// A beam that falls on the corner of a polygon off its middle, flows and rubs.
Case impact() {
  return {.run = {.end_time = 1, .gravity = {0, -9.81}},
          .materials = {plastic_steel},
          .bodies = {{.name = "beam",
                      .material = "steel",
                      .thickness = 0.01,
                      .velocity = {5, -80},
                      .mesh = RectangleMesh{.size = {0.4, 0.1}, .at = {-0.2, 0}, .element_size = 0.005}}},
          .obstacles = {{.name = "stop",
                         .shape = Polygon{.points = {{-0.0137, 0}, {-0.02, -0.1}, {0.06, -0.1}, {0.0463, 0}}},
                         .friction = 0.35}}};
}

/// A spinning ring with a side that is carried along, under pressure and against damping.
Case spinning_ring() {
  const double spin = 300;
  return {.run = {.end_time = 1,
                  .integrator = Integrator::adams,
                  .damping = {.rate = 500, .against = MassDamping::Against::mean_motion}},
          .materials = {aluminium},
          .bodies = {{.name = "ring",
                      .material = "aluminium",
                      .velocity = {3, 0},
                      .spin = spin,
                      .mesh = RingMesh{.outer_radius = 0.2, .inner_radius = 0.1, .element_size = 0.006}}},
          .supports = {{.name = "shaft",
                        .nodes = {.body = "ring", .side = "inner"},
                        .turn = TimeTable{.times = {0, 1}, .values = {0, spin}}}},
          .loads = {{.name = "blast",
                     .kind = LoadCase::Kind::pressure,
                     .where = {.body = "ring", .box = {{0, -0.3}, {0.3, 0.3}}},
                     .pressure = 2e7,
                     .factor = {.times = {0, 2e-5}, .values = {0, 1}, .shape = TimeTable::Shape::smooth}}}};
}

/// A turned plastic block, an elastic disc and a coarse ring meet three obstacles with dashpots, one of which moves.
Case crowd() {
  return {
      .run = {.end_time = 1, .gravity = {0, -9.81}},
      .contact = {.damping = 0.2},
      .materials = {plastic_steel, aluminium},
      .bodies = {{.name = "block",
                  .material = "steel",
                  .thickness = 0.02,
                  .velocity = {0, -60},
                  .mesh = RectangleMesh{.size = {0.1, 0.07}, .at = {0, 0.002}, .turn = 0.02, .element_size = 0.003}},
                 {.name = "disc",
                  .material = "aluminium",
                  .velocity = {-30, -40},
                  .spin = 900,
                  .mesh = DiscMesh{.radius = 0.05, .at = {0.171, 0.0505}, .element_size = 0.003}},
                 {.name = "ring",
                  .material = "steel",
                  .velocity = {20, 0},
                  .mesh =
                      RingMesh{.outer_radius = 0.05, .inner_radius = 0.03, .at = {-0.2, 0.1}, .element_size = 0.01}}},
      .obstacles = {{.name = "floor", .shape = HalfPlane{}, .friction = 0.2},
                    {.name = "ball",
                     .shape = Circle{.centre = {-0.3, 0.1}, .radius = 0.0497},
                     .friction = 0.5,
                     .velocity = {60, 0}},
                    {.name = "edge", .shape = Rectangle{.at = {0.11, 0}, .size = {0.01, 0.06}}}}};
}

/// A mesh of many blocks, cut by both diagonals.
Case many_blocks() {
  Case input = impact();
  input.bodies[0].mesh = RectangleMesh{
      .size = {0.4, 0.1}, .at = {-0.2, 0}, .element_size = 0.0025, .diagonals = RectangleMesh::Diagonals::crossed};
  return input;
}

/// A disc with a hole of one triangle: single triangles and an odd number of them.
Model odd_disc() {
  Mesh mesh = renumber(generate(DiscMesh{.radius = 0.05, .at = {0, 0.0501}, .element_size = 0.002}));
  const auto middle = static_cast<std::ptrdiff_t>(mesh.triangles.size() / 2);
  mesh.triangles.erase(mesh.triangles.begin() + middle);
  mesh.triangle_numbers.erase(mesh.triangle_numbers.begin() + middle);
  Model model;
  add_beam(model, mesh, std::get<Tresca>(plastic_steel.law));
  add_stop(model, 2e9);
  model.run.end_time = 1;
  return model;
}

std::uint64_t hash_of_run(const Model& model, const BlockKernels& kernels, int threads, int steps) {
  Workspace work(model, threads);
  work.kernels = kernels;
  State state = start(model, work);
  for (int i = 0; i < steps; ++i) step(model, state, work);
  return hash_of(state);
}

void check_same_bits(const Model& model, int steps) {
  const std::vector<NamedKernels> isas = kernels_here();
  const std::uint64_t expected = hash_of_run(model, isas.front().kernels, 1, steps);
  for (const NamedKernels& isa : isas) {
    for (const int threads : {1, 2, 3, 4, 7, 8}) {
      CAPTURE(isa.name);
      CAPTURE(threads);
      CHECK(hash_of_run(model, isa.kernels, threads, steps) == expected);
    }
  }
}

State after(const Model& model, int steps) {
  Workspace work(model, 1);
  State state = start(model, work);
  for (int i = 0; i < steps; ++i) step(model, state, work);
  return state;
}

bool flowed(const State& state) {
  return std::any_of(state.plastic_strain.begin(), state.plastic_strain.end(), [](double e) { return e > 0; });
}

/// Blocks of pairs and of single triangles.
int blocks(const Model& model, bool paired) {
  return static_cast<int>(std::count_if(model.element_blocks.begin(), model.element_blocks.end(),
                                        [&](const ElementBlock& block) { return block.paired == paired; }));
}

}  // namespace

TEST_CASE("the same bits: a plastic impact with friction on a polygon") {
  const Model model = build_model(impact());
  const State state = after(model, 300);
  REQUIRE(flowed(state));
  REQUIRE(state.ledger.friction_work.value() > 0);
  check_same_bits(model, 300);
}

TEST_CASE("the same bits: a spinning ring with a moving support, pressure, damping and an Adams rule") {
  const Model model = build_model(spinning_ring());
  const State state = after(model, 300);
  REQUIRE(state.ledger.book(ForceKind::damping).work_now != 0);
  REQUIRE(state.ledger.book(ForceKind::load).work_now != 0);
  REQUIRE(state.ledger.book(ForceKind::support).work_now != 0);
  check_same_bits(model, 300);
}

TEST_CASE("the same bits: bodies of different laws and sizes on several obstacles with dashpots") {
  const Model model = build_model(crowd());
  const State state = after(model, 500);
  REQUIRE(flowed(state));
  REQUIRE(blocks(model, true) > 0);
  REQUIRE(blocks(model, false) > 0);
  for (const ContactBook& obstacle : state.obstacles) REQUIRE(length(obstacle.total.impulse()) > 0);
  check_same_bits(model, 500);
}

TEST_CASE("the same bits: an odd number of triangles, some of them single") {
  const Model model = odd_disc();
  REQUIRE(model.element_count % 2 == 1);
  REQUIRE(blocks(model, false) > 0);
  REQUIRE(flowed(after(model, 400)));
  check_same_bits(model, 400);
}

TEST_CASE("the same bits: more blocks than any number of threads") {
  const Model model = build_model(many_blocks());
  REQUIRE(model.element_blocks.size() >= 50);
  check_same_bits(model, 100);
}

}  // namespace udar

// The same bits for any number of threads and any instruction set: cases that have little in common.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/simulation/example.hpp"
#include "tests/simulation/varied_cases.hpp"
#include "tests/step/kernels_here.hpp"
#include "tests/step/small_model.hpp"
#include "udar/case/build_model.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

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

#if defined(UDAR_SANITIZED)
constexpr std::array thread_counts{1, 3};  // sanitizers take long, and look for other things
#else
constexpr std::array thread_counts{1, 2, 3, 4, 7, 8};
#endif

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
    for (const int threads : thread_counts) {
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

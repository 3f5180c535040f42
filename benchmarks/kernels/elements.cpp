// The formulas of one triangle on packs of lanes, each alone, its arrays in the nearest cache: what it costs at best.
// Compiled for the processor that builds it.

#include <benchmark/benchmark.h>

#include <array>

#include "udar/material/elastic.hpp"
#include "udar/material/tresca.hpp"
#include "udar/step/element_kernels.hpp"

namespace {

using namespace udar;
using udar::UDAR_ISA::Pack;

constexpr std::size_t packs = 16;
constexpr Tresca steel{.young_modulus = 1.96133e11, .poisson_ratio = 0.25, .yield_stress = 2.353596e8};

template <class T>
using Packs = std::array<T, packs>;

/// Numbers that differ from lane to lane.
Pack spread(double middle, double width) {
  Pack pack;
  for (int l = 0; l < Pack::lanes; ++l) pack.v[l] = middle + width * (l - 0.5 * Pack::lanes);
  return pack;
}

Packs<Sides<Pack>> some_sides() {
  Packs<Sides<Pack>> all;
  all.fill({spread(2.5e-3, 1e-5), spread(1e-4, 1e-5), spread(1e-4, 1e-5), spread(2.5e-3, 1e-5)});
  return all;
}

Packs<Sides<Pack>> some_changes() {
  Packs<Sides<Pack>> all;
  all.fill({spread(1e-6, 1e-7), spread(-1e-6, 1e-7), spread(1e-6, 1e-7), spread(-2e-6, 1e-7)});
  return all;
}

Packs<SymTensor<Pack>> some_stresses(double size) {
  Packs<SymTensor<Pack>> all;
  all.fill({spread(size, 1e6), spread(-size, 1e6), spread(0.1 * size, 1e6), spread(0, 1e6)});
  return all;
}

/// Runs `f(i)` over all packs; what it returns is kept, so that nothing is left out.
template <class F>
void run(benchmark::State& state, F&& f) {
  Packs<decltype(f(0))> out;
  for (auto _ : state) {
    for (std::size_t i = 0; i < packs; ++i) out[i] = f(i);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(packs * Pack::lanes));
}

void strain(benchmark::State& state) {
  const auto mid = some_sides();
  const auto half_change = some_changes();
  run(state, [&](std::size_t i) { return strain_step(mid[i], half_change[i]); });
}
BENCHMARK(strain);

void trial(benchmark::State& state) {
  const auto before = some_stresses(1e8);
  const Elasticity elasticity = steel.elasticity();
  Packs<StrainStep<Pack>> strains;
  strains.fill(strain_step(some_sides()[0], some_changes()[0]));
  run(state, [&](std::size_t i) { return elastic_trial(before[i], strains[i], elasticity); });
}
BENCHMARK(trial);

void tresca_test(benchmark::State& state) {
  const auto trial = some_stresses(1e7);
  run(state, [&](std::size_t i) { return select(steel.flows(trial[i]), Pack(1), Pack(0)); });
}
BENCHMARK(tresca_test);

void tresca_return(benchmark::State& state) {
  const auto trial = some_stresses(1e9);
  run(state, [&](std::size_t i) { return steel.correct(trial[i]); });
}
BENCHMARK(tresca_return);

void forces(benchmark::State& state) {
  const auto sides = some_sides();
  const auto stress = some_stresses(1e8);
  run(state, [&](std::size_t i) { return corner_forces(stress[i], sides[i], Pack(0.005)); });
}
BENCHMARK(forces);

void eigenfrequency(benchmark::State& state) {
  const auto sides = some_sides();
  const Elasticity elasticity = steel.elasticity();
  run(state, [&](std::size_t i) { return eigenfrequency_squared(sides[i], elasticity, Pack(0.0245)); });
}
BENCHMARK(eigenfrequency);

}  // namespace

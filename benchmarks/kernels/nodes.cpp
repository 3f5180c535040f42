// What runs over nodes: contact springs, and the sum of the forces on the corners that meet at a node.

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "udar/contact/penalty.hpp"
#include "udar/contact/polygon.hpp"
#include "udar/mesh/generators.hpp"
#include "udar/mesh/node_corners.hpp"
#include "udar/mesh/renumber.hpp"

namespace {

using namespace udar;

/// Nodes that slide over a flat stop, and press on it.
void springs(benchmark::State& state) {
  constexpr std::size_t count = 256;
  const PreparedPolygon stop = Polygon{.points = {{-3, 0}, {-23, -20}, {23, -20}, {3, 0}}}.prepared();
  const ContactSprings stiffness{.normal = 2e9, .tangential = 2e9, .friction = 0.35};
  std::vector<SpringState> all(count);
  SpringLosses losses;
  for (auto _ : state) {
    for (std::size_t i = 0; i < count; ++i) {
      const Vec2 place{0.01 * static_cast<double>(i) - 1.28, -1e-5};
      all[i] = spring_step(all[i], stop.gap(place), {1e-6, -1e-7}, 1e-7, stiffness, losses);
    }
    benchmark::DoNotOptimize(all.data());
    benchmark::DoNotOptimize(losses);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
}
BENCHMARK(springs);

/// Sums in ascending order over the renumbered mesh; the argument is the number of elements.
void node_sums(benchmark::State& state) {
  const double cell = 0.4 / std::sqrt(2 * static_cast<double>(state.range(0)));
  const Mesh mesh = renumber(generate(RectangleMesh{.size = {0.4, 0.1}, .element_size = cell}));
  const NodeCorners map = node_corners(mesh.nodes.size(), mesh.triangles);
  const std::vector<Vec2> forces(map.corners.size(), Vec2{1, 2});
  std::vector<Vec2> sums(mesh.nodes.size());
  for (auto _ : state) {
    for (Index i = 0; i < sums.size(); ++i) {
      Vec2 sum;
      for (const std::uint32_t corner : map.of(i)) sum += forces[corner];
      sums[i] = sum;
    }
    benchmark::DoNotOptimize(sums.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.triangles.size()));
}
BENCHMARK(node_sums)->Arg(800)->Arg(12800)->Arg(204800);

}  // namespace

BENCHMARK_MAIN();

#include "udar/step/quad_forces.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/step/kernels_here.hpp"
#include "tests/step/small_model.hpp"
#include "udar/step/element_kernels.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

const Tresca steel{.young_modulus = 200e9, .poisson_ratio = 0.3, .yield_stress = 400e6};

Model model_of(const MeshShape& shape) {
  Model model;
  add_beam(model, renumber(generate(shape)), steel);
  return model;
}

/// Pairs only, in many blocks; pairs and single triangles; few triangles and padding.
std::vector<Model> models() {
  return {model_of(RectangleMesh{.size = {0.4, 0.1}, .element_size = 0.004}),
          model_of(DiscMesh{.radius = 0.1, .element_size = 0.004}),
          model_of(RectangleMesh{.size = {0.03, 0.02}, .element_size = 0.01})};
}

/// Quad of the block and corner that a force of a block belongs to, as the comment of QuadForces has them.
struct Corner {
  Index quad;
  Index corner;
};
Corner corner_of(Index place) {
  const Index evens_first[] = {0, 2, 4, 6, 1, 3, 5, 7};
  return {place / 32 * 8 + evens_first[place % 8], place / 8 % 4};
}

/// Node that gets a force of a block, or `none`: a triangle that stands alone has three.
Index node_of(const Model& model, const ElementBlock& block, Index place) {
  const Corner at = corner_of(place);
  return block.paired || at.corner < 3 ? model.quads[block.quads + at.quad][at.corner] : none;
}

/// Some force at each corner, the same whenever it is asked for; not a number where there is none.
Vec2 some_force(const Model& model, std::size_t block, Index place) {
  if (node_of(model, model.element_blocks[block], place) == none) return {std::nan(""), std::nan("")};
  std::minstd_rand random(static_cast<unsigned>(977 * block + 31 * place + 1));
  random.discard(3);
  const auto number = [&] { return static_cast<double>(random()) / 3.0 - 3e8; };
  const double x = number();
  return {x, number()};
}

/// Sums of those at the nodes, in the order of the quads.
std::vector<Vec2> sums_of_some(const Model& model) {
  std::vector<Vec2> sums(model.rest.size());
  for (std::size_t b = 0; b < model.element_blocks.size(); ++b) {
    const ElementBlock& block = model.element_blocks[b];
    std::vector<Index> places(4 * block.quad_count());
    std::iota(places.begin(), places.end(), Index{0});
    std::sort(places.begin(), places.end(), [](Index p, Index q) { return corner_of(p).quad < corner_of(q).quad; });
    for (const Index place : places) {
      const Index node = node_of(model, block, place);
      if (node != none) sums[node] += some_force(model, b, place);
    }
  }
  return sums;
}

Sides<double> sides_of(const State& state, const std::array<Index, 3>& corners) {
  const auto& [a, b, c] = corners;
  const auto& n = state.nodes;
  return {n[b].x - n[a].x, n[b].y - n[a].y, n[c].x - n[a].x, n[c].y - n[a].y};
}

/// A body that is bent and under stress, without motion.
State stressed(const Model& model) {
  std::mt19937 random(3);
  const auto number = [&] { return 0x1p-31 * static_cast<double>(random()) - 1; };
  State state = rest_state(model);
  for (Index i = 0; i < model.node_count; ++i) {
    state.nodes[i].x += 5e-4 * number();
    state.nodes[i].y += 5e-4 * number();
  }
  for (Index e = 0; e < model.element_count; ++e) {
    state.stress_xx[e] = 1e9 * number();
    state.stress_yy[e] = 1e9 * number();
    state.stress_xy[e] = 1e9 * number();
    state.stress_zz[e] = 1e9 * number();
  }
  return state;
}

/// Forces of all elements at each node, one by one, and the sum of the sizes of what they are made of.
struct Direct {
  std::vector<Vec2> force;
  std::vector<double> size;
};
Direct summed_directly(const Model& model, const State& state) {
  const double half_thickness = 0.5 * model.bodies[0].thickness;
  Direct sum{std::vector<Vec2>(model.node_count), std::vector<double>(model.node_count)};
  for (Index e = 0; e < model.element_count; ++e) {
    const SymTensor<double> s{state.stress_xx[e], state.stress_yy[e], state.stress_xy[e], state.stress_zz[e]};
    const Sides<double> sides = sides_of(state, model.corners[e]);
    const CornerForces<double> f = corner_forces(s, sides, half_thickness);
    const Vec2 forces[] = {{-(f.x1 + f.x2), -(f.y1 + f.y2)}, {f.x1, f.y1}, {f.x2, f.y2}};
    const double size = half_thickness * (std::fabs(s.xx) + std::fabs(s.yy) + std::fabs(s.xy)) *
                        (std::fabs(sides.x1) + std::fabs(sides.y1) + std::fabs(sides.x2) + std::fabs(sides.y2));
    for (std::size_t k = 0; k < 3; ++k) {
      sum.force[model.corners[e][k]] += forces[k];
      sum.size[model.corners[e][k]] += size;
    }
  }
  return sum;
}

/// Adds the sums at the nodes of a block to those of all: each node must be summed once.
void add_sums(const Model& model, const NodeForces& sums, std::size_t block, std::vector<Vec2>& all) {
  const NodeBlock& nodes = model.node_blocks[block];
  for (Index node = nodes.begin; node < nodes.end; ++node) all[node] += sums.internal[node - nodes.begin];
}

}  // namespace

TEST_CASE("every corner force arrives at its node once, in the order of the quads, with any number of threads") {
  for (const Model& model : models()) {
    const std::vector<Vec2> expected = sums_of_some(model);
    for (const int threads : {1, 2, 3, 8}) {
      CAPTURE(threads);
      Pool pool(threads);
      QuadForces forces(model, pool);
      for (int round = 0; round < 3; ++round) {
        std::vector<Vec2> found(model.node_count);
        forces.for_each_block(
            pool,
            [&](std::size_t b) {
              const Index count = 4 * model.element_blocks[b].quad_count();
              for (Index place = 0; place < count; ++place) forces.of_block(b)[place] = some_force(model, b, place);
            },
            [&](std::size_t b, const NodeForces& sums) { add_sums(model, sums, b, found); });
        for (Index node = 0; node < model.node_count; ++node) {
          CHECK(found[node].x == expected[node].x);
          CHECK(found[node].y == expected[node].y);
        }
      }
    }
  }
}

TEST_CASE("kernels put the forces of every element where its nodes look for them, with the same bits") {
  for (const Model& model : models()) {
    std::vector<Vec2> first;
    for (const NamedKernels& isa : kernels_here()) {
      CAPTURE(isa.name);
      Workspace work(model, 1);
      work.kernels = isa.kernels;
      State state = stressed(model);
      std::vector<Vec2> found(model.node_count);
      work.forces.for_each_block(
          work.pool, [&](std::size_t b) { deform_elements(model, state, work, b); },
          [&](std::size_t b, const NodeForces& sums) { add_sums(model, sums, b, found); });
      const Direct direct = summed_directly(model, state);
      if (first.empty()) first.assign(found.begin(), found.end());
      for (Index node = 0; node < model.node_count; ++node) {
        // Each term is rounded four times in its element, in both sums, and eight times on the way to the node.
        const Vec2 apart = found[node] - direct.force[node];
        CHECK(std::fabs(apart.x) + std::fabs(apart.y) <= 2 * (4 + 8) * 0x1p-53 * direct.size[node]);
        CHECK(found[node].x == first[node].x);
        CHECK(found[node].y == first[node].y);
      }
    }
  }
}

}  // namespace udar

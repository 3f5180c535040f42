#include <limits>

#include "udar/base/lanes.hpp"
#include "udar/step/element_kernels.hpp"
#include "udar/step/failure.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

/// One number for each element of a block.
struct alignas(64) Row {
  double at[elements_per_block];

  [[nodiscard]] Pack pack(Index i) const { return Pack::load(at + i); }
  void put(Index i, Pack value) { value.store(at + i); }
};

/// The sides of a block's triangles, gathered from the node records so that everything after runs over rows.
struct BlockSides {
  Row x1, y1, x2, y2;      // m, at the end of the step
  Row dx1, dy1, dx2, dy2;  // m, change during the step

  [[nodiscard]] Sides<Pack> end(Index i) const { return {x1.pack(i), y1.pack(i), x2.pack(i), y2.pack(i)}; }
  [[nodiscard]] Sides<Pack> change(Index i) const { return {dx1.pack(i), dy1.pack(i), dx2.pack(i), dy2.pack(i)}; }
};

void gather(const Model& model, const State& state, const ElementBlock& block, BlockSides& sides) {
  const double h = state.clock.last_step;
  const NodeRecord* const nodes = state.nodes.data();
  const auto* const corners = model.corners.data() + block.begin;
  for (Index i = 0; i < block.end - block.begin; ++i) {
    const NodeRecord& a = nodes[corners[i][0]];
    const NodeRecord& b = nodes[corners[i][1]];
    const NodeRecord& c = nodes[corners[i][2]];
    sides.x1.at[i] = b.x - a.x;
    sides.y1.at[i] = b.y - a.y;
    sides.x2.at[i] = c.x - a.x;
    sides.y2.at[i] = c.y - a.y;
    sides.dx1.at[i] = h * (b.vx - a.vx);
    sides.dy1.at[i] = h * (b.vy - a.vy);
    sides.dx2.at[i] = h * (c.vx - a.vx);
    sides.dy2.at[i] = h * (c.vy - a.vy);
  }
}

/// What a block's elements hand to the corners, N.
struct BlockForces {
  Row x1, y1, x2, y2;
};

/// Sums and extremes of a block, lane by lane and then over the lanes: an order that is fixed, whatever computes it.
struct LaneSums {
  static constexpr Index packs = lanes / Pack::lanes;
  Pack stress_work[packs], plastic_work[packs], frequency_squared[packs], smallest_area[packs];

  LaneSums() {
    for (Index p = 0; p < packs; ++p) {
      stress_work[p] = plastic_work[p] = frequency_squared[p] = Pack(0);
      smallest_area[p] = Pack(std::numeric_limits<double>::infinity());
    }
  }

  [[nodiscard]] ElementSums total() const {
    ElementSums sums{.smallest_area = std::numeric_limits<double>::infinity()};
    for (Index p = 0; p < packs; ++p) {
      for (Index l = 0; l < Pack::lanes; ++l) {
        sums.stress_work += stress_work[p].v[l];
        sums.plastic_work += plastic_work[p].v[l];
        sums.frequency_squared = larger(sums.frequency_squared, frequency_squared[p].v[l]);
        sums.smallest_area = smaller(sums.smallest_area, smallest_area[p].v[l]);
      }
    }
    return sums;
  }
};

/// The stress arrays of a block.
struct BlockStress {
  double* xx;
  double* yy;
  double* xy;
  double* zz;
  double* plastic_strain;
  double* plastic_power;

  [[nodiscard]] SymTensor<Pack> stress(Index i) const {
    return {Pack::load(xx + i), Pack::load(yy + i), Pack::load(xy + i), Pack::load(zz + i)};
  }
  void put(Index i, const SymTensor<Pack>& s) const {
    s.xx.store(xx + i);
    s.yy.store(yy + i);
    s.xy.store(xy + i);
    s.zz.store(zz + i);
  }
};

/// One pack of elements through the step: strain and turn, trial stress, the law, corner forces, books.
template <class Law>
void deform_pack(Index i, const BlockSides& sides, const BlockStress& block, const double* area_density, const Law& law,
                 double half_thickness, BlockForces& forces, LaneSums& sums) {
  const Elasticity elasticity = law.elasticity();
  const Sides<Pack> end = sides.end(i);
  const StrainStep<Pack> strain = strain_step(end, sides.change(i));
  const SymTensor<Pack> before = block.stress(i);
  const SymTensor<Pack> trial = elastic_trial(turned(before, strain.cos, strain.sin), strain, elasticity);
  const Corrected<Pack> after = law.correct(trial);
  const CornerForces<Pack> force = corner_forces(after.stress, end, Pack(half_thickness));

  block.put(i, after.stress);
  after.plastic_work.store(block.plastic_power + i);
  const Pack plastic_strain = after.plastic_work * Pack(law.plastic_strain_of_work());
  (Pack::load(block.plastic_strain + i) + plastic_strain).store(block.plastic_strain + i);
  forces.x1.put(i, force.x1);
  forces.y1.put(i, force.y1);
  forces.x2.put(i, force.x2);
  forces.y2.put(i, force.y2);

  const Index p = i % lanes / Pack::lanes;
  const Pack volume = Pack(half_thickness) * strain.twice_area;
  const Pack frequency_squared = eigenfrequency_squared(end, elasticity, Pack::load(area_density + i));
  sums.stress_work[p] = sums.stress_work[p] + volume * stress_work(before, after.stress, strain);
  sums.plastic_work[p] = sums.plastic_work[p] + volume * after.plastic_work;
  sums.frequency_squared[p] = larger(sums.frequency_squared[p], frequency_squared);
  sums.smallest_area[p] = smaller(sums.smallest_area[p], smaller(strain.twice_area, end.twice_area()));
}

template <class Law>
ElementSums deform_block(const Model& model, State& state, const ElementBlock& block, const Law& law, double thickness,
                         Vec2* corner_force) {
  const Index count = block.end - block.begin;
  const Index first = block.begin;
  BlockSides sides;
  BlockForces forces;
  LaneSums sums;
  gather(model, state, block, sides);
  const BlockStress stress{&state.stress_xx[first], &state.stress_yy[first],      &state.stress_xy[first],
                           &state.stress_zz[first], &state.plastic_strain[first], &state.plastic_power[first]};
  for (Index i = 0; i < count; i += Pack::lanes) {
    deform_pack(i, sides, stress, &model.area_density[first], law, 0.5 * thickness, forces, sums);
  }
  for (Index i = 0; i < count; ++i) {
    const Vec2 at_1{forces.x1.at[i], forces.y1.at[i]};
    const Vec2 at_2{forces.x2.at[i], forces.y2.at[i]};
    corner_force[3 * i] = -(at_1 + at_2);
    corner_force[3 * i + 1] = at_1;
    corner_force[3 * i + 2] = at_2;
  }
  return sums.total();
}

}  // namespace

void deform_elements(const Model& model, State& state, Workspace& work) {
  work.pool.for_each_block(model.element_blocks.size(), [&](std::size_t b) {
    const ElementBlock& block = model.element_blocks[b];
    const Body& body = model.bodies[block.body];
    Vec2* const corner_force = work.corner_forces.data() + 3 * std::size_t{block.begin};
    work.element_sums[b] = std::visit(
        [&](const auto& law) { return deform_block(model, state, block, law, body.thickness, corner_force); },
        body.law);
  });

  Ledger& ledger = state.ledger;
  bool inverted = false;
  for (const ElementSums& sums : work.element_sums) {
    ledger.stress_work.add(sums.stress_work);
    ledger.plastic_work.add(sums.plastic_work);
    inverted = inverted || !(sums.smallest_area > 0);
  }
  if (inverted) fail_inverted(model, state);
}

}  // namespace udar

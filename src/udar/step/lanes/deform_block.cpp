// Compiled once for each instruction set (CMakeLists.txt): everything here lives in a namespace of its name, and no
// inline function of a library is used, since the linker could then take the wrong copy for the whole program.

#include "udar/step/deform_block.hpp"

#include "udar/base/lanes.hpp"
#include "udar/step/element_kernels.hpp"

namespace udar::UDAR_ISA {
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

void gather(const BlockTask& task, BlockSides& sides) {
  const double h = task.step;
  for (Index i = 0; i < task.count; ++i) {
    const NodeRecord& a = task.nodes[task.corners[3 * i]];
    const NodeRecord& b = task.nodes[task.corners[3 * i + 1]];
    const NodeRecord& c = task.nodes[task.corners[3 * i + 2]];
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
      smallest_area[p] = Pack(__builtin_inf());
    }
  }

  [[nodiscard]] ElementSums total() const {
    ElementSums sums{.smallest_area = __builtin_inf()};
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

SymTensor<Pack> load_stress(const BlockTask& task, Index i) {
  return {Pack::load(task.xx + i), Pack::load(task.yy + i), Pack::load(task.xy + i), Pack::load(task.zz + i)};
}

void store_stress(const BlockTask& task, Index i, const SymTensor<Pack>& s) {
  s.xx.store(task.xx + i);
  s.yy.store(task.yy + i);
  s.xy.store(task.xy + i);
  s.zz.store(task.zz + i);
}

/// One pack of elements through the step: strain and turn, trial stress, the law, corner forces, books.
template <class Law>
void deform_pack(const BlockTask& task, Index i, const Law& law, const BlockSides& sides, BlockForces& forces,
                 LaneSums& sums) {
  const Elasticity elasticity = law.elasticity();
  const Sides<Pack> end = sides.end(i);
  const StrainStep<Pack> strain = strain_step(end, sides.change(i));
  const SymTensor<Pack> before = load_stress(task, i);
  const SymTensor<Pack> trial = elastic_trial(turned(before, strain.cos, strain.sin), strain, elasticity);
  const Corrected<Pack> after = law.correct(trial);
  const CornerForces<Pack> force = corner_forces(after.stress, end, Pack(task.half_thickness));

  store_stress(task, i, after.stress);
  after.plastic_work.store(task.plastic_power + i);
  const Pack plastic_strain = after.plastic_work * Pack(law.plastic_strain_of_work());
  (Pack::load(task.plastic_strain + i) + plastic_strain).store(task.plastic_strain + i);
  forces.x1.put(i, force.x1);
  forces.y1.put(i, force.y1);
  forces.x2.put(i, force.x2);
  forces.y2.put(i, force.y2);

  const Index p = i % lanes / Pack::lanes;
  const Pack volume = Pack(task.half_thickness) * strain.twice_area;
  const Pack frequency_squared = eigenfrequency_squared(end, elasticity, Pack::load(task.area_density + i));
  sums.stress_work[p] = sums.stress_work[p] + volume * stress_work(before, after.stress, strain);
  sums.plastic_work[p] = sums.plastic_work[p] + volume * after.plastic_work;
  sums.frequency_squared[p] = larger(sums.frequency_squared[p], frequency_squared);
  sums.smallest_area[p] = smaller(sums.smallest_area[p], smaller(strain.twice_area, end.twice_area()));
}

void scatter(const BlockTask& task, const BlockForces& forces) {
  double* to = task.corner_forces;
  for (Index i = 0; i < task.count; ++i, to += 6) {
    to[0] = -(forces.x1.at[i] + forces.x2.at[i]);
    to[1] = -(forces.y1.at[i] + forces.y2.at[i]);
    to[2] = forces.x1.at[i];
    to[3] = forces.y1.at[i];
    to[4] = forces.x2.at[i];
    to[5] = forces.y2.at[i];
  }
}

template <class Law>
ElementSums deform_block(const BlockTask& task, const void* law) {
  BlockSides sides;
  BlockForces forces;
  LaneSums sums;
  gather(task, sides);
  for (Index i = 0; i < task.count; i += Pack::lanes) {
    deform_pack(task, i, *static_cast<const Law*>(law), sides, forces, sums);
  }
  scatter(task, forces);
  return sums.total();
}

template <class Laws>
struct Kernels;
template <class... Laws>
struct Kernels<std::variant<Laws...>> {
  static constexpr BlockKernel of_law[] = {&deform_block<Laws>...};
};

}  // namespace

const BlockKernel* block_kernels() { return Kernels<Law>::of_law; }

}  // namespace udar::UDAR_ISA

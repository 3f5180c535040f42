#pragma once

// Part of block_kernels.cpp, which is compiled for each instruction set: everything lives in a namespace of its name.

#include "udar/base/transpose.hpp"
#include "udar/step/block_kernels.hpp"
#include "udar/step/element_kernels.hpp"

namespace udar::UDAR_ISA {
namespace {

/// Corners 1, 2 and 3 of a pack of quads as seen from corner 0: where they are (m) and how fast they move on (m/s).
struct QuadSides {
  Columns to[3];

  /// Sides to corners `one` and `two` at the start of the step.
  [[nodiscard]] Sides<Pack> sides(int one, int two) const {
    return {to[one - 1].at[0], to[one - 1].at[1], to[two - 1].at[0], to[two - 1].at[1]};
  }
  [[nodiscard]] Sides<Pack> change(int one, int two, Pack h) const {
    return {h * to[one - 1].at[2], h * to[one - 1].at[3], h * to[two - 1].at[2], h * to[two - 1].at[3]};
  }
};

QuadSides gather(const ElementTask& task, Index first) {
  const Quad* quads = task.quads + first;
  const auto corner = [&](int k) { return load_records([&](int lane) { return &task.nodes[quads[lane][k]].x; }); };
  const Records origin = corner(0);
  return {{columns(corner(1) - origin), columns(corner(2) - origin), columns(corner(3) - origin)}};
}

/// Sums and extremes of a block, lane by lane and then over the lanes: an order that is fixed, whatever computes it.
struct LaneSums {
  static constexpr Index packs = lanes / Pack::lanes;
  Pack stress_work[packs], plastic_work[packs], smallest_area[packs], stretch[packs];

  LaneSums() {
    for (Index p = 0; p < packs; ++p) {
      stress_work[p] = plastic_work[p] = stretch[p] = Pack(0);
      smallest_area[p] = Pack(__builtin_inf());
    }
  }

  [[nodiscard]] ElementSums total() const {
    ElementSums sums{.smallest_area = __builtin_inf()};
    for (Index p = 0; p < packs; ++p) {
      for (Index l = 0; l < Pack::lanes; ++l) {
        sums.stress_work += stress_work[p].v[l];
        sums.plastic_work += plastic_work[p].v[l];
        sums.smallest_area = smaller(sums.smallest_area, smallest_area[p].v[l]);
      }
    }
    return sums;
  }
  [[nodiscard]] double largest_stretch() const {
    double squared = 0;
    for (Index p = 0; p < packs; ++p) {
      for (Index l = 0; l < Pack::lanes; ++l) squared = larger(squared, stretch[p].v[l]);
    }
    return __builtin_sqrt(squared);
  }
};

/// Which elements of a pack flow, in its bits of their byte.
void set_flowing(const ElementTask& task, Index i, unsigned bits) {
  const Index lane = i % lanes;
  std::uint8_t& byte = task.flowing[i / lanes];
  byte = static_cast<std::uint8_t>((lane == 0 ? 0U : byte) | bits << lane);
}

/// One pack of elements through the step: strain and turn, trial stress, the law, corner forces, books.
template <class Law>
CornerForces<Pack> deform_pack(const ElementTask& task, Index i, const Law& law, const Sides<Pack>& start,
                               const Sides<Pack>& change, LaneSums& sums) {
  const Sides<Pack> mid = start.after(Pack(0.5), change);
  const Sides<Pack> end = start.after(Pack(1), change);
  const StrainStep<Pack> strain = strain_step(mid, change);
  const SymTensor<Pack> before{Pack::load(task.xx + i), Pack::load(task.yy + i), Pack::load(task.xy + i),
                               Pack::load(task.zz + i)};
  const SymTensor<Pack> trial = elastic_trial(turned(before, strain.cos, strain.sin), strain, law.elasticity());
  const Corrected<Pack> after = law.correct(trial);
  after.stress.xx.store(task.xx + i);
  after.stress.yy.store(task.yy + i);
  after.stress.xy.store(task.xy + i);
  after.stress.zz.store(task.zz + i);

  const Index p = i % lanes / Pack::lanes;
  const Pack volume = Pack(task.half_thickness) * strain.twice_area;
  set_flowing(task, i, bits(after.flows));
  if (any(after.flows)) {
    const Pack plastic_strain = after.plastic_work * Pack(law.plastic_strain_of_work());
    (Pack::load(task.plastic_strain + i) + plastic_strain).store(task.plastic_strain + i);
    sums.plastic_work[p] = sums.plastic_work[p] + volume * after.plastic_work;
  }
  sums.stress_work[p] = sums.stress_work[p] + volume * stress_work(before, after.stress, strain);
  sums.smallest_area[p] = smaller(sums.smallest_area[p], smaller(strain.twice_area, end.twice_area()));
  sums.stretch[p] = larger(sums.stretch[p], stretch_squared(strain));
  return corner_forces(after.stress, end, Pack(task.half_thickness));
}

/// Forces on one corner of a pack of quads, in the order of QuadForces.
void put_forces(const ElementTask& task, Index first, Index corner, Pack x, Pack y) {
  const Index within = first % lanes / 2;
  double* to = &task.forces[first / lanes * (4 * lanes) + corner * lanes + within].x;
  even_lanes(x, y).store(to);
  odd_lanes(x, y).store(to + lanes);
}

/// Largest frequency of the elements at the end of the step, and who has it.
[[gnu::noinline]] void compute_frequency(const ElementTask& task, const Elasticity& elasticity, bool paired) {
  Pack largest(-1);
  FrequencyBound& found = *task.frequency;
  found.computed = -1;
  double squared[lanes];
  const auto look = [&](Index i, const Sides<Pack>& end) {
    const Pack w2 = eigenfrequency_squared(end, elasticity, Pack::load(task.area_density + i)) +
                    Pack::load(task.contact_spring + i);
    if (!any(w2 > Pack(found.computed))) return;
    w2.store(squared);
    for (Index l = 0; l < Pack::lanes; ++l) {
      if (!(squared[l] > found.computed)) continue;
      found.computed = squared[l];
      found.element = task.first_element + i + l;
    }
  };
  const Pack h(task.step);
  for (Index q = 0; q < task.count; q += Pack::lanes) {
    const QuadSides quads = gather(task, q);
    look(q, quads.sides(1, 2).after(Pack(1), quads.change(1, 2, h)));
  }
  for (Index q = 0; paired && q < task.count; q += Pack::lanes) {
    const QuadSides quads = gather(task, q);
    look(task.count + q, quads.sides(3, 1).after(Pack(1), quads.change(3, 1, h)));
  }
  found.squared = found.computed;
}

/// The bound grows by as much as the ratio of the principal stretches of any element may have grown: turned to the
/// principal axes of B B^T, no entry of the matrix of `eigenfrequency_squared` grows by more.
void bound_frequency(const ElementTask& task, const Elasticity& elasticity, bool paired, double stretch) {
  constexpr double bounded = 0.1;  // see stretch_squared
  FrequencyBound& frequency = *task.frequency;
  frequency.squared = stretch <= bounded ? frequency.squared * (1 + 1.1 * stretch) : __builtin_inf();
  if (frequency.squared > task.compute_above) compute_frequency(task, elasticity, paired);
}

template <class Law, bool paired>
[[gnu::flatten]] ElementSums deform_block(const ElementTask& task, const void* untyped_law) {
  const Law law = *static_cast<const Law*>(untyped_law);
  const Pack h(task.step);
  LaneSums sums;
  for (Index q = 0; q < task.count; q += Pack::lanes) {
    const QuadSides quads = gather(task, q);
    const CornerForces<Pack> one = deform_pack(task, q, law, quads.sides(1, 2), quads.change(1, 2, h), sums);
    CornerForces<Pack> two{Pack(0), Pack(0), Pack(0), Pack(0)};
    if constexpr (paired) {
      two = deform_pack(task, task.count + q, law, quads.sides(3, 1), quads.change(3, 1, h), sums);
      put_forces(task, q, 3, two.x1, two.y1);
    }
    const Pack x1 = one.x1 + two.x2;
    const Pack y1 = one.y1 + two.y2;
    put_forces(task, q, 1, x1, y1);
    put_forces(task, q, 2, one.x2, one.y2);
    put_forces(task, q, 0, -(x1 + one.x2 + two.x1), -(y1 + one.y2 + two.y1));
  }
  bound_frequency(task, law.elasticity(), paired, sums.largest_stretch());
  return sums.total();
}

template <class Laws>
struct DeformKernels;
template <class... Laws>
struct DeformKernels<std::variant<Laws...>> {
  static constexpr ElementKernel single[] = {&deform_block<Laws, false>...};
  static constexpr ElementKernel paired[] = {&deform_block<Laws, true>...};
};

}  // namespace
}  // namespace udar::UDAR_ISA

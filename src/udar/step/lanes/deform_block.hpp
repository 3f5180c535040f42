#pragma once

// Part of block_kernels.cpp, which is compiled for each instruction set: everything lives in a namespace of its name.

#include "udar/base/transpose.hpp"
#include "udar/step/block_kernels.hpp"
#include "udar/step/element_kernels.hpp"
#include "udar/step/lanes/lane_sums.hpp"

namespace udar::UDAR_ISA {
namespace {

/// Corners 1, 2 and 3 of a pack of quads as seen from corner 0: where they are (m) and how fast they move on (m/s).
struct QuadSides {
  Columns to[3];

  /// Sides to corners `one` and `two` at the start of the step, and what a time changes them by.
  [[nodiscard]] Sides<Pack> start(int one, int two) const {
    return {to[one - 1].at[0], to[one - 1].at[1], to[two - 1].at[0], to[two - 1].at[1]};
  }
  [[nodiscard]] Sides<Pack> change(int one, int two, Pack time) const {
    const Columns& a = to[one - 1];
    const Columns& b = to[two - 1];
    return {time * a.at[2], time * a.at[3], time * b.at[2], time * b.at[3]};
  }
};

QuadSides gather(const ElementTask& task, Index first) {
  const Quad* quads = task.quads + first;
  const auto corner = [&](int k) { return load_records([&](int lane) { return &task.nodes[quads[lane][k]].x; }); };
  const Records origin = corner(0);
  return {{columns(corner(1) - origin), columns(corner(2) - origin), columns(corner(3) - origin)}};
}

/// What is kept of a block between its loops: enough to stay in the first cache.
struct BlockBuffer {
  static constexpr Index packs = elements_per_block / Pack::lanes;
  Sides<Pack> sides[packs];  ///< m, at the end of the step
  StrainStep<Pack> strains[packs];
  Index flowing[packs + 1];  ///< first elements of the packs that flow
};

/// Sums and extremes of a block, lane by lane and then over the lanes: an order that is fixed, whatever computes it.
/// Works are kept as integrals over twice the area of (s_n + s_{n+1}) : de and of the plastic work, in J/m.
struct LaneSums {
  static constexpr Index packs = lanes / Pack::lanes;
  Pack stress_work[packs], plastic_work[packs], stretch[packs], unseen[packs], area[packs];

  LaneSums() {
    for (Pack& p : stress_work) p = Pack(0);
    for (Pack& p : plastic_work) p = Pack(0);
    for (Pack& p : stretch) p = Pack(0);
    for (Pack& p : unseen) p = Pack(0);
    for (Pack& p : area) p = Pack(__builtin_inf());
  }
  static Index pack_of(Index element) { return element % lanes / Pack::lanes; }

  [[nodiscard]] ElementSums total(double half_thickness) const {
    return {.stress_work = 0.5 * half_thickness * sum_of_lanes(stress_work),
            .plastic_work = half_thickness * sum_of_lanes(plastic_work),
            .smallest_area = smallest_area(),
            .unseen = sum_of_lanes(unseen)};
  }
  [[nodiscard]] double smallest_area() const {
    double smallest = __builtin_inf();
    for (const Pack& pack : area) {
      for (Index l = 0; l < Pack::lanes; ++l) smallest = smaller(smallest, pack.v[l]);
    }
    return smallest;
  }
  [[nodiscard]] double largest_stretch() const {
    double squared = 0;
    for (const Pack& pack : stretch) {
      for (Index l = 0; l < Pack::lanes; ++l) squared = larger(squared, pack.v[l]);
    }
    return __builtin_sqrt(squared);
  }
};

SymTensor<Pack> load_stress(const ElementTask& task, Index i) {
  return {Pack::load(task.xx + i), Pack::load(task.yy + i), Pack::load(task.xy + i), Pack::load(task.zz + i)};
}
void store_stress(const ElementTask& task, Index i, const SymTensor<Pack>& s) {
  s.xx.store(task.xx + i);
  s.yy.store(task.yy + i);
  s.xy.store(task.xy + i);
  s.zz.store(task.zz + i);
}

/// Strain and turn of a pack of elements. Its stress is asked for meanwhile: the next loop wants it at hand.
void strain(const ElementTask& task, Index i, const Sides<Pack>& start, const Sides<Pack>& half_change,
            BlockBuffer& buffer, LaneSums& sums) {
  const Sides<Pack> mid = start + half_change;
  const StrainStep<Pack> e = strain_step(mid, half_change);
  for (const double* component : {task.xx, task.yy, task.xy, task.zz}) __builtin_prefetch(component + i, 1);
  const Index p = LaneSums::pack_of(i);
  sums.stretch[p] = larger(sums.stretch[p], stretch_squared(e));
  sums.area[p] = smaller(sums.area[p], e.twice_area);
  buffer.sides[i / Pack::lanes] = mid + half_change;
  buffer.strains[i / Pack::lanes] = e;
}

/// Elastic trial stress and its work; returns whether the pack flows. What makes no force is looked at, too.
template <class Law>
bool try_elastic(const ElementTask& task, Index i, const Law& law, const StrainStep<Pack>& e, LaneSums& sums) {
  const SymTensor<Pack> before = load_stress(task, i);
  const SymTensor<Pack> trial = elastic_trial(before, e, law.elasticity());
  store_stress(task, i, trial);
  Pack& work = sums.stress_work[LaneSums::pack_of(i)];
  work = work + e.twice_area * stress_work(before + trial, e);
  Pack& unseen = sums.unseen[LaneSums::pack_of(i)];
  unseen = unseen + (Pack::load(task.plastic_strain + i) + trial.zz);
  return any(law.flows(trial));
}

/// Stress of a pack that flows, its plastic work, and what that takes from the work of the trial stress.
template <class Law>
void flow(const ElementTask& task, Index i, const Law& law, const StrainStep<Pack>& e, LaneSums& sums) {
  const SymTensor<Pack> trial = load_stress(task, i);
  const Corrected<Pack> after = law.correct(trial);
  store_stress(task, i, after.stress);
  const Pack plastic_strain = after.plastic_work * Pack(law.plastic_strain_of_work());
  (Pack::load(task.plastic_strain + i) + plastic_strain).store(task.plastic_strain + i);

  const Index p = LaneSums::pack_of(i);
  sums.plastic_work[p] = sums.plastic_work[p] + e.twice_area * after.plastic_work;
  sums.stress_work[p] = sums.stress_work[p] + e.twice_area * stress_work(after.stress - trial, e);
  std::uint8_t& byte = task.flowing[i / lanes];
  byte = static_cast<std::uint8_t>(byte | bits(law.flows(trial)) << i % lanes);
}

/// Forces on one corner of a pack of quads, in the order of QuadForces.
void put_forces(const ElementTask& task, Index first, Index corner, Pack x, Pack y) {
  const Index within = first % lanes / 2;
  double* to = &task.forces[first / lanes * (4 * lanes) + corner * lanes + within].x;
  even_lanes(x, y).store(to);
  odd_lanes(x, y).store(to + lanes);
}

/// Corner forces of a pack of quads; `one` and `two` are their elements.
template <bool paired>
void press_corners(const ElementTask& task, Index q, const BlockBuffer& buffer) {
  const Pack half_thickness(task.half_thickness);
  const CornerForces<Pack> one = corner_forces(load_stress(task, q), buffer.sides[q / Pack::lanes], half_thickness);
  CornerForces<Pack> two{Pack(0), Pack(0), Pack(0), Pack(0)};
  if constexpr (paired) {
    const Index i = task.count + q;
    two = corner_forces(load_stress(task, i), buffer.sides[i / Pack::lanes], half_thickness);
    put_forces(task, q, 3, two.x1, two.y1);
  }
  const Pack x1 = one.x1 + two.x2;
  const Pack y1 = one.y1 + two.y2;
  put_forces(task, q, 1, x1, y1);
  put_forces(task, q, 2, one.x2, one.y2);
  put_forces(task, q, 0, -(x1 + one.x2 + two.x1), -(y1 + one.y2 + two.y1));
}

/// Largest frequency of the elements at the end of the step, and who has it; returns twice the smallest area in the
/// middle of the step and then.
[[gnu::noinline]] double compute_frequency(const ElementTask& task, Index elements, const Elasticity& elasticity,
                                           const BlockBuffer& buffer) {
  FrequencyBound& found = *task.frequency;
  found.computed = -1;
  double smallest = __builtin_inf();
  for (Index i = 0; i < elements; i += Pack::lanes) {
    const Sides<Pack>& end = buffer.sides[i / Pack::lanes];
    const Pack area = smaller(end.twice_area(), buffer.strains[i / Pack::lanes].twice_area);
    const Pack squared = eigenfrequency_squared(end, elasticity, Pack::load(task.area_density + i)) +
                         Pack::load(task.contact_spring + i);
    for (Index l = 0; l < Pack::lanes; ++l) {
      smallest = smaller(smallest, area.v[l]);
      if (!(squared.v[l] > found.computed)) continue;
      found.computed = squared.v[l];
      found.element = task.first_element + i + l;
    }
  }
  found.squared = found.computed;
  return smallest;
}

/// The bound grows by as much as the ratio of the principal stretches of any element may have grown: turned to the
/// principal axes of B B^T, no entry of the matrix of `eigenfrequency_squared` grows by more. While it holds no element
/// turns over either: from its middle to its ends the step deforms the material by 1 -+ G/2, whose determinants are
/// then above 0.
void bound_frequency(const ElementTask& task, Index elements, const Elasticity& elasticity, const BlockBuffer& buffer,
                     double stretch, ElementSums& sums) {
  constexpr double bounded = 0.1;  // see stretch_squared
  FrequencyBound& frequency = *task.frequency;
  frequency.squared = stretch <= bounded ? frequency.squared * (1 + 1.1 * stretch) : __builtin_inf();
  if (frequency.squared <= task.compute_above) return;
  sums.smallest_area = smaller(sums.smallest_area, compute_frequency(task, elements, elasticity, buffer));
}

/// Loop by loop rather than element by element: each loop keeps its constants and intermediate results in registers,
/// and packs that flow are gathered without a branch that the processor would have to guess.
template <class Law, bool paired>
[[gnu::flatten]] ElementSums deform_block(const ElementTask& task, const void* untyped_law) {
  const Law law = *static_cast<const Law*>(untyped_law);
  const Pack half_step(0.5 * task.step);
  const Index elements = paired ? 2 * task.count : task.count;
  BlockBuffer buffer;
  LaneSums sums;
  for (Index q = 0; q < task.count; q += Pack::lanes) {
    const QuadSides quads = gather(task, q);
    strain(task, q, quads.start(1, 2), quads.change(1, 2, half_step), buffer, sums);
    if constexpr (paired) strain(task, task.count + q, quads.start(3, 1), quads.change(3, 1, half_step), buffer, sums);
  }
  Index flowing = 0;
  for (Index i = 0; i < elements; i += Pack::lanes) {
    buffer.flowing[flowing] = i;
    flowing += try_elastic(task, i, law, buffer.strains[i / Pack::lanes], sums) ? 1 : 0;
  }
  for (Index i = 0; i < elements / lanes; ++i) task.flowing[i] = 0;
  for (Index k = 0; k < flowing; ++k) {
    flow(task, buffer.flowing[k], law, buffer.strains[buffer.flowing[k] / Pack::lanes], sums);
  }
  for (Index q = 0; q < task.count; q += Pack::lanes) press_corners<paired>(task, q, buffer);

  ElementSums total = sums.total(task.half_thickness);
  bound_frequency(task, elements, law.elasticity(), buffer, sums.largest_stretch(), total);
  return total;
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

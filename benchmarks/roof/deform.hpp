#pragma once

#include "kernel.hpp"
#include "run.hpp"

// The elements of a stretch, in four phases. Each runs over independent packs with a short chain of operations, so that
// a processor overlaps many of them; in one long loop the division held everything up, and the branch to the return was
// mispredicted wherever flow begins or ends.

namespace roof::UDAR_ISA {

/// What phases hand on, for each group of the stretch.
struct Handed {
  static constexpr Index groups = pairs_per_stretch / Pack::lanes;

  Pack bx[groups], by[groups], cx[groups], cy[groups], dx[groups], dy[groups];  ///< sides from corner a
  Kinematics strains[2 * groups];
  Pack areas[2 * groups];     ///< twice them, in the middle of the step; only for the books
  Index flowing[2 * groups];  ///< triangle packs to be returned to the yield surface
};

/// The arrays of a problem from the first group of a stretch on.
struct StretchArrays {
  const char* nodes;
  const Index* corners;
  const Index* base;
  double* stress;
  char* forces;

  StretchArrays(Problem& p, Index group)
      : nodes(reinterpret_cast<const char*>(p.nodes.data())),
        corners(p.corners.data() + std::size_t{group} * 4 * Pack::lanes),
        base(p.base.data() + group),
        stress(p.stress.data()[std::size_t{group} * Pack::lanes].at),
        forces(reinterpret_cast<char*>(p.forces.data())) {}

  /// Of a pack of first or second triangles.
  [[nodiscard]] double* stress_of(Index triangle) const { return stress + std::size_t{triangle} * 4 * Pack::lanes; }
};

template <bool books>
void find_strains(const StretchArrays& at, Index groups, const Constants& k, Handed& to) {
  const Index* corners = at.corners;
  for (Index g = 0; g < groups; ++g, corners += 4 * Pack::lanes) {
    // The stresses are for the next phase; far ahead, since the processor sees their stream only when it begins.
    for (Index line = 0; line < Pack::lanes; ++line) __builtin_prefetch(at.stress_of(2 * g + 8) + 8 * line, 1);
    const Records a = Records::load(at.nodes, corners);
    const Side b = side(a, Records::load(at.nodes, corners + Pack::lanes));
    const Side c = side(a, Records::load(at.nodes, corners + 2 * Pack::lanes));
    const Side d = side(a, Records::load(at.nodes, corners + 3 * Pack::lanes));
    const Middle mid_b(b, k.half_step), mid_c(c, k.half_step), mid_d(d, k.half_step);
    to.bx[g] = b.x;
    to.by[g] = b.y;
    to.cx[g] = c.x;
    to.cy[g] = c.y;
    to.dx[g] = d.x;
    to.dy[g] = d.y;
    to.strains[2 * g] = kinematics(k, b, c, mid_b, mid_c);
    to.strains[2 * g + 1] = kinematics(k, d, b, mid_d, mid_b);
    if constexpr (books) {
      to.areas[2 * g] = mid_b.x * mid_c.y - mid_c.x * mid_b.y;
      to.areas[2 * g + 1] = mid_d.x * mid_b.y - mid_b.x * mid_d.y;
    }
  }
}

/// Returns how many packs flow.
inline Index find_trials(const StretchArrays& at, Index groups, const Constants& k, Handed& handed) {
  Index flowing = 0;
  for (Index t = 0; t < 2 * groups; ++t) {
    Stress s = Stress::load(at.stress_of(t));
    try_elastic(k, handed.strains[t], s);
    s.store(at.stress_of(t));
    handed.flowing[flowing] = t;  // counts only if the next line says so
    flowing += any_flows(k, s) ? 1 : 0;
  }
  return flowing;
}

template <bool books>
void return_to_surface(const StretchArrays& at, Index flowing, const udar::Tresca& law, const Handed& handed,
                       Books& sums) {
  for (Index f = 0; f < flowing; ++f) {
    const Index t = handed.flowing[f];
    Stress s = Stress::load(at.stress_of(t));
    [[maybe_unused]] const Pack work = flow(law, s);
    s.store(at.stress_of(t));
    if constexpr (books) {
      for (int l = 0; l < Pack::lanes; ++l) {
        sums.plastic_work += work.v[l] * handed.areas[t].v[l];
        sums.flowing += work.v[l] > 0 ? 1 : 0;
      }
    }
  }
}

inline void find_forces(const StretchArrays& at, Index groups, const Handed& h) {
  for (Index g = 0; g < groups; ++g) {
    const TriangleForces first(Stress::load(at.stress_of(2 * g)), h.bx[g], h.by[g], h.cx[g], h.cy[g]);
    const TriangleForces second(Stress::load(at.stress_of(2 * g + 1)), h.dx[g], h.dy[g], h.bx[g], h.by[g]);
    const PackForce b{first.at1.x + second.at2.x, first.at1.y + second.at2.y};
    const PackForce& c = first.at2;
    const PackForce& d = second.at1;
    Force* to = reinterpret_cast<Force*>(at.forces) + at.base[g];
    store_interleaved(to, {-(b.x + c.x + d.x), -(b.y + c.y + d.y)});
    store_interleaved(to + Pack::lanes, b);
    store_interleaved(to + 2 * Pack::lanes, c);
    store_interleaved(to + 3 * Pack::lanes, d);
  }
}

template <bool books>
void deform(Problem& p, const Stretch& stretch, const Constants& k, Books& sums) {
  Handed handed;
  const StretchArrays at(p, stretch.group_begin);
  const Index groups = stretch.group_end - stretch.group_begin;
  find_strains<books>(at, groups, k, handed);
  const Index flowing = find_trials(at, groups, k, handed);
  return_to_surface<books>(at, flowing, p.beam.law, handed, sums);
  find_forces(at, groups, handed);
}

}  // namespace roof::UDAR_ISA

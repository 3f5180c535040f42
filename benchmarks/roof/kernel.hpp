#pragma once

#include "records.hpp"
#include "udar/base/sym_tensor.hpp"

// The formulas of udar/step/element_kernels.hpp and docs/theory.md, put for the least work: one division, the stress as
// mean and deviator, no square root where nothing flows.

namespace roof::UDAR_ISA {

/// Stress of a pack, Pa: mean and half difference of the in-plane normal stresses, shear, and by how much the mean is
/// above the stress out of the plane.
struct Stress {
  Pack mean, half, xy, above;

  [[gnu::always_inline]] static Stress load(const double* from) {
    return {Pack::load(from), Pack::load(from + Pack::lanes), Pack::load(from + 2 * Pack::lanes),
            Pack::load(from + 3 * Pack::lanes)};
  }
  [[gnu::always_inline]] void store(double* to) const {
    mean.store(to);
    half.store(to + Pack::lanes);
    xy.store(to + 2 * Pack::lanes);
    above.store(to + 3 * Pack::lanes);
  }
};

/// What all triangles have in common.
struct Constants {
  Pack half_step, quarter_step, shear_half_step, trace_over_shear, yield, half_yield;

  Constants(const udar::Tresca& law, double h)
      : half_step(0.5 * h),
        quarter_step(0.25 * h),
        shear_half_step(0.5 * h * law.elasticity().shear_modulus),
        trace_over_shear(law.elasticity().lambda / law.elasticity().shear_modulus + 1),
        yield(law.yield_stress),
        half_yield(0.5 * law.yield_stress) {}
};

/// A side in the middle of the step.
struct Middle {
  Pack x, y;

  [[gnu::always_inline]] Middle(const Side& s, Pack half_step) : x(s.x - half_step * s.vx), y(s.y - half_step * s.vy) {}
};

/// Turn of the triangle, and its strain increments as the stress that they make: pressure is G (e_x + e_y), half is
/// G (e_x - e_y), shear is G 2 e_xy.
struct Kinematics {
  Pack cos, sin, pressure, half, shear;
};

/// With D twice the area in the middle of the step and N a quarter of the step times the numerator of the spin,
/// tan(turn / 2) = N / D, and 2 / (D (D^2 + N^2)) serves strain and turn alike.
[[gnu::always_inline]] inline Kinematics kinematics(const Constants& k, const Side& s1, const Side& s2,
                                                    const Middle& m1, const Middle& m2) {
  const Pack d = m1.x * m2.y - m2.x * m1.y;
  const Pack ux = s1.vx * m2.y - s2.vx * m1.y;
  const Pack uy = s2.vx * m1.x - s1.vx * m2.x;
  const Pack vx = s1.vy * m2.y - s2.vy * m1.y;
  const Pack vy = s2.vy * m1.x - s1.vy * m2.x;
  const Pack n = k.quarter_step * (vx - uy);
  const Pack sum = d * d + n * n;
  const Pack r = Pack(2) / (d * sum);
  const Pack g = k.shear_half_step * sum * r;  // shear modulus x step / D
  const Pack twice = d * (d * r);              // 2 D / (D^2 + N^2)
  return {d * twice - Pack(1), n * twice, g * (ux + vy), g * (ux - vy), g * (uy + vx)};
}

/// Trial stress. A turn by t turns the deviator by 2 t; the strain increment goes in half-way: R (R s + G de), R a turn
/// of the deviator by t.
[[gnu::always_inline]] inline void try_elastic(const Constants& k, const Kinematics& e, Stress& s) {
  const Pack half = e.cos * s.half - e.sin * s.xy + e.half;
  const Pack xy = e.sin * s.half + e.cos * s.xy + e.shear;
  s.mean = s.mean + k.trace_over_shear * e.pressure;
  s.above = s.above + e.pressure;
  s.half = e.cos * half - e.sin * xy;
  s.xy = e.sin * half + e.cos * xy;
}

/// Largest shear above yield in any lane, without a square root: with r the in-plane radius, the largest difference of
/// principal stresses is 2 r or r + |above|.
[[gnu::always_inline]] inline bool any_flows(const Constants& k, const Stress& s) {
  const Pack most = smaller(k.half_yield, k.yield - magnitude(s.above));
  return any_larger(s.half * s.half + s.xy * s.xy, most * magnitude(most));
}

/// The law of the program; returns the plastic work per volume, J/m3.
[[gnu::always_inline]] inline Pack flow(const udar::Tresca& law, Stress& s) {
  const auto after = law.correct(udar::SymTensor<Pack>{s.mean + s.half, s.mean - s.half, s.xy, s.mean - s.above});
  s.mean = Pack(0.5) * (after.stress.xx + after.stress.yy);
  s.half = Pack(0.5) * (after.stress.xx - after.stress.yy);
  s.xy = after.stress.xy;
  s.above = s.mean - after.stress.zz;
  return after.plastic_work;
}

/// Forces on corners 1 and 2 of triangles, over half the thickness.
struct TriangleForces {
  PackForce at1, at2;

  [[gnu::always_inline]] TriangleForces(const Stress& s, Pack x1, Pack y1, Pack x2, Pack y2) {
    const Pack xx = s.mean + s.half;
    const Pack yy = s.mean - s.half;
    at1 = {s.xy * x2 - xx * y2, yy * x2 - s.xy * y2};
    at2 = {xx * y1 - s.xy * x1, s.xy * y1 - yy * x1};
  }
};

}  // namespace roof::UDAR_ISA

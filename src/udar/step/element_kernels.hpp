#pragma once

#include <cmath>

#include "udar/base/lanes.hpp"
#include "udar/base/sym_tensor.hpp"
#include "udar/material/elasticity.hpp"

namespace udar {

/// The formulas of one triangle, written once for a double or a pack of lanes: + - * / and sqrt only, no branches.

/// Two sides of a triangle, from corner 0 to corners 1 and 2 (m), or how they change in a step.
template <class Real>
struct Sides {
  Real x1, y1, x2, y2;

  [[nodiscard]] Real twice_area() const { return x1 * y2 - x2 * y1; }

  friend Sides operator+(const Sides& a, const Sides& b) {
    return {a.x1 + b.x1, a.y1 + b.y1, a.x2 + b.x2, a.y2 + b.y2};
  }
};

/// Strain increment of a step and the turn that goes with it.
template <class Real>
struct StrainStep {
  Real xx, yy, xy2;  ///< e_x, e_y and g_xy = 2 e_xy, in the fixed axes, of the middle of the step
  Real cos, sin;     ///< turn of the material
  Real twice_area;   ///< m2, of the triangle in the middle of the step
};

/// Strain increment from the sides in the middle of the step and their change during half of it: with gradients on the
/// middle triangle a rigid turn gives exactly no strain, and the exact turn follows without sine or cosine (Hughes and
/// Winget 1980, eqs. 20-27). With D twice the area and N = D (v,x - u,y) / 4 the tangent of half the turn is N / D; 1 /
/// D and 1 / (D^2 + N^2) come from a single division, the slowest of all operations here.
template <class Real>
StrainStep<Real> strain_step(const Sides<Real>& mid, const Sides<Real>& half_change) {
  const Real d = mid.twice_area();
  // Displacement gradient times D / 2.
  const Real u_x = half_change.x1 * mid.y2 - half_change.x2 * mid.y1;
  const Real u_y = half_change.x2 * mid.x1 - half_change.x1 * mid.x2;
  const Real v_x = half_change.y1 * mid.y2 - half_change.y2 * mid.y1;
  const Real v_y = half_change.y2 * mid.x1 - half_change.y1 * mid.x2;
  const Real n = Real(0.5) * (v_x - u_y);
  const Real squares = d * d + n * n;
  const Real reciprocal = Real(2) / (d * squares);
  const Real inverse = squares * reciprocal;  // 2 / D
  const Real twice = d * (d * reciprocal);    // 2 D / (D^2 + N^2)
  return {u_x * inverse, v_y * inverse, (u_y + v_x) * inverse, d * twice - Real(1), n * twice, d};
}

/// Bound on the square of how much a step can change the shape of a triangle: the ratio of its principal stretches is
/// at most 1 + 1.1 q, with q the root of this, while q <= 0.1. For the gradient G of the step, the material deforms by
/// F = (1 - G/2)^-1 (1 + G/2). With t = |tr G| / 4 and g the difference of the principal strain increments, the
/// condition number of F is at most ((1 + g/4)^2 - t^2) / ((1 - g/4)^2 - t^2); g <= q and t <= q / 4.
template <class Real>
Real stretch_squared(const StrainStep<Real>& e) {
  return Real(2) * (e.xx * e.xx + e.yy * e.yy) + e.xy2 * e.xy2;
}

/// Elastic stress at the end of the step from the stress at its start, plane strain (Hooke). The strain increment
/// belongs to the middle of the step, so it is added half-way through the turn: R (R s R^T + C de) R^T with R half the
/// turn. Added at the end, the stress would be right to first order only, and a wave that runs round a spinning disc
/// would grow or die. In the plane a turn leaves the mean (xx + yy) / 2 alone and turns the pair of (xx - yy) / 2 and
/// xy by twice its angle.
template <class Real>
SymTensor<Real> elastic_trial(const SymTensor<Real>& s, const StrainStep<Real>& e, const Elasticity& elasticity) {
  const Real g(elasticity.shear_modulus);
  const Real sum = e.xx + e.yy;
  const Real mean = Real(0.5) * (s.xx + s.yy) + Real(elasticity.lambda + elasticity.shear_modulus) * sum;
  const Real old_half = Real(0.5) * (s.xx - s.yy);
  // Half the turn turns the pair by its whole angle.
  const Real mid_half = (e.cos * old_half - e.sin * s.xy) + g * (e.xx - e.yy);
  const Real mid_xy = (e.sin * old_half + e.cos * s.xy) + g * e.xy2;
  const Real half = e.cos * mid_half - e.sin * mid_xy;
  const Real xy = e.sin * mid_half + e.cos * mid_xy;
  return {mean + half, mean - half, xy, s.zz + Real(elasticity.lambda) * sum};
}

/// Work of a stress on the strain increment per volume, J/m3: s : de. That of a step is the mean of the works of the
/// stresses at its start, before the turn, and at its end.
template <class Real>
Real stress_work(const SymTensor<Real>& s, const StrainStep<Real>& e) {
  return s.xx * e.xx + s.yy * e.yy + s.xy * e.xy2;
}

/// Forces of the element's stress on corners 1 and 2 (N); corner 0 gets the opposite of their sum.
template <class Real>
struct CornerForces {
  Real x1, y1, x2, y2;
};

template <class Real>
CornerForces<Real> corner_forces(const SymTensor<Real>& s, const Sides<Real>& sides, Real half_thickness) {
  return {half_thickness * (s.xy * sides.x2 - s.xx * sides.y2), half_thickness * (s.yy * sides.x2 - s.xy * sides.y2),
          half_thickness * (s.xx * sides.y1 - s.xy * sides.x1), half_thickness * (s.xy * sides.y1 - s.yy * sides.x1)};
}

/// Square of the largest eigenfrequency of the triangle with its mass lumped in thirds, 1/s2: 3 / rho_now times the
/// largest eigenvalue of D B B^T. Turned to the principal axes of B B^T, with a and c its in-plane principal values,
/// that is L (a + c) / 2 + sqrt((L (a + c) / 2)^2 - (L^2 - lambda^2) a c), L = lambda + 2 G; for a triangle
/// a + c = (sum of squared sides) / (4 A^2) and a c = 3 / (4 A^2). The shear eigenvalue G (a + c) is never larger for
/// lambda >= 0 and is taken into account below 0. `area_density` is density x undeformed area, kg/m.
template <class Real>
Real eigenfrequency_squared(const Sides<Real>& s, const Elasticity& e, Real area_density) {
  using std::fabs;
  using std::sqrt;
  const double modulus = e.wave_modulus();
  const Real dx = s.x2 - s.x1;
  const Real dy = s.y2 - s.y1;
  const Real squares = s.x1 * s.x1 + s.y1 * s.y1 + s.x2 * s.x2 + s.y2 * s.y2 + dx * dx + dy * dy;
  const Real twice = s.twice_area();
  // All terms times A^2, so that a flat triangle costs no accuracy.
  const Real half = Real(0.125 * modulus) * squares;
  const Real product = Real(0.1875 * (modulus * modulus - e.lambda * e.lambda)) * twice * twice;
  const Real root = sqrt(fabs(half * half - product));  // never negative but for rounding, where nu = 0
  const Real shear = Real(0.25 * e.shear_modulus) * squares;
  return Real(6) * larger(half + root, shear) / (area_density * twice);
}

}  // namespace udar

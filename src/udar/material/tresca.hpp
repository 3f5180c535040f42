#pragma once

#include <cmath>
#include <vector>

#include "udar/base/lanes.hpp"
#include "udar/material/elasticity.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// Elastic, perfectly plastic by the largest shear stress: no two of the three principal stresses may differ by more
/// than the tensile yield stress (Tresca 1864; Shtein and Zylev 2025, conditions (1)-(3)). The out-of-plane stress
/// takes part. Mean stress is never changed by flow.
struct Tresca {
  static constexpr const char* keyword = "tresca";
  static constexpr const char* doc = "elastic, then perfectly plastic by the largest shear stress";

  double young_modulus = 0;  ///< Pa
  double poisson_ratio = 0;
  double yield_stress = 0;  ///< Pa, in tension; the largest shear stress is half of it

  static std::vector<Parameter<Tresca>> parameters() {
    auto all = elastic_parameters<Tresca>();
    all.push_back({"yield_stress", &Tresca::yield_stress, dimension::stress, limits::positive,
                   "tensile yield stress: the largest difference of two principal stresses", true,
                   R"("2400 kgf/cm^2")"});
    return all;
  }

  [[nodiscard, gnu::always_inline]] Elasticity elasticity() const {
    return elasticity_of(young_modulus, poisson_ratio);
  }

  /// Where the trial stress is outside the yield surface. Without a root: with the in-plane radius r, the largest
  /// difference of two principal stresses is 2 r, or r and the distance of the third one from the centre.
  template <class Real>
  auto flows(const SymTensor<Real>& trial) const {
    using std::fabs;
    const Real y(yield_stress);
    const Real half_difference = Real(0.5) * (trial.xx - trial.yy);
    const Real radius_squared = half_difference * half_difference + trial.xy * trial.xy;
    const Real third_one = fabs(Real(0.5) * (trial.xx + trial.yy) - trial.zz);
    const Real elastic = smaller(Real(0.5) * y, y - third_one);  // largest elastic radius; below 0 there is none
    return radius_squared > elastic * fabs(elastic);
  }

  /// Returns the trial stress to the yield surface along its normal, where it flows. All principal stresses end between
  /// two bounds yield_stress apart: those of the face crossed by the largest difference or, where the middle one would
  /// then lie outside, those of the edge where it equals one of the others. Without branches, so that it vectorises.
  template <class Real>
  Corrected<Real> correct(const SymTensor<Real>& trial) const {
    using std::sqrt;
    const auto flows_here = flows(trial);
    const Real y(yield_stress);
    const Real third(1.0 / 3.0);
    const Real centre = Real(0.5) * (trial.xx + trial.yy);
    const Real half_difference = Real(0.5) * (trial.xx - trial.yy);
    const Real radius = sqrt(half_difference * half_difference + trial.xy * trial.xy);
    const Real p1 = centre + radius;
    const Real p2 = centre - radius;
    const Real p3 = trial.zz;
    const Real largest = larger(p1, p3);
    const Real smallest = smaller(p2, p3);
    const Real middle = larger(p2, smaller(p1, p3));
    const Real sum = p1 + p2 + p3;

    const Real face = Real(0.5) * (largest + smallest - y);  // lower bound when a face is crossed
    const Real upper_edge = third * (sum + y) - y;           // largest and middle equal
    const Real lower_edge = third * (sum - y);               // middle and smallest equal
    const Real bound = select(middle > face + y, upper_edge, select(middle < face, lower_edge, face));

    const Real q1 = smaller(larger(p1, bound), bound + y);
    const Real q2 = smaller(larger(p2, bound), bound + y);
    const Real q3 = smaller(larger(p3, bound), bound + y);
    const Real safe_radius = select(radius > Real(0), radius, Real(1));
    const Real shrink = Real(0.5) * (q1 - q2) / safe_radius;
    const Real new_centre = Real(0.5) * (q1 + q2);
    const Real work = (q1 * (p1 - q1) + q2 * (p2 - q2) + q3 * (p3 - q3)) * Real(0.5 / elasticity().shear_modulus);
    // Where nothing flows the trial stress comes out bit for bit, not its principal values turned back.
    return {{select(flows_here, new_centre + shrink * half_difference, trial.xx),
             select(flows_here, new_centre - shrink * half_difference, trial.yy),
             select(flows_here, shrink * trial.xy, trial.xy), select(flows_here, q3, trial.zz)},
            select(flows_here, work, Real(0))};
  }
  /// Equivalent plastic strain that goes with plastic work per volume (work-conjugate: work / yield stress), m3/J.
  [[nodiscard, gnu::always_inline]] double plastic_strain_of_work() const { return 1 / yield_stress; }
};

}  // namespace udar

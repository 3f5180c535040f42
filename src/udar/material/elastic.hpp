#pragma once

#include <vector>

#include "udar/material/elasticity.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// Linear isotropic elasticity in rate form (hypoelastic): the stress increment follows the strain increment, whatever
/// the stress is.
struct Elastic {
  static constexpr const char* keyword = "elastic";
  static constexpr const char* doc = "isotropic and elastic, without limit";

  double young_modulus = 0;  ///< Pa
  double poisson_ratio = 0;

  static std::vector<Parameter<Elastic>> parameters() { return elastic_parameters<Elastic>(); }

  [[nodiscard, gnu::always_inline]] Elasticity elasticity() const {
    return elasticity_of(young_modulus, poisson_ratio);
  }

  /// Nothing flows,
  template <class Real>
  auto flows(const SymTensor<Real>&) const {
    return Real(0) > Real(0);
  }
  /// so the elastic trial stress holds.
  template <class Real>
  Corrected<Real> correct(const SymTensor<Real>& trial) const {
    return {trial, Real(0)};
  }
  /// Plastic strain that goes with plastic work (J/m3): none.
  [[nodiscard, gnu::always_inline]] double plastic_strain_of_work() const { return 0; }
};

}  // namespace udar

#pragma once

#include <vector>

#include "udar/base/sym_tensor.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// Lame's constants, Pa.
struct Elasticity {
  double lambda = 0;
  double shear_modulus = 0;

  /// lambda + 2 G: modulus of uniaxial strain; the fastest wave runs at sqrt(modulus / density).
  [[nodiscard, gnu::always_inline]] constexpr double wave_modulus() const { return lambda + 2 * shear_modulus; }
  [[nodiscard, gnu::always_inline]] constexpr double bulk_modulus() const { return lambda + 2 * shear_modulus / 3; }
};

// Always inlined here and in the laws: these are also used where code is compiled for one instruction set only.
[[gnu::always_inline]] constexpr Elasticity elasticity_of(double young_modulus, double poisson_ratio) {
  return {young_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio)),
          young_modulus / (2 * (1 + poisson_ratio))};
}

/// What a law makes of the elastic trial stress: the stress that holds at the end of the step and the plastic work done
/// in the step per volume, s_{n+1} : de_p with de_p = (s_trial - s_{n+1}) / 2G (J/m3; 0 where the step was elastic).
template <class Real>
struct Corrected {
  SymTensor<Real> stress;
  Real plastic_work;
};

/// Young's modulus and Poisson's ratio as every isotropic law asks for them.
template <class Law>
std::vector<Parameter<Law>> elastic_parameters() {
  return {{"young_modulus", &Law::young_modulus, dimension::stress, limits::positive, "Young's modulus"},
          {"poisson_ratio",
           &Law::poisson_ratio,
           dimension::number,
           {.low = -1, .high = 0.5, .low_included = false, .high_included = false},
           "Poisson's ratio; below 0.5, since at 0.5 waves of pressure would be infinitely fast"}};
}

}  // namespace udar

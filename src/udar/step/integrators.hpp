#pragma once

#include <array>
#include <cstdint>

#include "udar/model/settings.hpp"

namespace udar {

/// Weights with which the accelerations enter a step h of an integrator that extrapolates or interpolates them:
///   v_{n+1} = v_n + implicit a_{n+1} + velocity[0] a_n + velocity[1] a_{n-1} + velocity[2] a_{n-2}
///   (x_{n+1} - x_n) / h = v_n + mean[0] a_n + mean[1] a_{n-1} + mean[2] a_{n-2}
/// all in s. With equal steps they are the table of docs/theory.md; with others they integrate Lagrange's polynomial
/// through the last accelerations.
struct StepWeights {
  double implicit = 0;
  std::array<double, 3> velocity{};
  std::array<double, 3> mean{};
};

/// Step h after steps `last` and `before_last` (s).
struct StepHistory {
  double h = 0;
  double last = 0;
  double before_last = 0;
};

/// What is known of an integrator.
struct IntegratorRule {
  Integrator kind;
  const char* keyword;
  const char* doc;
  /// Stable while frequency x step stays below this; 0: never stable.
  double stable_limit;
  /// Steps done so far that it needs; before, velocity Verlet starts it.
  int needs;
  /// Null for central difference, which needs no past.
  StepWeights (*weights)(const StepHistory&);
};

StepWeights verlet_weights(const StepHistory& steps);
StepWeights adams_weights(const StepHistory& steps);
StepWeights adams2_weights(const StepHistory& steps);
StepWeights adams2_new_velocity_weights(const StepHistory& steps);

/// Every integrator, in the order of the enum Integrator.
inline constexpr std::array<IntegratorRule, integrator_words.size()> integrators{{
    {Integrator::central_difference, integrator_words[0], "velocities at half steps; loses no energy", 2, 0, nullptr},
    {Integrator::adams, integrator_words[1], "Adams with three accelerations", 0.966, 2, adams_weights},
    {Integrator::adams2, integrator_words[2], "Adams with two accelerations; never stable, for study", 0, 1,
     adams2_weights},
    {Integrator::adams2_new_velocity, integrator_words[3], "the same, places with the new velocity; damps high modes",
     1.414, 1, adams2_new_velocity_weights},
}};
static_assert([] {
  for (std::size_t k = 0; k < integrators.size(); ++k) {
    if (integrators[k].kind != static_cast<Integrator>(k)) return false;
  }
  return true;
}());

inline const IntegratorRule& rule_of(Integrator kind) { return integrators[static_cast<std::size_t>(kind)]; }

/// The weights of step number `step` (from 0): those of the start, then those of the rule.
inline StepWeights weights_of(const IntegratorRule& rule, std::uint64_t step, const StepHistory& steps) {
  return step < static_cast<std::uint64_t>(rule.needs) ? verlet_weights(steps) : rule.weights(steps);
}

}  // namespace udar

#include "udar/step/integrators.hpp"

namespace udar {

// Lagrange's polynomials through the accelerations at s = 0, -p and -q, integrated over s from 0 to h for the velocity
// and weighted with (h - s) / h for the mean velocity of the step (Bashforth and Adams 1883, here for unequal steps).

StepWeights verlet_weights(const StepHistory& steps) {
  const double h = steps.h;
  return {.implicit = h / 2, .velocity = {h / 2, 0, 0}, .mean = {h / 2, 0, 0}};
}

StepWeights adams_weights(const StepHistory& steps) {
  const double h = steps.h;
  const double p = steps.last;
  const double q = p + steps.before_last;
  const double h2 = h * h;
  const double c0 = 1 / (p * q);
  const double c1 = -1 / (p * (q - p));
  const double c2 = 1 / (q * (q - p));
  return {
      .implicit = 0,
      .velocity = {c0 * h * (h2 / 3 + (p + q) * h / 2 + p * q), c1 * h2 * (h / 3 + q / 2), c2 * h2 * (h / 3 + p / 2)},
      .mean = {c0 * h * (h2 / 12 + (p + q) * h / 6 + p * q / 2), c1 * h2 * (h / 12 + q / 6),
               c2 * h2 * (h / 12 + p / 6)}};
}

StepWeights adams2_weights(const StepHistory& steps) {
  const double h = steps.h;
  const double p = steps.last;
  return {.implicit = 0,
          .velocity = {h * (1 + h / (2 * p)), -h * h / (2 * p), 0},
          .mean = {h * (0.5 + h / (6 * p)), -h * h / (6 * p), 0}};
}

StepWeights adams2_new_velocity_weights(const StepHistory& steps) {
  StepWeights w = adams2_weights(steps);
  w.mean = w.velocity;
  return w;
}

}  // namespace udar

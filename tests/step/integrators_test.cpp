#include "udar/step/integrators.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace udar {

TEST_CASE("weights for equal steps are the table's") {
  const double h = 0.25;
  const StepHistory equal{h, h, h};
  const auto check = [&](const std::array<double, 3>& weights, double a, double b, double c) {
    CHECK(weights[0] == doctest::Approx(h * a).epsilon(1e-14));
    CHECK(weights[1] == doctest::Approx(h * b).epsilon(1e-14));
    CHECK(weights[2] == doctest::Approx(h * c).epsilon(1e-14));
  };
  const StepWeights adams = adams_weights(equal);
  CHECK(adams.implicit == 0);
  check(adams.velocity, 23.0 / 12, -16.0 / 12, 5.0 / 12);
  check(adams.mean, 19.0 / 24, -10.0 / 24, 3.0 / 24);
  const StepWeights adams2 = adams2_weights(equal);
  CHECK(adams2.implicit == 0);
  check(adams2.velocity, 3.0 / 2, -1.0 / 2, 0);
  check(adams2.mean, 4.0 / 6, -1.0 / 6, 0);
  const StepWeights newer = adams2_new_velocity_weights(equal);
  check(newer.velocity, 3.0 / 2, -1.0 / 2, 0);
  check(newer.mean, 3.0 / 2, -1.0 / 2, 0);
  const StepWeights verlet = verlet_weights(equal);
  CHECK(verlet.implicit == h / 2);
  check(verlet.velocity, 0.5, 0, 0);
  check(verlet.mean, 0.5, 0, 0);
}

TEST_CASE("unequal steps integrate the polynomial through the last accelerations exactly") {
  for (const StepHistory& steps : {StepHistory{1, 0.3, 2.5}, StepHistory{0.01, 1, 1}, StepHistory{2, 0.7, 0.1}}) {
    const double h = steps.h;
    const double at[] = {0, -steps.last, -steps.last - steps.before_last};  // times of a_n, a_{n-1}, a_{n-2}
    const auto check = [&](const StepWeights& w, int highest_power) {
      for (int power = 0; power <= highest_power; ++power) {
        double velocity = 0, mean = 0, size = 0;
        for (int k = 0; k < 3; ++k) {
          const double a = power == 0 ? 1 : std::pow(at[k], power);
          velocity += w.velocity[k] * a;
          mean += w.mean[k] * a;
          size += std::fabs(w.velocity[k] * a) + std::fabs(w.mean[k] * a);
        }
        // Integrals of s^power and of (h - s) s^power / h from 0 to h.
        CHECK(std::fabs(velocity - std::pow(h, power + 1) / (power + 1)) <= 1e-14 * size);
        CHECK(std::fabs(mean - std::pow(h, power + 1) / ((power + 1) * (power + 2))) <= 1e-14 * size);
      }
    };
    check(adams_weights(steps), 2);
    check(adams2_weights(steps), 1);
  }
}

TEST_CASE("rules: keyword, start and order of the list") {
  for (std::size_t i = 0; i < integrators.size(); ++i) {
    CHECK(static_cast<std::size_t>(integrators[i].kind) == i);
    CHECK(&rule_of(integrators[i].kind) == &integrators[i]);
  }
  const IntegratorRule& adams = rule_of(Integrator::adams);
  const StepHistory steps{1, 1, 1};
  CHECK(weights_of(adams, 0, steps).implicit == 0.5);
  CHECK(weights_of(adams, 1, steps).implicit == 0.5);
  CHECK(weights_of(adams, 2, steps).implicit == 0);
  CHECK((rule_of(Integrator::central_difference).weights == nullptr));
}

}  // namespace udar

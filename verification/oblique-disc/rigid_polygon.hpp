#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "udar/base/vec2.hpp"

namespace udar::verification {

/// Springs between a node of the rim and a frictional plane.
struct RimSprings {
  double normal = 0;      ///< N/m
  double tangential = 0;  ///< N/m
  double friction = 0;
};

/// A rigid polygon over the plane y = 0 with springs at its corners: three degrees of freedom, integrated with steps so
/// short that their error does not count. It shares nothing with the program but the rule of the springs: normal force
/// k d, tangential force k_t times the slip since the touch, cut at friction times normal force.
struct RigidPolygon {
  double mass = 0;        ///< kg
  double inertia = 0;     ///< kg m2, about the centre
  Vec2 centre{};          ///< m
  Vec2 velocity{};        ///< m/s
  double turn = 0;        ///< rad
  double spin = 0;        ///< rad/s
  std::vector<Vec2> rim;  ///< m, corners from the centre at turn 0

  // What came of it.
  double deepest = 0;    ///< m
  std::size_t most = 0;  ///< corners that touched at once
  bool sticks = false;   ///< did a corner stick, with force in its tangential spring?
  bool slides = false;

  /// Leapfrog (Verlet 1967) through `time` (s) in `steps` equal steps.
  void fly(double time, int steps, const RimSprings& springs) {
    const double h = time / steps;
    std::vector<double> slip(rim.size());
    std::vector<double> last_x(rim.size());
    std::vector<char> touching(rim.size());
    for (int n = 0; n < steps; ++n) {
      centre += h * velocity;
      turn += h * spin;
      const Turn now{std::cos(turn), std::sin(turn)};
      Vec2 force;
      double moment = 0;
      std::size_t count = 0;
      for (std::size_t i = 0; i < rim.size(); ++i) {
        const Vec2 arm = now * rim[i];
        const Vec2 place = centre + arm;
        if (place.y >= 0) {
          touching[i] = 0;
          continue;
        }
        const double pressing = -springs.normal * place.y;
        const double trial = touching[i] != 0 ? slip[i] + (place.x - last_x[i]) : 0;
        const double largest = springs.friction * pressing / springs.tangential;
        slip[i] = std::clamp(trial, -largest, largest);
        last_x[i] = place.x;
        touching[i] = 1;
        slides = slides || slip[i] != trial;
        sticks = sticks || (slip[i] == trial && slip[i] != 0);
        const Vec2 push{-springs.tangential * slip[i], pressing};
        force += push;
        moment += cross(arm, push);
        deepest = std::max(deepest, -place.y);
        ++count;
      }
      most = std::max(most, count);
      velocity += (h / mass) * force;
      spin += h / inertia * moment;
    }
  }
};

}  // namespace udar::verification

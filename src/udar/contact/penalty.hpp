#pragma once

#include <cmath>

#include "udar/contact/gap.hpp"

namespace udar {

/// The springs between a node and a rigid boundary.
struct ContactSprings {
  double normal = 0;      ///< N/m
  double tangential = 0;  ///< N/m
  double friction = 0;    ///< Coulomb's coefficient
  double dashpot = 0;     ///< N s/m, normal direction
};

/// State of the springs of one node: what they remember and the forces they exert on the node.
struct SpringState {
  double slip = 0;         ///< m, stretch of the tangential spring along the tangent (normal turned by +90 degrees)
  double penetration = 0;  ///< m, 0 when apart
  Vec2 normal{};
  Vec2 normal_force{};    ///< N, gradient of k d^2 / 2
  Vec2 friction_force{};  ///< N
  Vec2 damping_force{};   ///< N
  std::uint32_t face = 0;
  std::uint16_t touches = 0;
  std::uint16_t slides = 0;
};

/// Energy that left the springs in the step, J.
struct SpringLosses {
  double friction = 0;  ///< in sliding
  double dropped = 0;   ///< of the tangential spring of a node that left or changed face
};

inline double tangential_energy(const SpringState& s, const ContactSprings& k) {
  return 0.5 * k.tangential * s.slip * s.slip;
}

/// The springs at the end of a step in which the node moved by `move` (m) relative to the boundary and now stands at
/// `gap`. Normal force k d along the way to the nearest point of the boundary; tangential force k_t times the slip
/// since the touch, cut at friction times the normal force (Coulomb): stick, then slide. Memory dies with the touch and
/// with a change of face; its energy is then booked, not forgotten. Damping never pulls.
inline SpringState spring_step(const SpringState& before, const Gap& gap, Vec2 move, double step,
                               const ContactSprings& k, SpringLosses& losses) {
  SpringState now;
  const bool touches = gap.distance < 0;
  const bool same_face = touches && before.touches != 0 && before.face == gap.face;
  if (before.touches != 0 && !same_face) losses.dropped += tangential_energy(before, k);
  if (!touches) return now;

  now.touches = 1;
  now.face = gap.face;
  now.normal = gap.normal;
  now.penetration = -gap.distance;
  const double pressing = k.normal * now.penetration;
  now.normal_force = pressing * gap.normal;

  if (k.dashpot > 0 && step > 0) {
    const double closing_speed = -dot(move, gap.normal) / step;
    const double damping = k.dashpot * closing_speed;
    now.damping_force = (damping < -pressing ? -pressing : damping) * gap.normal;
  }

  if (same_face && k.friction > 0) {
    const Vec2 tangent = perpendicular(gap.normal);
    const double trial = before.slip + dot(tangent, move);
    const double largest = k.friction * pressing / k.tangential;
    now.slip = trial > largest ? largest : (trial < -largest ? -largest : trial);
    now.slides = now.slip != trial ? 1 : 0;
    // Work of the mean force on the part of the motion that slid.
    losses.friction += 0.5 * k.tangential * (before.slip + now.slip) * (trial - now.slip);
    now.friction_force = (-k.tangential * now.slip) * tangent;
  }
  return now;
}

}  // namespace udar

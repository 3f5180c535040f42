#pragma once

#include <cmath>
#include <numbers>

#include "tools.hpp"
#include "udar/step/motion.hpp"
#include "udar/verification/problem.hpp"

// What both halves of the problem use: the disc on a plane (oblique-disc.cpp) and two discs (two_discs.cpp).

namespace udar::verification::oblique {

constexpr double radius = 0.05;      // m
constexpr double stiffness = 300e3;  // N/m, of the plane's spring at each node
constexpr double thickness = 0.01;   // m
constexpr double pi = std::numbers::pi;

/// How a body moves as a whole.
struct Motion {
  double mass = 0;     ///< kg
  double inertia = 0;  ///< kg m2 about the centre of mass, from the masses of the nodes, undeformed
  Vec2 centre{};       ///< m
  Vec2 velocity{};     ///< m/s
  double spin = 0;     ///< rad/s: spin momentum about the centre of mass over inertia
};

inline Motion motion_of(const Model& model, const State& state, const Body& body) {
  Motion m;
  Vec2 rest;
  for (Index i = body.node_begin; i < body.node_end; ++i) {
    m.mass += model.mass[i];
    rest += model.mass[i] * model.rest[i];
    m.centre += model.mass[i] * place(state, i);
    m.velocity += model.mass[i] * velocity(state, i);
  }
  rest *= 1 / m.mass;
  m.centre *= 1 / m.mass;
  m.velocity *= 1 / m.mass;
  double momentum = 0;
  for (Index i = body.node_begin; i < body.node_end; ++i) {
    const Vec2 arm = model.rest[i] - rest;
    m.inertia += model.mass[i] * dot(arm, arm);
    momentum += model.mass[i] * cross(place(state, i) - m.centre, velocity(state, i) - m.velocity);
  }
  m.spin = momentum / m.inertia;
  return m;
}

inline Motion motion_of(const Run& run, std::size_t body = 0) {
  return motion_of(run.model, run.state, run.model.bodies[body]);
}

/// Compliance of the disc between the touching nodes and its centre, m/N (Johnson, Contact Mechanics, 1985, 5.57: half
/// of what a cylinder gives between two strips of half-width a), with half the spacing of the nodes for a: the smallest
/// footprint that the mesh resolves, so nothing gives more.
inline double disc_compliance(double young, double element_size) {
  const double modulus = young / (1 - 0.3 * 0.3);
  const double half_width = 0.5 * 2 * pi / 6 * element_size;
  return 2 / (pi * modulus * thickness) * (std::log(4 * radius / half_width) - 0.5);
}

/// What the nodes of the rim did.
struct Rubbing {
  std::uint64_t sliding = 0;   // node-steps
  std::uint64_t sticking = 0;  // node-steps, with force in the tangential spring
  std::uint64_t touches = 0;   // begun
  double missed = 0;           // N s, normal impulse of steps in which a touch begins: friction starts with the next
  double off_cone = 0;         // largest |T| / (mu N) - 1 of nodes that slide
};

inline void note(const Run& run, double friction, const SpringState& s, Rubbing& all) {
  if (s.touches == 0) return;
  const double pressing = length(s.normal_force);
  const double rubbing = length(s.friction_force);
  if (s.slides != 0) {
    ++all.sliding;
    all.off_cone = std::max(all.off_cone, std::fabs(rubbing / (friction * pressing) - 1));
  } else if (rubbing > 0) {
    ++all.sticking;
  } else {
    ++all.touches;
    all.missed += velocity_span(run.state.clock) * pressing;
  }
}

// --- parts of the problem in two_discs.cpp

void check_two_in_gross_slip(Checks& checks);
void check_two_that_stick(Checks& checks);
void check_small_struck_by_large(Checks& checks);

}  // namespace udar::verification::oblique

#pragma once

#include "udar/model/model.hpp"
#include "udar/model/state.hpp"

namespace udar {

/// Mass damping of a node, N, before its velocity is carried on. It takes the velocity of the step that just ended,
/// half a step late, so that the scheme stays explicit.
inline Vec2 damping_force(const Model& model, const State& state, Index node, double rate, Vec2 mean_velocity) {
  const NodeRecord& r = state.nodes[node];
  return (-rate * model.mass[node]) * (Vec2{r.vx, r.vy} - mean_velocity);
}

/// Where a node will be at the end of a step, m. Nodes are moved when they are accelerated, in one pass over them; what
/// needs their new places before that takes them from here.
inline Vec2 place_after(const NodeRecord& r, double h) { return {r.x + h * r.vx, r.y + h * r.vy}; }

/// Rate of mass damping now, 1/s.
inline double damping_rate(const Model& model, const State& state) {
  const MassDamping& damping = model.run.damping;
  return damping.rate > 0 ? damping.rate * damping.factor.at(state.clock.time.value()) : 0;
}

/// What the damping of a body is against, m/s.
inline Vec2 damping_reference(const Model& model, const State& state, Index body) {
  if (model.run.damping.against == MassDamping::Against::rest) return {};
  return (1 / model.bodies[body].mass) * state.body_momentum[body];
}

/// Time over which the acceleration a_n changes the velocity of a step into that of the next, s: from the middle of the
/// one to the middle of the other, as they were planned.
inline double velocity_span(const Clock& clock) {
  return 0.5 * (clock.last_step + clock.next_step) - clock.velocity_ahead + clock.next_velocity_ahead;
}

/// Mean velocity of the last step, m/s; what held nodes are given included.
inline Vec2 velocity_of_last_step(const State& state, Index node) {
  if (!state.velocity_before.empty()) return state.velocity_before[node];
  const NodeRecord& r = state.nodes[node];
  return Vec2{r.vx, r.vy} - velocity_span(state.clock) * state.acceleration[node];
}

}  // namespace udar

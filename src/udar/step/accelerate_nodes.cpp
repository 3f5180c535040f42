#include "udar/step/integrators.hpp"
#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

/// Held nodes get their velocity exactly: the reaction carries them there up to rounding only. An Adams rule must not
/// extrapolate from a motion that is given from outside, which may jump: there v_n, too, is taken from the places, and
/// what that changes in momentum and energy is handed to the books.
void hold(const Model& model, State& state, const HeldNode& held, NodeSums& sums) {
  const bool x = model.supports[held.support].holds_x;
  const bool y = model.supports[held.support].holds_y;
  NodeRecord& record = state.nodes[held.node];
  Vec2& acceleration = state.acceleration[held.node];
  const double span = velocity_span(state.clock);
  if (state.velocity.empty()) {
    if (x) acceleration.x += (held.velocity.x - record.vx) / span;
    if (y) acceleration.y += (held.velocity.y - record.vy) / span;
  } else {
    const Vec2 before = state.velocity_before[held.node];
    if (x) acceleration.x = (held.velocity.x - before.x) / span;
    if (y) acceleration.y = (held.velocity.y - before.y) / span;
    const Vec2 given = before + (0.5 * state.clock.last_step) * acceleration;
    const double mass = model.mass[held.node];
    Vec2& v = state.velocity[held.node];
    const Vec2 now{x ? given.x : v.x, y ? given.y : v.y};
    const Vec2 more = mass * (now - v);
    sums.held_momentum += more;
    sums.momentum += more;
    const double more_spin = cross({record.x, record.y}, more);
    sums.held_spin += more_spin;
    sums.spin += more_spin;
    sums.kinetic += mass * (dot(now, now) - dot(v, v));
    v = now;
  }
  if (x) record.vx = held.velocity.x;
  if (y) record.vy = held.velocity.y;
}

}  // namespace

NodeTask node_task(const Model& model, const State& state) {
  const Clock& clock = state.clock;
  NodeTask task{.last_step = clock.last_step,
                .span = velocity_span(clock),
                .first = clock.step == 0,
                .gravity = model.run.gravity,
                .damping = damping_rate(model, state)};
  const IntegratorRule& rule = rule_of(model.run.integrator);
  if (rule.weights != nullptr) {
    if (!task.first) {
      task.done = weights_of(rule, clock.step - 1, {clock.last_step, clock.step_before, clock.second_step_before});
    }
    task.coming = weights_of(rule, clock.step, {clock.next_step, clock.last_step, clock.step_before});
  }
  return task;
}

void accelerate_nodes(const Model& model, State& state, Workspace& work, std::size_t b, const NodeForces& forces,
                      const NodeTask& common) {
  const bool multistep = rule_of(model.run.integrator).weights != nullptr;
  const NodeKernel kernel = multistep ? work.kernels.multistep : work.kernels.central_difference;
  const NodeBlock& block = model.node_blocks[b];
  const OuterNodes& outer = work.outer_nodes[b];
  NodeTask task = common;
  task.count = block.end - block.begin;
  task.nodes = &state.nodes[block.begin];
  task.mass = &model.mass[block.begin];
  task.inverse_mass = &model.inverse_mass[block.begin];
  task.internal = forces.internal;
  task.external = forces.external();
  task.acceleration = &state.acceleration[block.begin];
  if (multistep) {
    task.velocity = &state.velocity[block.begin];
    task.velocity_before = &state.velocity_before[block.begin];
    task.last_acceleration = &state.last_acceleration[block.begin];
    task.second_acceleration = &state.second_acceleration[block.begin];
  }
  if (task.damping > 0) task.damping_reference = damping_reference(model, state, block.body);
  work.node_sums[b] = kernel(task);
  for (std::size_t k = outer.held_begin; k < outer.held_end; ++k) hold(model, state, work.held[k], work.node_sums[b]);
  note_outer_nodes(model, state, work, b);
}

}  // namespace udar

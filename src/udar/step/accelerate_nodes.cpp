#include <algorithm>

#include "udar/step/integrators.hpp"
#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

/// Held nodes get their velocity exactly: the reaction carries them there up to rounding only. An Adams rule must not
/// extrapolate from a motion that is given from outside, which may jump: there v_n, too, is taken from the places, and
/// what that changes in momentum and energy is handed to the books.
class Holder {
 public:
  Holder(const Model& model, State& state, Workspace& work) : model_(model), state_(state), work_(work) {
    work.held_momentum = {};
    work.held_kinetic = 0;
  }

  void hold(Index body, Index node, bool x, bool y, Vec2 wanted) {
    NodeRecord& record = state_.nodes[node];
    Vec2& acceleration = state_.acceleration[node];
    const double mass = model_.mass[node];
    const double span = velocity_span(state_.clock);
    if (state_.velocity.empty()) {
      if (x) acceleration.x += (wanted.x - record.vx) / span;
      if (y) acceleration.y += (wanted.y - record.vy) / span;
    } else {
      const Vec2 before = state_.velocity_before[node];
      if (x) acceleration.x = (wanted.x - before.x) / span;
      if (y) acceleration.y = (wanted.y - before.y) / span;
      const Vec2 given = before + (0.5 * state_.clock.last_step) * acceleration;
      Vec2& v = state_.velocity[node];
      const Vec2 held{x ? given.x : v.x, y ? given.y : v.y};
      const Vec2 more = mass * (held - v);
      work_.held_momentum += more;
      work_.held_kinetic += mass * (dot(held, held) - dot(v, v));
      state_.body_sums[body].momentum += more;
      state_.body_sums[body].spin += cross({record.x, record.y}, more);
      v = held;
    }
    if (x) record.vx = wanted.x;
    if (y) record.vy = wanted.y;
  }

 private:
  const Model& model_;
  State& state_;
  Workspace& work_;
};

void hold_all(const Model& model, State& state, Workspace& work) {
  Holder holder(model, state, work);
  std::size_t k = 0;
  for (const Support& support : model.supports) {
    for (const Index node : support.nodes) {
      holder.hold(support.body, node, support.holds_x, support.holds_y, work.held_velocities[k++]);
    }
  }
}

void sum_bodies(const Model& model, State& state, const Workspace& work) {
  std::fill(state.body_sums.begin(), state.body_sums.end(), BodySums{});
  for (std::size_t b = 0; b < work.node_sums.size(); ++b) {
    const NodeSums& from = work.node_sums[b];
    BodySums& to = state.body_sums[model.node_blocks[b].body];
    to.position += from.position;
    to.momentum += from.momentum;
    to.force += from.force;
    to.spin += from.spin;
  }
}

/// What all blocks of nodes have in common.
NodeTask common_task(const Model& model, const State& state) {
  const Clock& clock = state.clock;
  NodeTask task{.last_step = clock.last_step,
                .next_step = clock.next_step,
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

}  // namespace

void accelerate_nodes(const Model& model, State& state, Workspace& work) {
  const bool multistep = rule_of(model.run.integrator).weights != nullptr;
  const NodeKernel kernel = multistep ? work.kernels.multistep : work.kernels.central_difference;
  const NodeTask common = common_task(model, state);
  work.pool.for_each_block(model.node_blocks.size(), [&](std::size_t b) {
    const NodeBlock& block = model.node_blocks[b];
    NodeTask task = common;
    task.count = block.end - block.begin;
    task.nodes = &state.nodes[block.begin];
    task.mass = &model.mass[block.begin];
    task.inverse_mass = &model.inverse_mass[block.begin];
    task.internal = &work.forces.internal[block.begin];
    task.external = work.outer_nodes[b].any_pushed() ? &state.external[block.begin] : nullptr;
    task.acceleration = &state.acceleration[block.begin];
    if (multistep) {
      task.velocity = &state.velocity[block.begin];
      task.velocity_before = &state.velocity_before[block.begin];
      task.last_acceleration = &state.last_acceleration[block.begin];
      task.second_acceleration = &state.second_acceleration[block.begin];
    }
    if (task.damping > 0) task.damping_reference = damping_reference(model, state, block.body);
    work.node_sums[b] = kernel(task);
  });
  sum_bodies(model, state, work);
  hold_all(model, state, work);
}

}  // namespace udar

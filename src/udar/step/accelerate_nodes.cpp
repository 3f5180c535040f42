#include "udar/step/integrators.hpp"
#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

/// What changes the velocity of a node besides its own force.
struct Drive {
  double rate = 0;  ///< 1/s, mass damping
  Vec2 gravity{};   ///< m/s2
};

/// v_{n+1/2} = v_{n-1/2} + a_n (h_n + h_{n+1}) / 2.
struct CentralDifference {
  double span;       ///< s
  double last_step;  ///< s, h_n

  Vec2 next_velocity(State&, Index, Vec2 before, Vec2 acceleration) const { return before + span * acceleration; }

  /// v_{n-1/2} . v_{n+1/2} as if the next step were as long as the last: with the velocity after a step of another
  /// length the energy at t_n would be wrong to first order.
  void book(NodeSums& sums, const State& state, Index i, double mass, Vec2 before, Vec2) const {
    sums.kinetic += mass * dot(before, before + last_step * state.acceleration[i]);
  }
  static void finish(NodeSums& sums) { sums.momentum = sums.carried; }
};

/// The Adams family and its start: closes v_n with the weights of the step just done, then extrapolates the mean
/// velocity of the step to come.
struct Multistep {
  StepWeights done;
  StepWeights coming;
  bool first;  ///< t = 0: no step was done yet

  Vec2 next_velocity(State& state, Index i, Vec2 before, Vec2 acceleration) const {
    Vec2& v = state.velocity[i];
    Vec2& a0 = state.acceleration[i];
    Vec2& a1 = state.last_acceleration[i];
    Vec2& a2 = state.second_acceleration[i];
    if (!first) {
      v += done.implicit * acceleration + done.velocity[0] * a0 + done.velocity[1] * a1 + done.velocity[2] * a2;
    }
    a2 = a1;
    a1 = a0;
    state.velocity_before[i] = before;
    return v + coming.mean[0] * acceleration + coming.mean[1] * a1 + coming.mean[2] * a2;
  }

  void book(NodeSums& sums, const State& state, Index i, double mass, Vec2, Vec2) const {
    sums.kinetic += mass * dot(state.velocity[i], state.velocity[i]);
    sums.momentum += mass * state.velocity[i];
  }
  static void finish(NodeSums&) {}
};

template <class Rule>
NodeSums accelerate_block(const Model& model, State& state, const Workspace& work, const NodeBlock& block,
                          const Drive& drive, const Rule& rule) {
  NodeSums sums;
  const Vec2 reference = drive.rate > 0 ? damping_reference(model, state, block.body) : Vec2{};
  for (Index i = block.begin; i < block.end; ++i) {
    NodeRecord& node = state.nodes[i];
    const double mass = model.mass[i];
    const Vec2 before{node.vx, node.vy};
    const Vec2 internal = internal_force(model, work, i);
    Vec2 force = internal + state.external[i];
    Vec2 damping;
    if (drive.rate > 0) {
      damping = damping_force(model, state, i, drive.rate, reference);
      force += damping;
    }
    const Vec2 acceleration = model.inverse_mass[i] * force + drive.gravity;
    const Vec2 after = rule.next_velocity(state, i, before, acceleration);
    state.acceleration[i] = acceleration;
    node.vx = after.x;
    node.vy = after.y;

    sums.internal_power += dot(internal, before + after);
    rule.book(sums, state, i, mass, before, after);
    sums.kinetic_after += mass * dot(after, after);
    sums.carried += mass * after;
    sums.spin += mass * (node.x * after.y - node.y * after.x);
    if (drive.rate > 0) {
      sums.damping_force += damping;
      sums.damping_before += dot(damping, before);
      sums.damping_after += dot(damping, after);
    }
  }
  rule.finish(sums);
  return sums;
}

template <class Rule>
void accelerate_all(const Model& model, State& state, Workspace& work, const Rule& rule) {
  const Drive drive{.rate = damping_rate(model, state), .gravity = model.run.gravity};
  work.pool.for_each_block(model.node_blocks.size(), [&](std::size_t b) {
    work.node_sums[b] = accelerate_block(model, state, work, model.node_blocks[b], drive, rule);
  });
}

/// Held nodes get their velocity exactly: the reaction carries them there up to rounding only. An Adams rule must not
/// extrapolate from a motion that is given from outside, which may jump: there v_n, too, is taken from the places, and
/// what that changes in momentum and energy is handed to the books.
class Holder {
 public:
  Holder(const Model& model, State& state, Workspace& work) : model_(model), state_(state), work_(work) {
    work.held_momentum = {};
    work.held_kinetic = 0;
  }

  void hold(Index node, bool x, bool y, Vec2 wanted) {
    NodeRecord& record = state_.nodes[node];
    Vec2& acceleration = state_.acceleration[node];
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
      work_.held_momentum += model_.mass[node] * (held - v);
      work_.held_kinetic += model_.mass[node] * (dot(held, held) - dot(v, v));
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
      holder.hold(node, support.holds_x, support.holds_y, work.held_velocities[k++]);
    }
  }
}

}  // namespace

void accelerate_nodes(const Model& model, State& state, Workspace& work) {
  const Clock& clock = state.clock;
  const IntegratorRule& rule = rule_of(model.run.integrator);
  if (rule.weights == nullptr) {
    accelerate_all(model, state, work, CentralDifference{velocity_span(clock), clock.last_step});
  } else {
    const bool first = clock.step == 0;
    const StepWeights done =
        first ? StepWeights{}
              : weights_of(rule, clock.step - 1, {clock.last_step, clock.step_before, clock.second_step_before});
    const StepWeights coming = weights_of(rule, clock.step, {clock.next_step, clock.last_step, clock.step_before});
    accelerate_all(model, state, work, Multistep{done, coming, first});
  }
  hold_all(model, state, work);
}

}  // namespace udar

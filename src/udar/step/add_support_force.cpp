#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"

namespace udar {

void set_supports(const Model& model, const State& state, Workspace& work) {
  const double time = state.clock.time.value() + state.clock.next_step;
  for (std::size_t s = 0; s < model.supports.size(); ++s) {
    const Support& support = model.supports[s];
    work.support_motions[s] = {.displacement = {support.move_x.at(time), support.move_y.at(time)},
                               .turn = support.turns ? turn_by(support.turn.at(time)) : Turn{}};
  }
}

void add_support_force(const Model& model, State& state, Workspace& work, std::size_t block, NodeForces& forces) {
  const OuterNodes& nodes = work.outer_nodes[block];
  const Clock& clock = state.clock;
  const double rate = damping_rate(model, state);
  const double span = velocity_span(clock);
  for (std::size_t k = nodes.held_begin; k < nodes.held_end; ++k) {
    HeldNode& held = work.held[k];
    const Support& support = model.supports[held.support];
    const SupportMotion& motion = work.support_motions[held.support];
    const NodeRecord& record = state.nodes[held.node];
    const Vec2 before{record.vx, record.vy};
    const Vec2 rest = model.rest[held.node];
    const Vec2 target =
        support.turns ? support.centre + motion.turn * (rest - support.centre) : rest + motion.displacement;
    held.velocity = (1 / clock.next_step) * (target - place_after(record, clock.last_step));
    const Vec2 force = forces.total(held.node) + model.mass[held.node] * model.run.gravity +
                       damping_force(model, state, held.node, rate, damping_reference(model, state, support.body));
    const Vec2 reaction = (model.mass[held.node] / span) * (held.velocity - before) - force;
    Vec2& kept = state.support_forces[held.slot];
    kept = {support.holds_x ? reaction.x : 0, support.holds_y ? reaction.y : 0};
    forces.push(held.node, kept);
  }
}

}  // namespace udar

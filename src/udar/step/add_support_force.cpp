#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"

namespace udar {

void add_support_force(const Model& model, State& state, Workspace& work) {
  if (model.supports.empty()) return;
  const Clock& clock = state.clock;
  const double target_time = clock.time.value() + clock.next_step;
  const double rate = damping_rate(model, state);
  const double span = velocity_span(clock);
  std::size_t first = 0;
  for (const Support& support : model.supports) {
    const Vec2 displacement{support.move_x.at(target_time), support.move_y.at(target_time)};
    const Turn turn = support.turns ? turn_by(support.turn.at(target_time)) : Turn{};
    for (std::size_t k = 0; k < support.nodes.size(); ++k) {
      const Index node = support.nodes[k];
      const NodeRecord& record = state.nodes[node];
      const Vec2 before{record.vx, record.vy};
      const Vec2 rest = model.rest[node];
      const Vec2 target = support.turns ? support.centre + turn * (rest - support.centre) : rest + displacement;
      const Vec2 wanted = (1 / clock.next_step) * (target - place_after(record, clock.last_step));
      const Vec2 force = work.forces.internal[node] + state.external[node] + model.mass[node] * model.run.gravity +
                         damping_force(model, state, node, rate, damping_reference(model, state, support.body));
      const Vec2 reaction = (model.mass[node] / span) * (wanted - before) - force;
      Vec2& held = state.support_forces[first + k];
      held = {support.holds_x ? reaction.x : 0, support.holds_y ? reaction.y : 0};
      state.external[node] += held;
      work.held_velocities[first + k] = wanted;
    }
    first += support.nodes.size();
  }
}

}  // namespace udar

#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"

namespace udar {

void note_outer_nodes(const Model& model, const State& state, Workspace& work, std::size_t block) {
  OuterMotion& outer = work.bodies.outer;
  const OuterNodes& nodes = work.outer_nodes[block];
  Box places, velocities;
  for (std::size_t c = nodes.contact_begin; c < nodes.contact_end; ++c) {
    const NodeRecord& r = state.nodes[model.contact_nodes[c]];
    outer.nodes[c] = r;
    places.include({r.x, r.y});
    velocities.include({r.vx, r.vy});
  }
  outer.places[block] = places;
  outer.velocities[block] = velocities;
}

void look_at_outer_nodes(const Model& model, const State& state, Workspace& work) {
  OuterMotion& outer = work.bodies.outer;
  outer.goes_on = outer.noted_for == state.clock.step;
  outer.noted_for = OuterMotion::never;  // until this step is done
  if (outer.goes_on) return;
  for (std::size_t b = 0; b < model.node_blocks.size(); ++b) note_outer_nodes(model, state, work, b);
}

Box OuterMotion::reach(std::size_t block, double step) const {
  const Box& at = places[block];
  const Box& v = velocities[block];
  if (at.low.x > at.high.x) return at;
  return {at.low + step * v.low, at.high + step * v.high};
}

}  // namespace udar

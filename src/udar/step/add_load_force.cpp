#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

/// At the end of the step, m.
Vec2 end_place(const State& state, Index node) { return place_after(state.nodes[node], state.clock.last_step); }

}  // namespace

void set_loads(const Model& model, State& state) {
  const double time = state.clock.time.value();
  std::size_t first = 0;
  for (const Load& load : model.loads) {
    Vec2* const forces = state.load_forces.data() + first;
    const double factor = load.factor.at(time);
    if (load.edges.empty()) {
      for (std::size_t k = 0; k < load.nodes.size(); ++k) forces[k] = (factor * load.shares[k]) * load.value;
    } else {
      // Half of the pressure on the deformed edge at each end, into the body, which lies on the edge's left.
      const double half_pressure = 0.5 * factor * load.pressure * load.thickness;
      for (std::size_t k = 0; k < load.edges.size(); ++k) {
        const Vec2 inward = perpendicular(end_place(state, load.edges[k].b) - end_place(state, load.edges[k].a));
        forces[2 * k] = forces[2 * k + 1] = half_pressure * inward;
      }
    }
    first += load.nodes.size();
  }
}

void add_load_force(const State& state, const Workspace& work, std::size_t block, NodeForces& forces) {
  const OuterNodes& nodes = work.outer_nodes[block];
  for (std::size_t k = nodes.loaded_begin; k < nodes.loaded_end; ++k) {
    forces.push(work.loaded[k].node, state.load_forces[work.loaded[k].slot]);
  }
}

}  // namespace udar

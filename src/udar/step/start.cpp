#include <fmt/core.h>

#include "udar/base/error.hpp"
#include "udar/step/integrators.hpp"
#include "udar/step/stages.hpp"

namespace udar {

State rest_state(const Model& model) {
  State state;
  const std::size_t nodes = model.rest.size();
  const std::size_t elements = model.corners.size();
  state.nodes.resize(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    state.nodes[i] = {model.rest[i].x, model.rest[i].y, model.start_velocity[i].x, model.start_velocity[i].y};
  }
  state.acceleration.resize(nodes);
  if (rule_of(model.run.integrator).weights != nullptr) {
    state.velocity.assign(model.start_velocity.begin(), model.start_velocity.end());
    state.velocity_before = state.velocity;
    state.last_acceleration.resize(nodes);
    state.second_acceleration.resize(nodes);
  }
  for (auto* field : {&state.stress_xx, &state.stress_yy, &state.stress_xy, &state.stress_zz, &state.plastic_strain}) {
    field->resize(elements);
  }
  state.flowing.resize(elements / lanes);
  state.frequency.resize(model.element_blocks.size());
  state.contacts.resize(model.obstacles.size() * model.contact_nodes.size());
  state.obstacles.resize(model.obstacles.size());
  std::size_t loaded = 0;
  for (const Load& load : model.loads) loaded += load.nodes.size();
  state.load_forces.resize(loaded);
  std::size_t held = 0;
  for (const Support& support : model.supports) held += support.nodes.size();
  state.support_forces.resize(held);
  state.body_momentum.resize(model.bodies.size());
  state.body_spin.resize(model.bodies.size());
  state.body_sums.resize(model.bodies.size());
  return state;
}

void refuse_buried_nodes(const Model& model, const State& state) {
  // A block may start at rest on its springs, a small part of an element deep; more is a body put in the wrong place,
  // which its springs would shoot off.
  constexpr double deepest = 0.2;
  const std::size_t count = model.contact_nodes.size();
  std::size_t worst = 0;
  double ratio = 0;
  for (std::size_t k = 0; k < state.contacts.size(); ++k) {
    const double here = state.contacts[k].penetration / model.contact_node_sizes[k % count];
    if (here <= ratio) continue;
    ratio = here;
    worst = k;
  }
  if (ratio <= deepest) return;
  const Index node = model.contact_nodes[worst % count];
  const Vec2 place = model.rest[node];
  throw UserError(ExitCode::bad_case,
                  fmt::format("body `{}` starts inside obstacle `{}`: its node at ({:.5g}, {:.5g}) m is {:.4g} m deep",
                              model.body_of_node(node).name, model.obstacles[worst / count].name, place.x, place.y,
                              state.contacts[worst].penetration),
                  "move the body (`at` of its mesh) or the obstacle, so that they touch at most");
}

}  // namespace udar

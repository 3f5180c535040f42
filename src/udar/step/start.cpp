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
  for (const RigidBody& rigid : model.rigid_bodies) {
    const RigidRate velocity{rigid.start_velocity, rigid.start_spin};
    state.rigid.push_back({.place = rigid.centre, .velocity = velocity, .now = velocity});
  }
  state.flowing.resize(elements / lanes);
  state.frequency.resize(model.element_blocks.size());
  state.contacts.resize(model.obstacles.size() * model.contact_nodes.size());
  state.obstacles.resize(model.obstacles.size());
  state.sunk.resize(model.obstacles.size());
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

}  // namespace udar

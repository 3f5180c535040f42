#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "udar/base/box.hpp"
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
  for (const RigidBody& rigid : model.rigid_bodies) {
    const RigidRate velocity{rigid.start_velocity, rigid.start_spin};
    state.rigid.push_back({.place = rigid.centre, .velocity = velocity, .now = velocity});
  }
  state.flowing.resize(elements / lanes);
  state.frequency.resize(model.element_blocks.size());
  state.contacts.resize(model.obstacles.size() * model.contact_nodes.size());
  state.obstacles.resize(model.obstacles.size());
  if (!model.segments.empty()) state.pairs.resize(pair_number(model.bodies.size(), 0));
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

namespace {

/// How deep a point lies in a body at t = 0, m; 0 outside.
double depth_in(const Model& model, Vec2 p, std::size_t body) {
  const auto place = [&](std::uint32_t point) { return model.rest[model.contact_nodes[point]]; };
  bool inside = false;  // by how often a ray to the right crosses the boundary
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint32_t s = 0; s < model.segments.size(); ++s) {
    if (model.segments[s].body != body) continue;
    const Vec2 a = place(model.segments[s].a);
    const Vec2 b = place(model.segments[s].b);
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    nearest = std::min(nearest, std::fabs(foot_on(model.segments, s, p, place).distance));
  }
  return inside ? nearest : 0;
}

}  // namespace

void refuse_overlapping_bodies(const Model& model) {
  std::vector<Box> boxes(model.bodies.size());
  for (std::size_t c = 0; c < model.contact_nodes.size(); ++c) {
    boxes[model.contact_bodies[c]].include(model.rest[model.contact_nodes[c]]);
  }
  for (std::uint32_t c = 0; c < model.contact_nodes.size(); ++c) {
    const Vec2 place = model.rest[model.contact_nodes[c]];
    for (std::uint32_t other = 0; other < model.bodies.size(); ++other) {
      if (other == model.contact_bodies[c] || !model.body_pair(c, other).touch) continue;
      if (!boxes[other].holds(place)) continue;
      const double depth = depth_in(model, place, other);
      if (depth <= deepest_start * model.contact_node_sizes[c]) continue;
      throw UserError(
          ExitCode::bad_case,
          fmt::format(
              "bodies `{}` and `{}` overlap: a node of the first at ({:.5g}, {:.5g}) m is {:.4g} m deep in the second",
              model.bodies[model.contact_bodies[c]].name, model.bodies[other].name, place.x, place.y, depth),
          "move one of them (`at` of its mesh), or let them pass through each other: [[contact.pairs]] with touch = "
          "\"no\"");
    }
  }
}

void refuse_buried_nodes(const Model& model, const State& state) {
  const std::size_t count = model.contact_nodes.size();
  std::size_t worst = 0;
  double ratio = 0;
  for (std::size_t k = 0; k < state.contacts.size(); ++k) {
    const double here = state.contacts[k].penetration / model.contact_node_sizes[k % count];
    if (here <= ratio) continue;
    ratio = here;
    worst = k;
  }
  if (ratio <= deepest_start) return;
  const Index node = model.contact_nodes[worst % count];
  const Vec2 place = model.rest[node];
  throw UserError(ExitCode::bad_case,
                  fmt::format("body `{}` starts inside obstacle `{}`: its node at ({:.5g}, {:.5g}) m is {:.4g} m deep",
                              model.body_of_node(node).name, model.obstacles[worst / count].name, place.x, place.y,
                              state.contacts[worst].penetration),
                  "move the body (`at` of its mesh) or the obstacle, so that they touch at most");
}

}  // namespace udar

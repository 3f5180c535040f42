#include <algorithm>
#include <cmath>

#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

/// Dashpot of a contact spring with the given fraction of critical damping on its node, N s/m.
double dashpot(double fraction, double stiffness, double mass) { return 2 * fraction * std::sqrt(stiffness * mass); }

/// May nodes with velocities (m/s) in this box be in front of the obstacle before a step (s) and behind it afterwards?
bool may_pass(const Obstacle& obstacle, const Box& velocities, double step) {
  const Vec2 low = velocities.low - obstacle.velocity;
  const Vec2 high = velocities.high - obstacle.velocity;
  const Vec2 largest{std::max(-low.x, high.x), std::max(-low.y, high.y)};
  return step * length(largest) > obstacle.inner_radius;
}

/// Did a node pass through within the step? One that was in it has then come out at the other side.
template <class PreparedShape>
bool passed(const PreparedShape& shape, const SpringState& before, Vec2 from, Vec2 to) {
  return before.touches != 0 ? dot(before.normal, shape.gap(to).normal) < 0 : shape.is_crossed(from, to);
}

/// Is a box of nodes out of an obstacle? Its middle is then farther from it than half of the box.
template <class PreparedShape>
bool is_far(const PreparedShape& shape, const Obstacle& obstacle, const Clock& clock, const Box& reach) {
  if (reach.low.x > reach.high.x) return true;
  const Box box = reach.shifted(-clock.time.value() * obstacle.velocity);
  if (!obstacle.bounds.meets(box)) return true;
  const Vec2 middle = 0.5 * (box.low + box.high);
  constexpr double rounding = 1 + 1e-9;
  return shape.gap(middle).distance > 0.5 * rounding * length(box.size());
}

template <class PreparedShape>
ContactSums touch_obstacle(const Model& model, const State& state, const Obstacle& obstacle, const PreparedShape& shape,
                           const OuterNodes& nodes, bool none_touched, bool fast, const OuterMotion& outer,
                           SpringState* springs, NodeForces& forces) {
  const double h = state.clock.last_step;
  const Vec2 moved = state.clock.time.value() * obstacle.velocity;
  ContactSums sums;
  for (std::size_t c = nodes.contact_begin; c < nodes.contact_end; ++c) {
    const Index node = model.contact_nodes[c];
    const NodeRecord& record = outer.nodes[c];
    const Vec2 place = place_after(record, h) - moved;
    const bool inside = obstacle.bounds.holds(place) && shape.holds(place);
    const Vec2 move = h * (Vec2{record.vx, record.vy} - obstacle.velocity);
    if (fast && !inside && passed(shape, springs[c], place - move, place)) sums.sink(obstacle.inner_radius, node);
    if (!inside && (none_touched || springs[c].touches == 0)) continue;

    const ContactSprings stiffness{obstacle.normal_stiffness[c], obstacle.tangential_stiffness[c], obstacle.friction,
                                   dashpot(model.contact.damping, obstacle.normal_stiffness[c], model.mass[node])};
    springs[c] = spring_step(springs[c], shape.gap(place), move, h, stiffness, sums.losses);
    if (springs[c].touches == 0) continue;

    ++sums.touching;
    forces.push(node, springs[c].normal_force + springs[c].friction_force + springs[c].damping_force);
    sums.normal_energy += 0.5 * stiffness.normal * springs[c].penetration * springs[c].penetration;
    sums.tangential_energy += tangential_energy(springs[c], stiffness);
    sums.largest_penetration = std::max(sums.largest_penetration, springs[c].penetration / model.contact_node_sizes[c]);
    sums.sink(springs[c].penetration, node);
  }
  return sums;
}

}  // namespace

void add_contact_force(const Model& model, State& state, Workspace& work, std::size_t b, NodeForces& forces) {
  const std::size_t blocks = model.node_blocks.size();
  const OuterNodes& nodes = work.outer_nodes[b];
  for (std::size_t c = nodes.contact_begin; work.bodies.pushes && c < nodes.contact_end; ++c) {
    const Vec2 force = work.bodies.forces[c];
    if (force != Vec2{}) forces.push(model.contact_nodes[c], force);
  }
  const OuterMotion& outer = work.bodies.outer;
  const double h = state.clock.last_step;
  const Box after = outer.reach(b, h);
  SpringState* springs = state.contacts.data();
  for (std::size_t o = 0; o < model.obstacles.size(); ++o, springs += model.contact_nodes.size()) {
    const Obstacle& obstacle = model.obstacles[o];
    ContactSums& sums = work.contact_sums[o * blocks + b];
    // Then nobody's springs need to be looked at. Of a state that the workspace does not come from that is not known.
    const bool none_touched = state.obstacles[o].touching == 0 || (outer.goes_on && sums.touching == 0);
    // What may pass through is looked for all the way, as seen from the obstacle.
    const bool fast = may_pass(obstacle, outer.velocities[b], h);
    const Box way = fast ? after.joined(outer.places[b].shifted(h * obstacle.velocity)) : after;
    sums = std::visit(
        [&](const auto& shape) {
          if (none_touched && is_far(shape, obstacle, state.clock, way)) return ContactSums{};
          return touch_obstacle(model, state, obstacle, shape, nodes, none_touched, fast, outer, springs, forces);
        },
        obstacle.prepared);
  }
}

namespace {

/// Notes the touch that goes with a new largest penetration, which is one of these. Most steps have none, and a look at
/// all springs of a block is then saved.
void note_deepest(const Model& model, State& state, std::size_t obstacle, const OuterNodes& nodes) {
  const SpringState* const springs = state.contacts.data() + obstacle * model.contact_nodes.size();
  for (std::size_t c = nodes.contact_begin; c < nodes.contact_end; ++c) {
    if (springs[c].penetration / model.contact_node_sizes[c] < state.largest_penetration) continue;
    const Index node = model.contact_nodes[c];
    state.deepest = {.depth = springs[c].penetration,
                     .time = state.clock.time.value(),
                     .place = place(state, node),
                     .stiffness = model.obstacles[obstacle].normal_stiffness[c],
                     .node = node,
                     .partner = obstacle};
    return;
  }
}

void note_deepest(const Model& model, State& state) {
  for (const BodyTouch& touch : state.touches) {
    if (touch.springs.penetration / model.contact_node_sizes[touch.point] < state.largest_penetration) continue;
    const Index node = model.contact_nodes[touch.point];
    state.deepest = {.depth = touch.springs.penetration,
                     .time = state.clock.time.value(),
                     .place = place(state, node),
                     .stiffness = touch.stiffness,
                     .node = node,
                     .into_body = 1,
                     .partner = touch.body};
    return;
  }
  for (const CornerTouch& touch : state.corner_touches) {
    const Segment& s = model.segments[touch.segment];
    if (touch.springs.penetration / model.contact_node_sizes[s.a] < state.largest_penetration) continue;
    const Index node = model.contact_nodes[touch.along < 0.5 ? s.a : s.b];
    state.deepest = {.depth = touch.springs.penetration,
                     .time = state.clock.time.value(),
                     .place = place(state, node),
                     .stiffness = touch.stiffness,
                     .node = node,
                     .partner = model.corner_of(touch.point).obstacle};
    return;
  }
}

}  // namespace

void enter_springs(const Model& model, State& state, Workspace& work) {
  work.bodies.outer.noted_for = state.clock.step + 1;
  Ledger& ledger = state.ledger;
  ledger.contact_energy = 0;
  ledger.tangential_energy = 0;
  SpringLosses losses;
  const auto enter = [&](const ContactSums& sums) {
    ledger.contact_energy += sums.normal_energy;
    ledger.tangential_energy += sums.tangential_energy;
    losses.friction += sums.losses.friction;
    losses.dropped += sums.losses.dropped;
    const bool deepest = sums.largest_penetration > state.largest_penetration;
    if (deepest) state.largest_penetration = sums.largest_penetration;
    return deepest;
  };
  const ContactSums* sums = work.contact_sums.data();
  for (std::size_t o = 0; o < model.obstacles.size(); ++o) {
    state.obstacles[o].touching = 0;
    for (std::size_t b = 0; b < model.node_blocks.size(); ++b, ++sums) {
      state.obstacles[o].touching += sums->touching;
      if (sums->depth > state.sunk[o].depth) {
        state.sunk[o] = {.depth = sums->depth, .time = state.clock.time.value(), .node = sums->deepest};
      }
      if (enter(*sums)) note_deepest(model, state, o, work.outer_nodes[b]);
    }
  }
  for (const CornerTouch& touch : state.corner_touches)
    ++state.obstacles[model.corner_of(touch.point).obstacle].touching;
  if (enter(work.bodies.sums)) note_deepest(model, state);
  ledger.tie_energy = 0;
  for (std::size_t k = 0; k < work.bodies.tie_pulls.size(); ++k) {
    const Vec2 stretch = work.bodies.tie_pulls[k].stretch;
    ledger.tie_energy += 0.5 * model.ties[k].stiffness * dot(stretch, stretch);
  }
  ledger.friction_work.add(losses.friction);
  ledger.dropped_energy.add(losses.dropped);
}

}  // namespace udar

#include <algorithm>
#include <cmath>

#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

/// Dashpot of a contact spring with the given fraction of critical damping on its node, N s/m.
double dashpot(double fraction, double stiffness, double mass) { return 2 * fraction * std::sqrt(stiffness * mass); }

/// What the springs of all nodes on one obstacle add up to.
struct ObstacleSums {
  std::uint64_t touching = 0;
  double normal_energy = 0;        ///< J
  double tangential_energy = 0;    ///< J
  double largest_penetration = 0;  ///< over the length of the boundary edges at the node
};

template <class PreparedShape>
ObstacleSums touch_obstacle(const Model& model, State& state, const Obstacle& obstacle, const PreparedShape& shape,
                            SpringState* springs, SpringLosses& losses) {
  const double h = state.clock.last_step;
  const Vec2 moved = state.clock.time.value() * obstacle.velocity;
  ObstacleSums sums;
  for (std::size_t c = 0; c < model.contact_nodes.size(); ++c) {
    const Index node = model.contact_nodes[c];
    const NodeRecord& record = state.nodes[node];
    const Vec2 place = place_after(record, h) - moved;
    if (springs[c].touches == 0 && !obstacle.bounds.holds(place)) continue;

    const ContactSprings stiffness{obstacle.normal_stiffness[c], obstacle.tangential_stiffness[c], obstacle.friction,
                                   dashpot(model.contact.damping, obstacle.normal_stiffness[c], model.mass[node])};
    const Vec2 move = h * (Vec2{record.vx, record.vy} - obstacle.velocity);
    springs[c] = spring_step(springs[c], shape.gap(place), move, h, stiffness, losses);
    if (springs[c].touches == 0) continue;

    ++sums.touching;
    state.external[node] += springs[c].normal_force + springs[c].friction_force + springs[c].damping_force;
    sums.normal_energy += 0.5 * stiffness.normal * springs[c].penetration * springs[c].penetration;
    sums.tangential_energy += tangential_energy(springs[c], stiffness);
    sums.largest_penetration = std::max(sums.largest_penetration, springs[c].penetration / model.contact_node_sizes[c]);
  }
  return sums;
}

}  // namespace

void add_contact_force(const Model& model, State& state) {
  for (const Index node : model.pushed_nodes) state.external[node] = {};

  Ledger& ledger = state.ledger;
  ledger.contact_energy = 0;
  ledger.tangential_energy = 0;
  SpringLosses losses;
  SpringState* springs = state.contacts.data();
  for (std::size_t o = 0; o < model.obstacles.size(); ++o, springs += model.contact_nodes.size()) {
    const Obstacle& obstacle = model.obstacles[o];
    const ObstacleSums sums =
        std::visit([&](const auto& shape) { return touch_obstacle(model, state, obstacle, shape, springs, losses); },
                   obstacle.prepared);
    state.obstacles[o].touching = sums.touching;
    ledger.contact_energy += sums.normal_energy;
    ledger.tangential_energy += sums.tangential_energy;
    state.largest_penetration = std::max(state.largest_penetration, sums.largest_penetration);
  }
  ledger.friction_work.add(losses.friction);
  ledger.dropped_energy.add(losses.dropped);
}

}  // namespace udar

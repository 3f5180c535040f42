#pragma once

#include <vector>

#include "udar/model/model.hpp"
#include "udar/parallel/for_each.hpp"
#include "udar/step/deform_block.hpp"

namespace udar {

/// Sums of one node block.
struct NodeSums {
  double internal_power = 0;  ///< W, sum f . (v- + v+)
  double kinetic = 0;         ///< J, twice the kinetic energy at t_n
  double kinetic_after = 0;   ///< J, sum m v+ . v+; v- and v+ are the mean velocities of the last and the coming step
  double damping_before = 0;  ///< W, sum of damping force . v-
  double damping_after = 0;   ///< W
  double spin = 0;            ///< kg m2/s
  Vec2 carried{};             ///< kg m/s, sum m v+
  Vec2 momentum{};            ///< kg m/s, of the velocity that the integrator's impulses add up to
  Vec2 damping_force{};       ///< N
};

/// Room for what a step computes and forgets, and the threads that compute it. Nothing here is State.
struct Workspace {
  Workspace(const Model& model, int threads)
      : pool(threads),
        corner_forces(3 * model.corners.size()),
        element_sums(model.element_blocks.size()),
        node_sums(model.node_blocks.size()) {
    std::size_t held = 0;
    for (const Support& support : model.supports) held += support.nodes.size();
    held_velocities.resize(held);
  }

  Pool pool;
  const BlockKernel* block_kernels = widest_block_kernels();
  std::vector<Vec2> corner_forces;  ///< N, corner 3 e + i of element e
  std::vector<ElementSums> element_sums;
  std::vector<NodeSums> node_sums;
  Vec2 held_momentum{};               ///< kg m/s, what holding nodes changed in the momentum of an Adams rule
  double held_kinetic = 0;            ///< J, and in twice its kinetic energy
  std::vector<Vec2> held_velocities;  ///< m/s, support by support, node by node: what brings them to their places
};

}  // namespace udar

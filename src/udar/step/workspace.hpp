#pragma once

#include <vector>

#include "udar/model/model.hpp"
#include "udar/parallel/for_each.hpp"
#include "udar/step/block_kernels.hpp"
#include "udar/step/quad_forces.hpp"

namespace udar {

/// Room for what a step computes and forgets, and the threads that compute it. Nothing here is State.
struct Workspace {
  Workspace(const Model& model, int threads)
      : pool(threads), forces(model), element_sums(model.element_blocks.size()), node_sums(model.node_blocks.size()) {
    std::size_t held = 0;
    for (const Support& support : model.supports) held += support.nodes.size();
    held_velocities.resize(held);
  }

  Pool pool;
  BlockKernels kernels = widest_block_kernels();
  QuadForces forces;
  std::vector<ElementSums> element_sums;
  std::vector<NodeSums> node_sums;
  Vec2 held_momentum{};               ///< kg m/s, what holding nodes changed in the momentum of an Adams rule
  double held_kinetic = 0;            ///< J, and in twice its kinetic energy
  std::vector<Vec2> held_velocities;  ///< m/s, support by support, node by node: what brings them to their places
};

}  // namespace udar

#pragma once

#include <algorithm>
#include <vector>

#include "udar/model/model.hpp"
#include "udar/parallel/for_each.hpp"
#include "udar/step/block_kernels.hpp"
#include "udar/step/quad_forces.hpp"

namespace udar {

/// Room for what a step computes and forgets, and the threads that compute it. Nothing here is State.
struct Workspace {
  Workspace(const Model& model, int threads)
      : pool(threads),
        forces(model, pool),
        element_sums(model.element_blocks.size()),
        node_sums(model.node_blocks.size()) {
    std::size_t held = 0;
    for (const Support& support : model.supports) held += support.nodes.size();
    held_velocities.resize(held);
    pushed.resize(model.node_blocks.size());
    for (std::size_t b = 0; b < pushed.size(); ++b) {
      const auto first =
          std::lower_bound(model.pushed_nodes.begin(), model.pushed_nodes.end(), model.node_blocks[b].begin);
      pushed[b] = first != model.pushed_nodes.end() && *first < model.node_blocks[b].end ? 1 : 0;
    }
  }

  Pool pool;
  BlockKernels kernels = widest_block_kernels();
  QuadForces forces;
  std::vector<std::uint8_t> pushed;  ///< 1 for each block of nodes of which contact, loads or supports may push any
  std::vector<ElementSums> element_sums;
  std::vector<NodeSums> node_sums;
  Vec2 held_momentum{};               ///< kg m/s, what holding nodes changed in the momentum of an Adams rule
  double held_kinetic = 0;            ///< J, and in twice its kinetic energy
  std::vector<Vec2> held_velocities;  ///< m/s, support by support, node by node: what brings them to their places
};

}  // namespace udar

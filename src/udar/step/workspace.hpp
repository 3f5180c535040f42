#pragma once

#include <algorithm>
#include <vector>

#include "udar/model/model.hpp"
#include "udar/parallel/for_each.hpp"
#include "udar/step/block_kernels.hpp"
#include "udar/step/quad_forces.hpp"

namespace udar {

/// What the springs between the nodes of a block and one obstacle add up to.
struct ContactSums {
  std::uint64_t touching = 0;      ///< nodes
  double normal_energy = 0;        ///< J
  double tangential_energy = 0;    ///< J
  double largest_penetration = 0;  ///< over the length of the boundary edges at the node
  SpringLosses losses;
};

/// The nodes of a block that something may push: positions in Model::contact_nodes and Model::pushed_nodes.
struct OuterNodes {
  std::size_t contact_begin = 0;
  std::size_t contact_end = 0;
  std::size_t pushed_begin = 0;
  std::size_t pushed_end = 0;

  [[nodiscard]] bool any_pushed() const { return pushed_begin < pushed_end; }
};

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
    const auto position = [](const std::vector<Index>& nodes, Index node) {
      return static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
    };
    for (const NodeBlock& block : model.node_blocks) {
      outer_nodes.push_back({position(model.contact_nodes, block.begin), position(model.contact_nodes, block.end),
                             position(model.pushed_nodes, block.begin), position(model.pushed_nodes, block.end)});
    }
    contact_sums.resize(model.obstacles.size() * model.node_blocks.size());
  }

  Pool pool;
  BlockKernels kernels = widest_block_kernels();
  QuadForces forces;
  std::vector<OuterNodes> outer_nodes;    ///< one for each block of nodes
  std::vector<ContactSums> contact_sums;  ///< obstacle by obstacle, one for each block of nodes
  std::vector<ElementSums> element_sums;
  std::vector<NodeSums> node_sums;
  Vec2 held_momentum{};               ///< kg m/s, what holding nodes changed in the momentum of an Adams rule
  double held_kinetic = 0;            ///< J, and in twice its kinetic energy
  std::vector<Vec2> held_velocities;  ///< m/s, support by support, node by node: what brings them to their places
};

}  // namespace udar

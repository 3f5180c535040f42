#pragma once

#include <vector>

#include "udar/base/box.hpp"
#include "udar/contact/search.hpp"
#include "udar/model/model.hpp"
#include "udar/model/state.hpp"
#include "udar/parallel/for_each.hpp"
#include "udar/step/account.hpp"
#include "udar/step/block_kernels.hpp"
#include "udar/step/quad_forces.hpp"

namespace udar {

/// What the springs between the nodes of a block and one obstacle add up to.
struct ContactSums {
  std::uint64_t touching = 0;      ///< nodes
  double normal_energy = 0;        ///< J
  double tangential_energy = 0;    ///< J
  double largest_penetration = 0;  ///< over the length of the boundary edges at the node
  double depth = 0;                ///< m, the largest
  Index deepest = 0;               ///< node
  SpringLosses losses;

  void sink(double how_deep, Index node) {
    if (how_deep <= depth) return;
    depth = how_deep;
    deepest = node;
  }
  ContactSums& operator+=(const ContactSums& other);
};

/// Touches of a run of points, found by one thread.
struct TouchRun {
  std::vector<BodyTouch> found;
  ContactSums sums;
};
inline constexpr std::size_t points_per_run = 256;

/// A node that a load pushes.
struct LoadedNode {
  Index node;
  std::size_t slot;  ///< in State::load_forces
};

/// A node that a support holds.
struct HeldNode {
  Index node;
  std::size_t support;
  std::size_t slot;  ///< in State::support_forces
  Vec2 velocity{};   ///< m/s, that brings it to where it has to be
};

/// Where a support has to be at the end of the coming step.
struct SupportMotion {
  Vec2 displacement{};  ///< m
  Turn turn{};
};

/// The nodes of a block that something may push: positions in Model::contact_nodes and in the Workspace's lists.
struct OuterNodes {
  std::size_t contact_begin = 0;
  std::size_t contact_end = 0;
  std::size_t loaded_begin = 0;
  std::size_t loaded_end = 0;
  std::size_t held_begin = 0;
  std::size_t held_end = 0;
};

/// Forces between two bodies, on the one that comes first in the case; or of an obstacle's corners on bodies.
struct PairForces {
  Account total;
  Account pressing;  ///< without friction
  Vec2 damping{};    ///< N, of the dashpots of an obstacle's corners
  std::uint64_t touching = 0;
};

/// The outer nodes at t_n with the velocities of the coming step, as the sweep notes them while their blocks are at
/// hand: contact looks at all of them before it.
struct OuterMotion {
  static constexpr std::uint64_t never = ~std::uint64_t{0};

  std::vector<NodeRecord> nodes;    ///< in the order of Model::contact_nodes
  std::vector<Box> places;          ///< m, of those of each block of nodes
  std::vector<Box> velocities;      ///< m/s
  std::uint64_t noted_for = never;  ///< the step that may go on from them
  bool goes_on = false;             ///< this step does: what the workspace knows is of the step before it

  /// Holds the places of a block's outer nodes at the end of a step (s), m.
  [[nodiscard]] Box reach(std::size_t block, double step) const;
};

/// Contact of bodies with each other, in one step.
struct BodyContact {
  BodyContact(const Model& model);

  Neighbours near;  ///< segments near each point, not its own
  bool listed = false;
  std::uint64_t step = 0;  ///< in which the list was last looked after
  double travel = 0;       ///< m, by which points and segments may have come nearer since it was made
  double moved = 0;        ///< m, the same in this step
  OuterMotion outer;
  bool pushes = false;                    ///< there may be forces
  std::vector<Vec2> places;               ///< m, of the points at the end of the step
  std::vector<Vec2> forces;               ///< N, on each point
  std::vector<double> springs, dashpots;  ///< N/m and N s/m, what they add to the bounds at each point
  std::vector<TouchRun> runs;             ///< of the contact nodes
  std::vector<CornerTouch> found_corners;
  std::vector<TiePull> tie_pulls;         ///< in the order of Model::ties
  ContactSums sums;                       ///< of all touches
  std::vector<PairForces> corner_forces;  ///< obstacle by obstacle
  std::vector<PairForces> pair_forces;    ///< in the order of State::pairs; nothing between two steps
  double excess = 0;                      ///< 1/s2, of their bound on frequency^2 above what elements allow for
  double dashpot = 0;                     ///< 1/s
  std::vector<double> rigid_excess;       ///< 1/s2, the same for each rigid body
  std::vector<double> rigid_dashpot;      ///< 1/s
};

/// Room for what a step computes and forgets, and the threads that compute it. Nothing here is State.
struct Workspace {
  Workspace(const Model& model, int threads);

  Pool pool;
  BlockKernels kernels = widest_block_kernels();
  QuadForces forces;
  std::vector<OuterNodes> outer_nodes;    ///< one for each block of nodes
  std::vector<ContactSums> contact_sums;  ///< obstacle by obstacle, one for each block of nodes
  BodyContact bodies;
  std::vector<Vec2> rigid_forces;  ///< N, on the nodes of the rigid body that is being moved
  std::vector<ElementSums> element_sums;
  std::vector<NodeSums> node_sums;
  std::vector<LoadedNode> loaded;  ///< in the order of nodes
  std::vector<HeldNode> held;      ///< in the order of nodes
  std::vector<SupportMotion> support_motions;
};

}  // namespace udar

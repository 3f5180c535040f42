#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

#include "udar/base/array.hpp"
#include "udar/model/model.hpp"
#include "udar/parallel/for_each.hpp"

namespace udar {

/// Forces on the nodes of one block, N.
class NodeForces {
 public:
  void begin(Index first_node) {
    first_ = first_node;
    pushed_ = false;
  }
  /// Adds a force from outside: contact, a load, a support.
  void push(Index node, Vec2 force) {
    if (!pushed_) std::fill(std::begin(external_), std::end(external_), Vec2{});
    pushed_ = true;
    external_[node - first_] += force;
  }
  [[nodiscard]] Vec2 total(Index node) const {
    const Index i = node - first_;
    return pushed_ ? internal[i] + external_[i] : internal[i];
  }
  /// From the first node of the block on; null where nothing pushes.
  [[nodiscard]] const Vec2* external() const { return pushed_ ? external_ : nullptr; }

  alignas(64) Vec2 internal[nodes_per_block];  ///< sums of the elements' forces

 private:
  alignas(64) Vec2 external_[nodes_per_block];
  Index first_ = 0;
  bool pushed_ = false;
};

/// Forces of elements on their corners, and their sums at the nodes.
///
/// A block of elements writes the forces of its quads as whole vectors: for each eight quads first all on their corners
/// 0, then on 1, 2 and 3; within eight first those of the quads with even numbers, then the odd ones, as interleaving x
/// and y leaves them. A node sums those of its corners in the order of the quads: no two threads write one place, and
/// the order does not depend on who does it or when.
///
/// A block of nodes is finished as soon as the last of its elements is done, while their forces are still in the cache,
/// and so are the nodes; what the forces were written to then serves other blocks. So forces never travel to main
/// memory, which bounds the speed of large meshes, and nodes do so once in a step. Nodes between the elements of two
/// runs have to wait until both are done.
class QuadForces {
 public:
  QuadForces(const Model& model, const Pool& pool);

  /// Where an element block writes its forces, N: four for each quad.
  [[nodiscard]] Vec2* of_block(std::size_t block) { return forces_.data() + forces_per_block * place_[block]; }

  /// Sums at the nodes of a block, each in the order of the quads; nothing from outside yet.
  void sum(std::size_t node_block, NodeForces& forces) const;

  /// Calls deform(block) for every element block, and finish(block, sums) for every block of nodes when all its
  /// elements are done.
  template <class Deform, class Finish>
  void for_each_block(Pool& pool, Deform&& deform, Finish&& finish) {
    const auto sum_and_finish = [&](std::size_t node_block, NodeForces& room) {
      sum(node_block, room);
      finish(node_block, room);
    };
    pool.for_each_run(element_blocks_, [&](std::size_t begin, std::size_t end) {
      NodeForces room;
      std::size_t next = first_done_after(begin);
      for (std::size_t block = begin; block < end; ++block) {
        deform(block);
        for (; next < early_.size() && early_[next].after == block; ++next) sum_and_finish(early_[next].nodes, room);
      }
    });
    // With few threads these are few: to wake the others would take longer.
    constexpr std::size_t few = 16;
    const auto finish_late = [&](std::size_t begin, std::size_t end) {
      NodeForces room;
      for (std::size_t k = begin; k < end; ++k) sum_and_finish(late_[k], room);
    };
    if (late_.size() <= few) {
      finish_late(0, late_.size());
    } else {
      pool.for_each_run(late_.size(), finish_late);
    }
  }

 private:
  static constexpr std::size_t forces_per_block = 4 * std::size_t{elements_per_block};

  /// A block of nodes that is complete after an element block, both of one run of the pool.
  struct Early {
    std::size_t after;
    std::size_t nodes;
  };
  [[nodiscard]] std::size_t first_done_after(std::size_t block) const;
  void plan(const Model& model, const Pool& pool);
  void number(const Model& model);

  std::size_t element_blocks_;
  const std::vector<NodeBlock>& node_blocks_;
  std::vector<Early> early_;            ///< in the order in which they are complete
  std::vector<std::size_t> late_;       ///< blocks of nodes that more than one run has elements at
  std::vector<std::size_t> place_;      ///< of each element block's forces, in units of a full block
  Array<Vec2> forces_;                  ///< N
  std::vector<std::uint32_t> offsets_;  ///< those of node i are slots_[offsets_[i]] to slots_[offsets_[i + 1] - 1]
  std::vector<std::uint32_t> slots_;    ///< places in `forces_`
};

}  // namespace udar

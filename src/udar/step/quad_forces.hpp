#pragma once

#include <cstdint>
#include <vector>

#include "udar/model/model.hpp"

namespace udar {

/// Where the forces of a quad's four corners stand, and which of them meet at each node. They are written as whole
/// vectors: for each eight quads first all forces on their corners 0, then on 1, 2 and 3; within eight first those of
/// the quads with even numbers, then the odd ones, as interleaving x and y leaves them. A node sums those of its
/// corners in the order of the quads: no two threads write the same place, and the order does not depend on them.
struct QuadForces {
  explicit QuadForces(const Model& model);

  Array<Vec2> forces;                  ///< N
  std::vector<std::uint32_t> offsets;  ///< those of node i are slots[offsets[i]] to slots[offsets[i + 1] - 1]
  std::vector<std::uint32_t> slots;    ///< places in `forces`

  /// Sum of the corner forces at a node, N.
  [[nodiscard]] Vec2 sum(Index node) const {
    Vec2 sum;
    for (std::uint32_t k = offsets[node]; k < offsets[node + 1]; ++k) sum += forces[slots[k]];
    return sum;
  }
};

}  // namespace udar

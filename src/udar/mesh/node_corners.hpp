#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "udar/mesh/mesh.hpp"

namespace udar {

/// Which corners of triangles meet at each node: those of node i are corners[offsets[i]] to corners[offsets[i + 1] -
/// 1], ascending. Corner 3 * element + local is corner `local` of that element.
struct NodeCorners {
  std::vector<std::uint32_t> offsets;  ///< one more than nodes
  std::vector<std::uint32_t> corners;  ///< three for every triangle

  [[nodiscard]] std::span<const std::uint32_t> of(Index node) const {
    return {corners.data() + offsets[node], corners.data() + offsets[node + 1]};
  }
};

/// The corners at each of `node_count` nodes. Every index must be below it.
NodeCorners node_corners(std::size_t node_count, std::span<const std::array<Index, 3>> triangles);

}  // namespace udar

#include "udar/mesh/neighbours.hpp"

namespace udar {

std::vector<std::array<Index, 3>> neighbours(std::span<const std::array<Index, 3>> triangles, const NodeCorners& map) {
  // The neighbour across the side from a to b has the side from b to a: it is one of the few triangles at node b.
  const auto with_side = [&](Index from, Index to) {
    for (const std::uint32_t corner : map.of(from)) {
      if (triangles[corner / 3][next_corner(static_cast<int>(corner % 3))] == to) return corner / 3;
    }
    return none;
  };
  std::vector<std::array<Index, 3>> across(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) across[t][k] = with_side(triangles[t][next_corner(k)], triangles[t][k]);
  }
  return across;
}

}  // namespace udar

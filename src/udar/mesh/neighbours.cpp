#include "udar/mesh/neighbours.hpp"

namespace udar {

std::vector<std::array<Index, 3>> neighbours(std::span<const std::array<Index, 3>> triangles, const NodeCorners& map) {
  // Of the two triangles on a side, one leaves the node by it and the other comes in. Going from node to node reads
  // each triangle three times only, which matters where the file numbers them at random.
  struct Visit {
    std::uint32_t corner;
    Index next;
    Index before;
  };
  std::vector<std::array<Index, 3>> across(triangles.size(), {none, none, none});
  std::vector<Visit> visits;
  for (Index node = 0; node + 1 < map.offsets.size(); ++node) {
    visits.clear();
    for (const std::uint32_t corner : map.of(node)) {
      const int local = static_cast<int>(corner % 3);
      const auto& triangle = triangles[corner / 3];
      visits.push_back({corner, triangle[next_corner(local)], triangle[next_corner(next_corner(local))]});
    }
    for (const Visit& out : visits) {
      for (const Visit& in : visits) {
        if (out.next == in.before) across[out.corner / 3][out.corner % 3] = in.corner / 3;
      }
    }
  }
  return across;
}

std::vector<Edge> outer_sides(std::span<const std::array<Index, 3>> triangles,
                              std::span<const std::array<Index, 3>> across) {
  std::vector<Edge> edges;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (across[t][k] == none) edges.push_back({triangles[t][k], triangles[t][next_corner(k)]});
    }
  }
  return edges;
}

}  // namespace udar

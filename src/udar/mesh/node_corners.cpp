#include "udar/mesh/node_corners.hpp"

namespace udar {

NodeCorners node_corners(std::size_t node_count, std::span<const std::array<Index, 3>> triangles) {
  NodeCorners map{std::vector<std::uint32_t>(node_count + 1), std::vector<std::uint32_t>(3 * triangles.size())};
  for (const auto& triangle : triangles) {
    for (const Index node : triangle) ++map.offsets[node + 1];
  }
  for (std::size_t i = 0; i < node_count; ++i) map.offsets[i + 1] += map.offsets[i];
  std::vector<std::uint32_t> next(map.offsets.begin(), map.offsets.end() - 1);
  std::uint32_t corner = 0;
  for (const auto& triangle : triangles) {
    for (const Index node : triangle) map.corners[next[node]++] = corner++;
  }
  return map;
}

}  // namespace udar

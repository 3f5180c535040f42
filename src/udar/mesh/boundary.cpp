#include "udar/mesh/boundary.hpp"

#include <algorithm>

#include "udar/mesh/neighbours.hpp"

namespace udar {

std::vector<Edge> boundary_edges(const Mesh& mesh) {
  const auto across = neighbours(mesh.triangles, node_corners(mesh.nodes.size(), mesh.triangles));
  return end_to_end(outer_sides(mesh.triangles, across));
}

std::vector<Edge> end_to_end(std::vector<Edge> edges) {
  std::sort(edges.begin(), edges.end(), [](Edge p, Edge q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });

  // After each edge the first one left that starts where it ends (two loops may touch in a node).
  std::vector<bool> walked(edges.size());
  const auto next_from = [&](Index node) {
    const auto starts_before = [](Edge edge, Index start) { return edge.a < start; };
    auto e =
        static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), node, starts_before) - edges.begin());
    while (e < edges.size() && edges[e].a == node && walked[e]) ++e;
    return e < edges.size() && edges[e].a == node ? e : edges.size();
  };
  std::vector<Edge> walk;
  walk.reserve(edges.size());
  for (std::size_t first = 0; first < edges.size(); ++first) {
    if (walked[first]) continue;
    for (std::size_t e = first; e < edges.size(); e = next_from(edges[e].b)) {
      walked[e] = true;
      walk.push_back(edges[e]);
    }
  }
  return walk;
}

}  // namespace udar

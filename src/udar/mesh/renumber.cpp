#include "udar/mesh/renumber.hpp"

#include "udar/mesh/boundary.hpp"
#include "udar/mesh/neighbours.hpp"
#include "udar/mesh/sweep.hpp"

namespace udar {

Mesh renumber(const Mesh& mesh) { return renumber(mesh, node_corners(mesh.nodes.size(), mesh.triangles)); }

Mesh renumber(const Mesh& mesh, NodeCorners corners) {
  const Sweep sweep = sweep_through(mesh, std::move(corners));
  Mesh out;
  out.nodes.reserve(mesh.nodes.size());
  out.node_numbers.reserve(mesh.nodes.size());
  out.triangles.reserve(mesh.triangles.size());
  out.triangle_numbers.reserve(mesh.triangles.size());
  std::vector<Index> new_node(mesh.nodes.size(), none);
  const auto move_node = [&](Index old) {
    if (new_node[old] == none) {
      new_node[old] = static_cast<Index>(out.nodes.size());
      out.nodes.push_back(mesh.nodes[old]);
      out.node_numbers.push_back(mesh.node_numbers[old]);
    }
    return new_node[old];
  };
  for (const Index t : sweep.triangles) {
    const auto& [a, b, c] = mesh.triangles[t];
    out.triangles.push_back({move_node(a), move_node(b), move_node(c)});
    out.triangle_numbers.push_back(mesh.triangle_numbers[t]);
  }
  for (const NamedEdges& side : mesh.sides) {
    out.sides.push_back({side.name, {}});
    for (const Edge e : side.edges) out.sides.back().edges.push_back({new_node[e.a], new_node[e.b]});
  }
  for (const Edge e : sweep.boundary) out.boundary.push_back({new_node[e.a], new_node[e.b]});
  out.boundary = end_to_end(std::move(out.boundary));
  return out;
}

}  // namespace udar

#pragma once

#include <algorithm>
#include <numeric>
#include <random>

#include "udar/mesh/boundary.hpp"
#include "udar/mesh/neighbours.hpp"
#include "udar/mesh/rectangle.hpp"

namespace udar {

/// The mesh with nodes and triangles in random order.
inline Mesh shuffled(const Mesh& mesh, unsigned seed = 1) {
  std::mt19937 random(seed);
  Mesh out = mesh;
  std::vector<Index> place(mesh.nodes.size());
  std::iota(place.begin(), place.end(), Index{0});
  std::shuffle(place.begin(), place.end(), random);
  for (std::size_t i = 0; i < place.size(); ++i) {
    out.nodes[place[i]] = mesh.nodes[i];
    out.node_numbers[place[i]] = mesh.node_numbers[i];
  }
  for (auto& triangle : out.triangles) {
    for (Index& node : triangle) node = place[node];
  }
  for (NamedEdges& side : out.sides) {
    for (Edge& e : side.edges) e = {place[e.a], place[e.b]};
  }
  std::shuffle(out.triangles.begin(), out.triangles.end(), random);
  return out;
}

/// Moves inner nodes by up to `reach` (m) each way where no triangle is squashed by it.
inline void shake(Mesh& mesh, double reach, std::mt19937& random) {
  const NodeCorners map = node_corners(mesh.nodes.size(), mesh.triangles);
  std::vector<bool> outer(mesh.nodes.size());
  for (const Edge e : boundary_edges(mesh)) outer[e.a] = true;
  const auto either_way = [&] { return reach * (0x1p-31 * static_cast<double>(random()) - 1); };
  const auto squashed = [&](std::uint32_t corner) {
    const auto& [a, b, c] = mesh.triangles[corner / 3];
    return twice_area(mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]) < 0.3 * reach * reach;
  };
  for (Index i = 0; i < mesh.nodes.size(); ++i) {
    const Vec2 before = mesh.nodes[i];
    const double x = either_way();
    const double y = either_way();
    if (outer[i]) continue;
    mesh.nodes[i] += {x, y};
    const auto corners = map.of(i);
    if (std::any_of(corners.begin(), corners.end(), squashed)) mesh.nodes[i] = before;
  }
}

/// Above 0 where `d` lies in the circle through a, b, c.
inline double in_circle(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  a -= d, b -= d, c -= d;
  return dot(a, a) * cross(b, c) + dot(b, b) * cross(c, a) + dot(c, c) * cross(a, b);
}

/// Flips sides until the mesh is a Delaunay triangulation (Lawson 1977).
inline void flip_to_delaunay(Mesh& mesh) {
  for (bool again = true; again;) {
    again = false;
    const auto across = neighbours(mesh.triangles, node_corners(mesh.nodes.size(), mesh.triangles));
    std::vector<bool> flipped(mesh.triangles.size());
    for (Index t = 0; t < mesh.triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const Index o = across[t][k];
        if (o == none || flipped[t] || flipped[o]) continue;
        const auto back = std::find(across[o].begin(), across[o].end(), t) - across[o].begin();
        const Index a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3], c = mesh.triangles[t][(k + 2) % 3];
        const Index d = mesh.triangles[o][(back + 2) % 3];
        const double size = length(mesh.nodes[b] - mesh.nodes[a]);
        const double inside = in_circle(mesh.nodes[a], mesh.nodes[b], mesh.nodes[c], mesh.nodes[d]);
        if (inside <= 1e-9 * size * size * size * size) continue;
        mesh.triangles[t] = {a, d, c};
        mesh.triangles[o] = {d, b, c};
        flipped[t] = flipped[o] = again = true;
      }
    }
  }
}

/// A Delaunay mesh of a rectangle with about as many nodes as its cells would have, none of them in rows.
inline Mesh unstructured(const RectangleMesh& shape) {
  std::mt19937 random(2);
  Mesh mesh = shape.generate();
  for (int round = 0; round < 3; ++round) {
    shake(mesh, 0.45 * shape.element_size, random);
    flip_to_delaunay(mesh);
  }
  return mesh;
}

/// Nodes that two triangles share.
inline int shared_nodes(const std::array<Index, 3>& s, const std::array<Index, 3>& t) {
  int shared = 0;
  for (const Index node : s) shared += static_cast<int>(std::count(t.begin(), t.end(), node));
  return shared;
}

}  // namespace udar

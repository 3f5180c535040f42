#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "udar/base/vec2.hpp"

namespace udar {

using Index = std::uint32_t;

/// A side of a triangle on the boundary, from `a` to `b` with the body on the left.
struct Edge {
  Index a = 0;
  Index b = 0;
  friend bool operator==(const Edge&, const Edge&) = default;
};

/// A piece of boundary that the generator named: "left", "top", "outer".
struct NamedEdges {
  std::string name;
  std::vector<Edge> edges;
};

/// Triangles of one body. Corners run counter-clockwise.
struct Mesh {
  std::vector<Vec2> nodes;  ///< m
  std::vector<std::array<Index, 3>> triangles;
  std::vector<NamedEdges> sides;
  std::vector<Edge> boundary;  ///< all of it, as `boundary_edges` has it; only renumbered meshes bring it along
  /// Number of each node and triangle as the generator or the user's file counted, from 0; renumbering keeps them.
  std::vector<Index> node_numbers;
  std::vector<Index> triangle_numbers;
};

}  // namespace udar

#pragma once

#include <vector>

#include "udar/mesh/mesh.hpp"
#include "udar/mesh/node_corners.hpp"

namespace udar {

/// All sides that only one triangle has, the body on their left: closed loops one after the other, each walked from its
/// lowest node. The mesh must pass `check_mesh`.
std::vector<Edge> boundary_edges(const Mesh& mesh);
/// Such edges, in any order, put end to end in that way.
std::vector<Edge> end_to_end(std::vector<Edge> edges);

/// Throws UserError(bad_mesh) with everything that is wrong, each kind once with its first place and count: a
/// coordinate that is not a number, a node that is not there, a triangle without area or running clockwise, a node of
/// no triangle, two triangles on the same side of an edge (as where three share it). Returns the corners at each node,
/// which it needs, for those who need them next.
NodeCorners check_mesh(const Mesh& mesh);

}  // namespace udar

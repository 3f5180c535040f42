#pragma once

#include <vector>

#include "udar/mesh/mesh.hpp"
#include "udar/mesh/node_corners.hpp"

namespace udar {

/// What a sweep through a body finds.
struct Sweep {
  std::vector<Index> triangles;  ///< in the order of the sweep
  std::vector<Edge> boundary;    ///< sides that only one triangle has, in no order
};

/// Triangles in the order of a sweep through the body from one end to the other, the halves of a pair
/// (`pair_triangles`) one after the other. All uses of a node come close together: within about one column of cells on
/// a rectangle, 1.5 to 2 columns on a disc or an unstructured mesh, so that a step can pass through the body once with
/// the front in the cache. Depends on the mesh alone; on the file's numbering only where sides or places tie. The mesh
/// must pass `check_mesh`. Time is about linear.
///
/// The order is that of Cuthill and McKee (Proc. 24th Nat. Conf. ACM, 1969): from the nodes of the body's end each node
/// in turn takes what is left of the pairs round it, counter-clockwise, and their nodes queue up. Nodes as far from the
/// end as each other, counted in pairs, take a strip of pairs; a node lies between two strips, never in a third.
///
/// Measured (the longest stretch from first to last use of a node, in columns of cells; 160 cells to a column, 80 on
/// the ring) against strips across the long axis, as wide as an element: 1.0 by both on plain cuts, 1.25 against 2.0 on
/// crossed ones, 1.7 against 3.1 on a Delaunay mesh, 2 against 44 where the size of elements changes by 20, 4.4 against
/// 12 on a ring, whose two arms are swept together. Starting from one outermost node, as George and Liu (1979) do,
/// makes it 2.0 on plain cuts and 2.5 on a Delaunay mesh: the front then lies askew.
Sweep sweep_through(const Mesh& mesh, NodeCorners corners);

}  // namespace udar

#pragma once

#include <array>
#include <vector>

#include "udar/base/array.hpp"
#include "udar/mesh/mesh.hpp"

namespace udar {

inline constexpr Index elements_per_block = 256;
inline constexpr Index nodes_per_block = 256;
inline constexpr Index lanes = 8;  ///< element arrays are padded to this

/// Two triangles that share the side from corner 0 to corner 1: (0, 1, 2) and (0, 3, 1), counter-clockwise. One read of
/// four nodes and one write of four forces serve both. A triangle without a partner stands alone as {a, b, c, a}.
using Quad = std::array<Index, 4>;

/// A stretch of elements of one body, the unit of work of the element sweep and of its fixed order of sums.
struct ElementBlock {
  Index begin = 0;
  Index end = 0;
  Index body = 0;
  Index quads = 0;  ///< first of its quads
  /// In a paired block the first half of the elements are the first triangles of its quads, the second half the second
  /// ones, so that both are whole vectors; else each element has a quad of its own.
  bool paired = false;
  double dashpot = 0;  ///< 1/s, the most that contact dashpots on its elements may add to what limits the step

  [[nodiscard]] Index quad_count() const { return paired ? (end - begin) / 2 : end - begin; }
};

/// A mesh cut into blocks.
struct MeshBlocks {
  Array<Quad> quads;                 ///< padded to `lanes`; those of padding are {none, none, none, none}
  std::vector<ElementBlock> blocks;  ///< in whole vectors; only the last one has padding, at its end
};

/// Forms pairs of triangles that follow one another in the mesh and share a side, cuts blocks, and puts the triangles
/// and their numbers in the order of the blocks. Corners are turned to how the quads have them. O(n).
MeshBlocks cut_blocks(Mesh& mesh);

}  // namespace udar

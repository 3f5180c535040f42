#pragma once

#include <vector>

#include "udar/mesh/mesh.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// Square cells cut into triangles. Named sides: bottom, right, top, left (of the rectangle before it is turned).
struct RectangleMesh {
  static constexpr const char* keyword = "rectangle";
  static constexpr const char* doc =
      "rectangle of square cells, each cut into triangles; sides: bottom, right, top, left (before it is turned)";
  /// How a cell is cut. right: lower left to upper right; left: the other way; alternating: cell (i, j) counted from
  /// the lower left one is cut `right` where i + j is even; crossed: by both diagonals, four triangles.
  enum class Diagonals { right, left, alternating, crossed };

  Vec2 size{};              ///< m, width and height
  Vec2 at{};                ///< m, lower left corner; the rectangle is turned about it
  double turn = 0;          ///< rad, counter-clockwise
  double element_size = 0;  ///< m, side of a cell; the nearest whole number of cells is taken on each side
  Diagonals diagonals = Diagonals::alternating;

  static std::vector<Parameter<RectangleMesh>> parameters();

  /// Nodes row by row from the lower left corner (in a crossed mesh the row of centres follows its lower row);
  /// triangles cell by cell: the lower one first, or bottom, right, top, left.
  [[nodiscard]] Mesh generate() const;
};

}  // namespace udar

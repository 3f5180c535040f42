#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "udar/mesh/mesh.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// Square cells cut into triangles. Named sides: bottom, right, top, left (of the rectangle before it is turned).
struct RectangleMesh {
  static constexpr const char* keyword = "rectangle";
  static constexpr const char* doc =
      "rectangle of square cells, each cut into triangles; sides: bottom, right, top, left (before it is turned)";
  static constexpr std::array side_names{"bottom", "right", "top", "left"};
  /// How a cell is cut. right: lower left to upper right; left: the other way; alternating: cell (i, j) counted from
  /// the lower left one is cut `right` where i + j is even; crossed: by both diagonals, four triangles.
  enum class Diagonals { right, left, alternating, crossed };

  Vec2 size{};              ///< m, width and height
  Vec2 at{};                ///< m, lower left corner; the rectangle is turned about it
  double turn = 0;          ///< rad, counter-clockwise
  double element_size = 0;  ///< m, side of a cell; the nearest whole number of cells is taken on each side
  Diagonals diagonals = Diagonals::alternating;

  // Finer somewhere, where finest_size is given: see Grading.
  std::optional<double> finest_size{};  ///< m
  std::optional<Vec2> finest_at{};      ///< m, a point of the placed body; or
  std::string finest_side{};            ///< one of side_names
  double finest_within = 0;             ///< m
  double growth = 1.2;

  static std::vector<Parameter<RectangleMesh>> parameters();

  /// Nodes row by row from the lower left corner (in a crossed mesh the row of centres follows its lower row);
  /// triangles cell by cell: the lower one first, or bottom, right, top, left.
  /// Where a grading is asked for, such a mesh with cells of at most `element_size` is refined; if they are square,
  /// every angle is 45 or 90 degrees as before.
  [[nodiscard]] Mesh generate() const;
  /// How far a point lies outside the placed shape, m; negative inside.
  [[nodiscard]] double distance_outside(Vec2 point) const;
};

}  // namespace udar

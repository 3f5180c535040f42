#pragma once

#include <variant>
#include <vector>

#include "udar/mesh/mesh.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// Square cells cut into triangles. Named sides: bottom, right, top, left (of the rectangle before it is turned).
struct RectangleMesh {
  static constexpr const char* keyword = "rectangle";
  static constexpr const char* doc = "rectangle of square cells, each cut into triangles";
  /// How a cell is cut. right: lower left to upper right; left: the other way; alternating: cell (i, j) counted from
  /// the lower left one is cut `right` where i + j is even; crossed: by both diagonals, four triangles.
  enum class Diagonals { right, left, alternating, crossed };

  Vec2 size{};               ///< m, width and height
  Vec2 at{};                 ///< m, lower left corner; the rectangle is turned about it
  double turn = 0;           ///< rad, counter-clockwise
  double element_size = 0;   ///< m, side of a cell; the nearest whole number of cells is taken on each side
  Diagonals diagonals = Diagonals::alternating;

  static std::vector<Parameter<RectangleMesh>> parameters();
};

/// Disc of triangles in rings about the centre. Named side: outer.
struct DiscMesh {
  static constexpr const char* keyword = "disc";
  static constexpr const char* doc = "disc of triangles in rings about its centre";

  double radius = 0;        ///< m
  Vec2 at{};                ///< m, centre
  double turn = 0;          ///< rad
  double element_size = 0;  ///< m

  static std::vector<Parameter<DiscMesh>> parameters();
};

/// Ring of cells cut into triangles. Named sides: outer, inner.
struct RingMesh {
  static constexpr const char* keyword = "ring";
  static constexpr const char* doc = "ring of cells, each cut into triangles";

  double outer_radius = 0;  ///< m
  double inner_radius = 0;  ///< m
  Vec2 at{};                ///< m, centre
  double turn = 0;          ///< rad
  double element_size = 0;  ///< m

  static std::vector<Parameter<RingMesh>> parameters();
};

/// Every mesh generator. A new one is added here and nowhere else.
using MeshShape = std::variant<RectangleMesh, DiscMesh, RingMesh>;

/// The mesh of a shape, placed and turned, numbered as generated. Throws UserError(bad_mesh) where the sizes make no
/// mesh: not a whole cell fits, an inner radius not below the outer one, more than 2^31 corners.
Mesh generate(const MeshShape& shape);

}  // namespace udar

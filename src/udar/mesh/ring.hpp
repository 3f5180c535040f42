#pragma once

#include <vector>

#include "udar/mesh/mesh.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// Ring of cells cut into triangles. Named sides: outer, inner.
struct RingMesh {
  static constexpr const char* keyword = "ring";
  static constexpr const char* doc = "ring of cells, each cut into triangles; sides: outer, inner";

  double outer_radius = 0;  ///< m
  double inner_radius = 0;  ///< m
  Vec2 at{};                ///< m, centre
  double turn = 0;          ///< rad
  double element_size = 0;  ///< m, side of a cell half-way between the radii

  static std::vector<Parameter<RingMesh>> parameters();

  /// Nodes and cells circle by circle from the inner one; cells are cut by alternating diagonals.
  [[nodiscard]] Mesh generate() const;
};

}  // namespace udar

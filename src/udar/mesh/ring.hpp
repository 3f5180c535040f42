#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "udar/mesh/mesh.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// Ring of cells cut into triangles. Named sides: outer, inner.
struct RingMesh {
  static constexpr const char* keyword = "ring";
  static constexpr const char* doc = "ring of cells, each cut into triangles; sides: outer, inner";
  static constexpr std::array side_names{"outer", "inner"};

  double outer_radius = 0;  ///< m
  double inner_radius = 0;  ///< m
  Vec2 at{};                ///< m, centre
  double turn = 0;          ///< rad
  double element_size = 0;  ///< m, side of a cell half-way between the radii

  // Finer somewhere, where finest_size is given: see Grading.
  std::optional<double> finest_size{};  ///< m
  std::optional<Vec2> finest_at{};      ///< m, a point of the placed body; or
  std::string finest_side{};            ///< one of side_names
  double finest_within = 0;             ///< m
  double growth = 1.2;

  static std::vector<Parameter<RingMesh>> parameters();

  /// Nodes and cells circle by circle from the inner one; cells are cut by alternating diagonals. Where a
  /// grading is asked for, such a mesh with cells of at most `element_size` is refined.
  [[nodiscard]] Mesh generate() const;
  /// How far a point lies outside the placed shape, m; negative inside.
  [[nodiscard]] double distance_outside(Vec2 point) const;
};

}  // namespace udar

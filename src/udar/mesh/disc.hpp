#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "udar/mesh/mesh.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// Disc of triangles in rings about the centre. Named side: outer.
struct DiscMesh {
  static constexpr const char* keyword = "disc";
  static constexpr const char* doc = "disc of triangles in rings about its centre; side: outer";
  static constexpr std::array side_names{"outer"};

  double radius = 0;        ///< m
  Vec2 at{};                ///< m, centre
  double turn = 0;          ///< rad
  double element_size = 0;  ///< m, from ring to ring; the nearest whole number of rings is taken

  // Finer somewhere, where finest_size is given: see Grading.
  std::optional<double> finest_size{};  ///< m
  std::optional<Vec2> finest_at{};      ///< m, a point of the placed body; or
  std::string finest_side{};            ///< one of side_names
  double finest_within = 0;             ///< m
  double growth = 1.2;

  static std::vector<Parameter<DiscMesh>> parameters();

  /// Ring k has 6 k nodes, so every angle is between 43 and 93 degrees. Nodes and triangles ring by ring from the
  /// centre. Where a grading is asked for, such a mesh with rings of at most
  /// `element_size` is refined; angles down to 19 degrees were measured then.
  [[nodiscard]] Mesh generate() const;
  /// How far a point lies outside the placed shape, m; negative inside.
  [[nodiscard]] double distance_outside(Vec2 point) const;
};

}  // namespace udar

#pragma once

#include <vector>

#include "udar/mesh/mesh.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// Disc of triangles in rings about the centre. Named side: outer.
struct DiscMesh {
  static constexpr const char* keyword = "disc";
  static constexpr const char* doc = "disc of triangles in rings about its centre; side: outer";

  double radius = 0;        ///< m
  Vec2 at{};                ///< m, centre
  double turn = 0;          ///< rad
  double element_size = 0;  ///< m, from ring to ring; the nearest whole number of rings is taken

  static std::vector<Parameter<DiscMesh>> parameters();

  /// Ring k has 6 k nodes, so every angle is between 43 and 93 degrees. Nodes and triangles ring by ring from the
  /// centre.
  [[nodiscard]] Mesh generate() const;
};

}  // namespace udar

#pragma once

#include <variant>

#include "udar/mesh/disc.hpp"
#include "udar/mesh/rectangle.hpp"
#include "udar/mesh/ring.hpp"

namespace udar {

/// Every mesh generator. A new one is added here and nowhere else.
using MeshShape = std::variant<RectangleMesh, DiscMesh, RingMesh>;

/// The mesh of a shape, placed and turned, numbered as generated. Throws UserError(bad_mesh) where the sizes make no
/// mesh: not a whole cell fits, an inner radius not below the outer one, more than 2^31 corners.
Mesh generate(const MeshShape& shape);

}  // namespace udar

#pragma once

#include <variant>

#include "udar/contact/circle.hpp"
#include "udar/contact/half_plane.hpp"
#include "udar/contact/polygon.hpp"

namespace udar {

/// Every shape of a rigid obstacle. A new one is added here and nowhere else.
using Shape = std::variant<HalfPlane, Rectangle, Polygon, Circle>;

}  // namespace udar

#include "udar/mesh/generators.hpp"

namespace udar {

Mesh generate(const MeshShape& shape) {
  return std::visit([](const auto& s) { return s.generate(); }, shape);
}

}  // namespace udar

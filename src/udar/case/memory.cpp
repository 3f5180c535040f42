#include "udar/case/memory.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "udar/base/memory.hpp"
#include "udar/mesh/cells.hpp"
#include "udar/mesh/grading.hpp"

namespace udar {
namespace {

/// Elements and outer nodes, about.
struct Counts {
  double elements = 0;
  double outer_nodes = 0;
};

Counts counts_of(const RectangleMesh& mesh, double size) {
  const double per_cell = mesh.diagonals == RectangleMesh::Diagonals::crossed ? 4 : 2;
  const double across = mesh.size.x / size;
  const double up = mesh.size.y / size;
  return {per_cell * across * up, 2 * (across + up)};
}

Counts counts_of(const DiscMesh& mesh, double size) {
  const double rings = mesh.radius / size;
  return {6 * rings * rings, 6 * rings};
}

Counts counts_of(const RingMesh& mesh, double size) {
  const double layers = (mesh.outer_radius - mesh.inner_radius) / size;
  const double around = std::numbers::pi * (mesh.outer_radius + mesh.inner_radius) / size;
  return {2 * layers * around, 2 * around};
}

Counts counts_of(const Case& c) {
  Counts sum;
  for (const BodyCase& body : c.bodies) {
    const Counts one = std::visit(
        [](const auto& mesh) { return counts_of(mesh, coarse_size(grading_of(mesh), mesh.element_size)); }, body.mesh);
    // A body may have a single element, and a case thousands of bodies.
    sum.elements += std::max(one.elements, 1.0);
    sum.outer_nodes += std::max(one.outer_nodes, 3.0);
  }
  return sum;
}

/// Springs of an obstacle at each outer node.
constexpr double bytes_per_spring = 2 * sizeof(double);

double memory_of(const Case& c, const Counts& counts) {
  return least_bytes_per_element * counts.elements +
         bytes_per_spring * counts.outer_nodes * static_cast<double>(c.obstacles.size());
}

}  // namespace

double elements_about(const Case& c) { return counts_of(c).elements; }

double memory_about(const Case& c) { return memory_of(c, counts_of(c)); }

void check_memory(const Case& c) {
  const Counts counts = counts_of(c);
  check_memory_for(counts.elements, memory_of(c, counts));
}

}  // namespace udar

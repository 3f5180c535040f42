#include "udar/case/memory.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "udar/base/memory.hpp"
#include "udar/mesh/cells.hpp"
#include "udar/mesh/grading.hpp"
#include "udar/model/state.hpp"

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

/// How long a named side is and how deep the body behind it, m.
struct Side {
  double length = 0;
  double depth = 0;
};

Side side_of(const RectangleMesh& mesh) {
  const bool level = mesh.finest_side == "bottom" || mesh.finest_side == "top";
  return {level ? mesh.size.x : mesh.size.y, std::min(mesh.size.x, mesh.size.y)};
}

Side side_of(const DiscMesh& mesh) { return {2 * std::numbers::pi * mesh.radius, mesh.radius}; }

Side side_of(const RingMesh& mesh) {
  const double radius = mesh.finest_side == "outer" ? mesh.outer_radius : mesh.inner_radius;
  return {2 * std::numbers::pi * radius, mesh.outer_radius - mesh.inner_radius};
}

/// Elements that a grading asks for: two for each square of the size that they may have. Round a point, which may lie
/// in a corner, only those of the finest size are counted, in a quarter of a disc. Along a side of length L there are L
/// / s^2 squares for each metre of depth d, where s = finest + (growth - 1) d behind the depth in which all are finest.
template <class Shape>
double graded_elements(const Shape& mesh) {
  if (!mesh.finest_size) return 0;
  constexpr double per_square = 1.9;  // of a disc; of others 2
  const double finest = *mesh.finest_size;
  const Side side = side_of(mesh);
  const double within = std::min(mesh.finest_within, side.depth);
  if (mesh.finest_at) return per_square * 0.25 * std::numbers::pi * (within / finest) * (within / finest);
  const double coarsest = std::min(mesh.element_size, finest + (mesh.growth - 1) * (side.depth - within));
  const double behind = (1 - finest / coarsest) / (mesh.growth - 1);
  return per_square * side.length / finest * (within / finest + behind);
}

template <class Shape>
Counts counts_of(const Shape& mesh) {
  Counts counts = counts_of(mesh, coarse_size(grading_of(mesh), mesh.element_size));
  counts.elements = std::max(counts.elements, graded_elements(mesh));
  return counts;
}

Counts counts_of(const Case& c) {
  Counts sum;
  for (const BodyCase& body : c.bodies) {
    const Counts one = std::visit([](const auto& mesh) { return counts_of(mesh); }, body.mesh);
    // A body may have a single element, and a case thousands of bodies.
    sum.elements += std::max(one.elements, 1.0);
    sum.outer_nodes += std::max(one.outer_nodes, 3.0);
  }
  return sum;
}

/// Of an obstacle at each outer node: how stiff its springs are, and their state.
constexpr double bytes_per_spring = 2 * sizeof(double) + sizeof(SpringState);

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

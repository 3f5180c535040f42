#include "udar/mesh/ring.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "udar/base/error.hpp"
#include "udar/mesh/cells.hpp"
#include "udar/mesh/grading.hpp"

namespace udar {
namespace {

constexpr double whole_turn = 6.283185307179586;  // 2 pi

Mesh refined_ring(const RingMesh& shape) {
  Mesh mesh = ungraded(shape).generate();
  longest_side_as_base(mesh);
  const auto distance = [&](Vec2 x) {
    if (shape.finest_at) return length(x - *shape.finest_at);
    const double r = length(x - shape.at);
    return shape.finest_side == "outer" ? shape.outer_radius - r : r - shape.inner_radius;
  };
  const auto onto = [&](const std::string& side, Vec2 middle) {
    return on_circle(middle, shape.at, side == "outer" ? shape.outer_radius : shape.inner_radius);
  };
  return refine(std::move(mesh), grading_of(shape), shape.element_size, distance, onto);
}

}  // namespace

std::vector<Parameter<RingMesh>> RingMesh::parameters() {
  std::vector<Parameter<RingMesh>> all{
      {"outer_radius", &RingMesh::outer_radius, dimension::length, limits::positive, "outer radius"},
      {"inner_radius", &RingMesh::inner_radius, dimension::length, limits::positive, "radius of the hole"},
      {"at", &RingMesh::at, dimension::length, {}, "centre", false},
      {"turn", &RingMesh::turn, dimension::angle, {-1e4, 1e4}, "turn about the centre, counter-clockwise", false},
      {"element_size", &RingMesh::element_size, dimension::length, limits::positive, "side of a cell"}};
  add_grading_parameters(all);
  return all;
}

double RingMesh::distance_outside(Vec2 point) const {
  const double r = length(point - at);
  return std::max(r - outer_radius, inner_radius - r);
}

Mesh RingMesh::generate() const {
  check_placement(at, turn);
  if (!(inner_radius > 0 && inner_radius < outer_radius)) {
    throw UserError(ExitCode::bad_mesh, "the inner radius of a ring must be above 0 and below its outer radius",
                    "for a whole disc take shape = \"disc\"");
  }
  check_grading(*this);
  if (finest_size) return refined_ring(*this);
  const Index layers = cells_along(outer_radius - inner_radius, element_size, "width of the ring");
  const double middle = 0.5 * (inner_radius + outer_radius);
  // An even number, so that the diagonals alternate all the way round; below six the inner circle is hardly one.
  const Index pairs = cells_along(std::max(0.5 * whole_turn * middle, 3 * element_size), element_size, "half circle");
  const Index around = 2 * pairs;
  check_triangle_count(2.0 * layers * around);

  Mesh mesh;
  for (Index j = 0; j <= layers; ++j) {
    const double r = j == layers ? outer_radius : inner_radius + (outer_radius - inner_radius) * j / layers;
    for (Index i = 0; i < around; ++i) mesh.nodes.push_back(at + turn_by(turn + whole_turn * i / around) * Vec2{r, 0});
  }
  const auto node = [&](Index i, Index j) { return j * around + i % around; };
  for (Index j = 0; j < layers; ++j) {
    for (Index i = 0; i < around; ++i) {
      const Index a = node(i, j);
      const Index b = node(i, j + 1);
      const Index c = node(i + 1, j + 1);
      const Index d = node(i + 1, j);
      if ((i + j) % 2 == 0) {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
  std::vector<Index> outer, inner;
  for (Index i = 0; i <= around; ++i) {
    outer.push_back(node(i, layers));
    inner.push_back(node(around - i, 0));
  }
  mesh.sides = {named_path("outer", outer), named_path("inner", inner)};
  number_as_generated(mesh);
  return mesh;
}

}  // namespace udar

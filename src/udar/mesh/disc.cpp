#include "udar/mesh/disc.hpp"

#include <cmath>
#include <tuple>
#include <utility>

#include "udar/mesh/cells.hpp"
#include "udar/mesh/grading.hpp"

namespace udar {
namespace {

constexpr double sixth_of_turn = 1.0471975511965976;  // pi / 3

/// Number of node `m` (0 <= m < 6 k) of ring `k`, the centre being ring 0.
Index ring_node(Index k, Index m) { return k == 0 ? 0 : 1 + 3 * k * (k - 1) + m % (6 * k); }

/// Triangles between rings k - 1 and k: in each of six sectors k of them stand on the outer ring and k - 1 on the
/// inner.
void fill_ring(Index k, std::vector<std::array<Index, 3>>& triangles) {
  for (Index sector = 0; sector < 6; ++sector) {
    for (Index m = 0; m < k; ++m) {
      const Index outer = ring_node(k, sector * k + m);
      const Index outer_next = ring_node(k, sector * k + m + 1);
      const Index inner = ring_node(k - 1, sector * (k - 1) + m);
      triangles.push_back({inner, outer, outer_next});
      if (m + 1 < k) triangles.push_back({inner, outer_next, ring_node(k - 1, sector * (k - 1) + m + 1)});
    }
  }
}

Mesh refined_disc(const DiscMesh& shape) {
  Mesh mesh = ungraded(shape).generate();
  // The base of each triangle is its side along a ring, which the triangle on the other side of that ring shares. As
  // `fill_ring` has them it is opposite the first corner, or the second one where the inner ring has it.
  const auto ring = [&](Index node) {
    return node == 0 ? 0 : static_cast<Index>((3 + std::sqrt(12.0 * node - 3)) / 6);
  };
  for (auto& [a, b, c] : mesh.triangles) {
    if (ring(a) == ring(c)) std::tie(a, b, c) = std::tuple(b, c, a);
  }
  const auto distance = [&](Vec2 x) {
    return shape.finest_at ? length(x - *shape.finest_at) : shape.radius - length(x - shape.at);
  };
  return refine(std::move(mesh), grading_of(shape), shape.element_size, distance,
                [&](const std::string&, Vec2 middle) { return on_circle(middle, shape.at, shape.radius); });
}

}  // namespace

std::vector<Parameter<DiscMesh>> DiscMesh::parameters() {
  std::vector<Parameter<DiscMesh>> all{
      {"radius", &DiscMesh::radius, dimension::length, limits::positive, "radius"},
      {"at", &DiscMesh::at, dimension::length, {}, "centre", false},
      {"turn", &DiscMesh::turn, dimension::angle, {-1e4, 1e4}, "turn about the centre, counter-clockwise", false},
      {"element_size", &DiscMesh::element_size, dimension::length, limits::positive, "distance of the rings"}};
  add_grading_parameters(all);
  return all;
}

double DiscMesh::distance_outside(Vec2 point) const { return length(point - at) - radius; }

Mesh DiscMesh::generate() const {
  check_placement(at, turn);
  check_grading(*this);
  if (finest_size) return refined_disc(*this);
  const Index rings = cells_along(radius, element_size, "radius");
  check_triangle_count(6.0 * rings * rings);
  Mesh mesh;
  mesh.nodes.push_back(at);
  std::vector<Index> outer;
  for (Index k = 1; k <= rings; ++k) {
    const double r = k == rings ? radius : radius * k / rings;
    for (Index m = 0; m < 6 * k; ++m) mesh.nodes.push_back(at + turn_by(turn + sixth_of_turn * m / k) * Vec2{r, 0});
    fill_ring(k, mesh.triangles);
  }
  for (Index m = 0; m <= 6 * rings; ++m) outer.push_back(ring_node(rings, m));
  mesh.sides = {named_path("outer", outer)};
  number_as_generated(mesh);
  return mesh;
}

}  // namespace udar

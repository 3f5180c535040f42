#include "udar/mesh/rectangle.hpp"

#include <algorithm>
#include <utility>

#include "udar/mesh/cells.hpp"
#include "udar/mesh/grading.hpp"

namespace udar {
namespace {

/// Place `i` of `n` equal steps from `a` to `b`. Both ends are met exactly and the two halves mirror each other to the
/// last bit, which a + (b - a) * i / n does not do: a symmetric beam stays symmetric.
double between(double a, double b, Index i, Index n) {
  return 2.0 * i < n ? a + (b - a) * i / n : b - (b - a) * (n - i) / n;
}

/// A grid of nx by ny cells and the numbers of its nodes.
struct Grid {
  Index nx;
  Index ny;
  bool centres;  ///< every cell has a node in its middle too

  [[nodiscard]] Index row() const { return centres ? 2 * nx + 1 : nx + 1; }
  [[nodiscard]] Index node(Index i, Index j) const { return j * row() + i; }
  [[nodiscard]] Index centre(Index i, Index j) const { return j * row() + nx + 1 + i; }
};

std::vector<Vec2> place_nodes(const RectangleMesh& shape, const Grid& grid) {
  const Turn turn = turn_by(shape.turn);
  const Vec2 width = turn * Vec2{shape.size.x, 0};
  const Vec2 height = turn * Vec2{0, shape.size.y};
  const Vec2 right = shape.at + width;
  const Vec2 top = shape.at + height;
  // In half cells: the centres lie half-way.
  const auto place = [&](Index i, Index j) {
    const Index nx = 2 * grid.nx;
    const Index ny = 2 * grid.ny;
    return Vec2{between(shape.at.x, right.x, i, nx) + between(0, height.x, j, ny),
                between(0, width.y, i, nx) + between(shape.at.y, top.y, j, ny)};
  };
  std::vector<Vec2> nodes;
  nodes.reserve(std::size_t{grid.row()} * (grid.ny + 1));
  for (Index j = 0; j <= grid.ny; ++j) {
    for (Index i = 0; i <= grid.nx; ++i) nodes.push_back(place(2 * i, 2 * j));
    if (!grid.centres || j == grid.ny) continue;
    for (Index i = 0; i < grid.nx; ++i) nodes.push_back(place(2 * i + 1, 2 * j + 1));
  }
  return nodes;
}

std::vector<std::array<Index, 3>> cut_cells(RectangleMesh::Diagonals diagonals, const Grid& grid) {
  using Diagonals = RectangleMesh::Diagonals;
  std::vector<std::array<Index, 3>> triangles;
  triangles.reserve(std::size_t{grid.nx} * grid.ny * (grid.centres ? 4 : 2));
  for (Index j = 0; j < grid.ny; ++j) {
    for (Index i = 0; i < grid.nx; ++i) {
      const Index a = grid.node(i, j);
      const Index b = grid.node(i + 1, j);
      const Index c = grid.node(i + 1, j + 1);
      const Index d = grid.node(i, j + 1);
      if (diagonals == Diagonals::crossed) {
        const Index m = grid.centre(i, j);
        triangles.insert(triangles.end(), {{a, b, m}, {b, c, m}, {c, d, m}, {d, a, m}});
      } else if (diagonals == Diagonals::right || (diagonals == Diagonals::alternating && (i + j) % 2 == 0)) {
        triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        triangles.insert(triangles.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
  return triangles;
}

std::vector<NamedEdges> name_sides(const Grid& grid) {
  std::vector<Index> bottom, right, top, left;
  for (Index i = 0; i <= grid.nx; ++i) {
    bottom.push_back(grid.node(i, 0));
    top.push_back(grid.node(grid.nx - i, grid.ny));
  }
  for (Index j = 0; j <= grid.ny; ++j) {
    right.push_back(grid.node(grid.nx, j));
    left.push_back(grid.node(0, grid.ny - j));
  }
  return {named_path("bottom", bottom), named_path("right", right), named_path("top", top), named_path("left", left)};
}

/// Distance of a place from the finest point or side.
DistanceTo distance_to_finest(const RectangleMesh& shape) {
  if (shape.finest_at) return [p = *shape.finest_at](Vec2 x) { return length(x - p); };
  const Turn q = turn_by(shape.turn);
  const bool far = shape.finest_side == "right" || shape.finest_side == "top";
  const bool along_x = shape.finest_side == "right" || shape.finest_side == "left";
  const Vec2 inward = (far ? -1.0 : 1.0) * (q * (along_x ? Vec2{1, 0} : Vec2{0, 1}));
  const Vec2 corner = far ? shape.at + q * shape.size : shape.at;
  return [=](Vec2 x) { return dot(x - corner, inward); };
}

}  // namespace

std::vector<Parameter<RectangleMesh>> RectangleMesh::parameters() {
  const Choice<RectangleMesh> cuts{{"right", "left", "alternating", "crossed"},
                                   [](RectangleMesh& m, int word) { m.diagonals = static_cast<Diagonals>(word); },
                                   [](const RectangleMesh& m) { return static_cast<int>(m.diagonals); }};
  std::vector<Parameter<RectangleMesh>> all{
      {"size", &RectangleMesh::size, dimension::length, limits::positive, "width and height"},
      {"at", &RectangleMesh::at, dimension::length, {}, "lower left corner", false},
      {"turn", &RectangleMesh::turn, dimension::angle, {-1e4, 1e4}, "turn about `at`, counter-clockwise", false},
      {"element_size", &RectangleMesh::element_size, dimension::length, limits::positive, "side of a square cell"},
      {"diagonals", cuts, dimension::number, {}, "how the cells are cut into triangles", false}};
  add_grading_parameters(all);
  return all;
}

double RectangleMesh::distance_outside(Vec2 point) const {
  const Turn q = turn_by(turn);
  const Vec2 from = Turn{q.cos, -q.sin} * (point - at);
  return std::max({-from.x, from.x - size.x, -from.y, from.y - size.y});
}

Mesh RectangleMesh::generate() const {
  check_placement(at, turn);
  check_grading(*this);
  if (finest_size) {
    Mesh mesh = ungraded(*this).generate();
    longest_side_as_base(mesh);
    return refine(std::move(mesh), grading_of(*this), element_size, distance_to_finest(*this));
  }
  const Grid grid{cells_along(size.x, element_size, "width"), cells_along(size.y, element_size, "height"),
                  diagonals == Diagonals::crossed};
  check_triangle_count(1.0 * grid.nx * grid.ny * (grid.centres ? 4 : 2));
  Mesh mesh{.nodes = place_nodes(*this, grid), .triangles = cut_cells(diagonals, grid), .sides = name_sides(grid)};
  number_as_generated(mesh);
  return mesh;
}

}  // namespace udar

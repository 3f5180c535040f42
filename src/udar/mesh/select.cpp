#include "udar/mesh/select.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "udar/base/box.hpp"
#include "udar/base/error.hpp"
#include "udar/base/text.hpp"
#include "udar/mesh/boundary.hpp"
#include "udar/mesh/neighbours.hpp"

namespace udar {
namespace {

template <class Test>
std::vector<Index> nodes_where(const Mesh& mesh, const Test& test) {
  std::vector<Index> found;
  for (Index i = 0; i < mesh.nodes.size(); ++i) {
    if (test(mesh.nodes[i])) found.push_back(i);
  }
  return found;
}

template <class Test>
std::vector<Edge> edges_where(const Mesh& mesh, const Test& test) {
  std::vector<Edge> found;
  for (const Edge edge : boundary_edges(mesh)) {
    if (test(mesh.nodes[edge.a]) && test(mesh.nodes[edge.b])) found.push_back(edge);
  }
  return found;
}

/// What rounding may do to a coordinate (m): a billionth of the body.
double rounding(const Mesh& mesh) {
  const Box box = bounding_box(mesh.nodes);
  return 1e-9 * std::max(box.size().x, box.size().y);
}

auto in_box(const Mesh& mesh, Vec2 a, Vec2 b) {
  const Box box = bounding_box(std::array{a, b}).grown(rounding(mesh));
  return [box](Vec2 p) { return box.holds(p); };
}

double distance_to_segment(Vec2 p, Vec2 a, Vec2 b) {
  const double square = dot(b - a, b - a);
  const double s = square > 0 ? std::clamp(dot(p - a, b - a) / square, 0.0, 1.0) : 0.0;
  return length(p - (a + s * (b - a)));
}

auto near_line(Vec2 a, Vec2 b, double tolerance) {
  return [=](Vec2 p) { return distance_to_segment(p, a, b) <= tolerance; };
}

bool in_polygon(Vec2 p, const std::vector<Vec2>& polygon, double tolerance) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i];
    const Vec2 b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    if (distance_to_segment(p, a, b) <= tolerance) return true;
    // Half-open in y, so that a ray through a corner counts it once.
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

/// Smaller x, then smaller y, where x counts as equal within `tolerance`.
bool comes_first(Vec2 a, Vec2 b, double tolerance) { return std::fabs(a.x - b.x) > tolerance ? a.x < b.x : a.y < b.y; }

}  // namespace

std::vector<Index> nodes_in_box(const Mesh& mesh, Vec2 a, Vec2 b) { return nodes_where(mesh, in_box(mesh, a, b)); }

std::vector<Edge> edges_in_box(const Mesh& mesh, Vec2 a, Vec2 b) { return edges_where(mesh, in_box(mesh, a, b)); }

std::vector<Index> nodes_near_line(const Mesh& mesh, Vec2 a, Vec2 b, double tolerance) {
  return nodes_where(mesh, near_line(a, b, tolerance));
}

std::vector<Edge> edges_near_line(const Mesh& mesh, Vec2 a, Vec2 b, double tolerance) {
  return edges_where(mesh, near_line(a, b, tolerance));
}

const std::vector<Edge>& edges_of_side(const Mesh& mesh, std::string_view name) {
  std::vector<std::string> names;
  for (const NamedEdges& side : mesh.sides) {
    if (side.name == name) return side.edges;
    names.push_back(side.name);
  }
  const std::string likely = nearest_word(name, names);
  const std::string cure = names.empty()    ? "this mesh has no named side; choose by box or line"
                           : likely.empty() ? fmt::format("its sides are {}", one_of(names))
                                            : fmt::format("did you mean `{}`?", likely);
  throw UserError(ExitCode::bad_case, fmt::format("the mesh has no side `{}`", name), cure);
}

std::vector<Index> nodes_of_side(const Mesh& mesh, std::string_view name) {
  std::vector<Index> nodes;
  for (const Edge edge : edges_of_side(mesh, name)) nodes.insert(nodes.end(), {edge.a, edge.b});
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::vector<Index> nodes_in_polygon(const Mesh& mesh, const std::vector<Vec2>& polygon) {
  const double tolerance = rounding(mesh);
  return nodes_where(mesh, [&](Vec2 p) { return in_polygon(p, polygon, tolerance); });
}

Index nearest_node(const Mesh& mesh, Vec2 point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vec2 node : mesh.nodes) nearest = std::min(nearest, length(node - point));
  const double tolerance = rounding(mesh);
  std::optional<Index> best;
  for (Index i = 0; i < mesh.nodes.size(); ++i) {
    if (length(mesh.nodes[i] - point) > nearest + tolerance) continue;
    if (!best || comes_first(mesh.nodes[i], mesh.nodes[*best], tolerance)) best = i;
  }
  return best.value_or(0);
}

Index element_at(const Mesh& mesh, Vec2 point) {
  const double tolerance = rounding(mesh);
  std::optional<Index> best;
  Vec2 best_centroid;
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    const std::array corners{mesh.nodes[mesh.triangles[t][0]], mesh.nodes[mesh.triangles[t][1]],
                             mesh.nodes[mesh.triangles[t][2]]};
    const auto outside = [&](int k) {
      const Vec2 side = corners[next_corner(k)] - corners[k];
      return cross(side, point - corners[k]) < -tolerance * length(side);
    };
    if (outside(0) || outside(1) || outside(2)) continue;
    const Vec2 centroid = (1.0 / 3) * (corners[0] + corners[1] + corners[2]);
    if (best && !comes_first(centroid, best_centroid, tolerance)) continue;
    best = t;
    best_centroid = centroid;
  }
  if (best) return *best;
  const Vec2 node = mesh.nodes[nearest_node(mesh, point)];
  throw UserError(ExitCode::bad_case, fmt::format("no element contains the point ({:.6g}, {:.6g}) m", point.x, point.y),
                  fmt::format("the nearest node of the body is at ({:.6g}, {:.6g}) m", node.x, node.y));
}

double shortest_side(const Mesh& mesh) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      shortest = std::min(shortest, length(mesh.nodes[triangle[next_corner(k)]] - mesh.nodes[triangle[k]]));
    }
  }
  return shortest;
}

}  // namespace udar

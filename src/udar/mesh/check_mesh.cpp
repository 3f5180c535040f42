#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"
#include "udar/mesh/boundary.hpp"
#include "udar/mesh/neighbours.hpp"

namespace udar {
namespace {

/// One kind of mistake: told with its first place and how often it was made, since a broken mesh breaks everywhere.
struct Finding {
  std::string first;
  std::string cure;
  std::size_t count = 0;

  void add(const std::string& text) {
    if (count++ == 0) first = text;
  }
};

void throw_if_any(const std::vector<Finding>& findings) {
  std::vector<Diagnostic> all;
  for (const Finding& f : findings) {
    if (f.count == 0) continue;
    const std::string more = f.count > 1 ? fmt::format(" (and {} more)", f.count - 1) : "";
    all.push_back({.message = f.first + more, .cure = f.cure});
  }
  if (!all.empty()) throw UserError(ExitCode::bad_mesh, all);
}

std::string at(Vec2 p) { return fmt::format("({:.6g}, {:.6g}) m", p.x, p.y); }

Index number(const std::vector<Index>& numbers, std::size_t i) {
  return i < numbers.size() ? numbers[i] : static_cast<Index>(i);
}

std::string name(const Mesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  const Vec2 middle = (1.0 / 3) * (mesh.nodes[a] + mesh.nodes[b] + mesh.nodes[c]);
  return fmt::format("triangle {} at {}", number(mesh.triangle_numbers, t), at(middle));
}

void check_data(const Mesh& mesh) {
  if (mesh.triangles.empty()) throw UserError(ExitCode::bad_mesh, "the mesh has no triangle");
  Finding not_finite;
  Finding no_such_node{.cure = fmt::format("the mesh has {} nodes", mesh.nodes.size())};
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (std::isfinite(mesh.nodes[i].x) && std::isfinite(mesh.nodes[i].y)) continue;
    not_finite.add(fmt::format("a coordinate of node {} is not a finite number", number(mesh.node_numbers, i)));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const Index node : mesh.triangles[t]) {
      if (node < mesh.nodes.size()) continue;
      no_such_node.add(fmt::format("triangle {} has a corner at node {}, which is not there",
                                   number(mesh.triangle_numbers, t), node));
    }
  }
  throw_if_any({not_finite, no_such_node});
}

void check_areas(const Mesh& mesh, Finding& clockwise, Finding& flat) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec2 a = mesh.nodes[mesh.triangles[t][0]];
    const Vec2 b = mesh.nodes[mesh.triangles[t][1]];
    const Vec2 c = mesh.nodes[mesh.triangles[t][2]];
    const double area = twice_area(a, b, c);
    const double square = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
    if (std::fabs(area) <= 1e-12 * square) {
      flat.add(name(mesh, t) + " has no area");
    } else if (area < 0) {
      clockwise.add(name(mesh, t) + " runs clockwise");
    }
  }
}

void check_edges(const Mesh& mesh, const NodeCorners& map, Finding& unused, Finding& overlap) {
  std::vector<Index> ends;  // of the sides that begin at a node
  for (Index i = 0; i < mesh.nodes.size(); ++i) {
    const auto corners = map.of(i);
    if (corners.empty()) {
      unused.add(fmt::format("node {} at {} belongs to no triangle", number(mesh.node_numbers, i), at(mesh.nodes[i])));
    }
    ends.clear();
    for (const std::uint32_t c : corners) ends.push_back(mesh.triangles[c / 3][next_corner(static_cast<int>(c % 3))]);
    for (std::size_t k = 0; k < ends.size(); ++k) {
      for (std::size_t l = k + 1; l < ends.size(); ++l) {
        if (ends[k] != ends[l]) continue;
        overlap.add(fmt::format("{} and {} lie on the same side of their common edge", name(mesh, corners[k] / 3),
                                name(mesh, corners[l] / 3)));
      }
    }
  }
}

}  // namespace

NodeCorners check_mesh(const Mesh& mesh) {
  check_data(mesh);
  NodeCorners map = node_corners(mesh.nodes.size(), mesh.triangles);
  Finding clockwise{.cure = "give its corners counter-clockwise"};
  Finding flat{.cure = "remove it, or move its corners apart"};
  Finding unused{.cure = "a node needs a triangle to have a mass; remove it"};
  Finding overlap{.cure = "an edge has one triangle on each side at most; remove triangles that overlap"};
  check_areas(mesh, clockwise, flat);
  check_edges(mesh, map, unused, overlap);
  throw_if_any({clockwise, flat, unused, overlap});
  return map;
}

}  // namespace udar

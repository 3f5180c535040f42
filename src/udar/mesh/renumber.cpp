#include "udar/mesh/renumber.hpp"

#include <algorithm>
#include <compare>
#include <cstdint>

#include "udar/base/box.hpp"
#include "udar/mesh/neighbours.hpp"

namespace udar {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

/// Distance along the Hilbert curve through a grid of 2^31 by 2^31 cells (Warren, Hacker's Delight, 16-1).
std::uint64_t hilbert_distance(std::uint32_t x, std::uint32_t y) {
  std::uint64_t distance = 0;
  for (std::uint32_t half = 1U << 30; half > 0; half >>= 1) {
    const bool right = (x & half) != 0;
    const bool up = (y & half) != 0;
    distance = 4 * distance + (right ? (up ? 2 : 3) : (up ? 1 : 0));
    if (up) continue;
    if (right) {  // the last quarter is mirrored
      x = ~x;
      y = ~y;
    }
    std::swap(x, y);
  }
  return distance;
}

/// Maps points of a box to the curve; the box keeps its proportions.
struct Curve {
  Vec2 origin;
  double scale;  ///< cells of the curve per metre

  explicit Curve(const Box& box) : origin(box.low), scale(2147483647.0 / std::max(box.size().x, box.size().y)) {}
  [[nodiscard]] std::uint64_t operator()(Vec2 p) const {
    return hilbert_distance(static_cast<std::uint32_t>((p.x - origin.x) * scale),
                            static_cast<std::uint32_t>((p.y - origin.y) * scale));
  }
};

double squared_side(const Mesh& mesh, std::size_t t, int k) {
  const Vec2 side = mesh.nodes[mesh.triangles[t][next_corner(k)]] - mesh.nodes[mesh.triangles[t][k]];
  return dot(side, side);
}

/// The other half of each triangle's cell, or itself. First those that are each other's neighbour across the longest
/// side; then what is left takes the free neighbour across the longest side it can.
std::vector<Index> pair_triangles(const Mesh& mesh) {
  const auto across = neighbours(mesh.triangles, node_corners(mesh.nodes.size(), mesh.triangles));
  const auto count = static_cast<Index>(mesh.triangles.size());
  std::vector<Index> across_longest(count, none);
  for (Index t = 0; t < count; ++t) {
    int longest = 0;
    for (int k = 1; k < 3; ++k) {
      if (squared_side(mesh, t, k) > squared_side(mesh, t, longest)) longest = k;
    }
    across_longest[t] = across[t][longest];
  }
  std::vector<Index> partner(count, none);
  for (Index t = 0; t < count; ++t) {
    if (across_longest[t] != none && across_longest[across_longest[t]] == t) partner[t] = across_longest[t];
  }
  for (Index t = 0; t < count; ++t) {
    if (partner[t] != none) continue;
    Index best = t;
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      const Index other = across[t][k];
      if (other == none || partner[other] != none || squared_side(mesh, t, k) <= longest) continue;
      best = other;
      longest = squared_side(mesh, t, k);
    }
    partner[t] = best;
    partner[best] = t;
  }
  return partner;
}

Vec2 centroid(const Mesh& mesh, Index t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return (1.0 / 3) * (mesh.nodes[a] + mesh.nodes[b] + mesh.nodes[c]);
}

std::vector<Index> triangle_order(const Mesh& mesh) {
  struct Key {
    std::uint64_t distance;  ///< of the pair's centre along the curve
    Index leader;            ///< the pair's lower number; ends ties
    Index triangle;
    auto operator<=>(const Key&) const = default;
  };
  const std::vector<Index> partner = pair_triangles(mesh);
  const Curve curve(bounding_box(mesh.nodes));
  std::vector<Key> keys;
  keys.reserve(mesh.triangles.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    const auto [low, high] = std::minmax(t, partner[t]);
    keys.push_back({curve(0.5 * (centroid(mesh, low) + centroid(mesh, high))), low, t});
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Index> order;
  order.reserve(keys.size());
  for (const Key& key : keys) order.push_back(key.triangle);
  return order;
}

}  // namespace

Mesh renumber(const Mesh& mesh) {
  Mesh out;
  std::vector<Index> new_node(mesh.nodes.size(), none);
  const auto move_node = [&](Index old) {
    if (new_node[old] == none) {
      new_node[old] = static_cast<Index>(out.nodes.size());
      out.nodes.push_back(mesh.nodes[old]);
      out.node_numbers.push_back(mesh.node_numbers[old]);
    }
    return new_node[old];
  };
  for (const Index t : triangle_order(mesh)) {
    const auto& [a, b, c] = mesh.triangles[t];
    out.triangles.push_back({move_node(a), move_node(b), move_node(c)});
    out.triangle_numbers.push_back(mesh.triangle_numbers[t]);
  }
  for (const NamedEdges& side : mesh.sides) {
    out.sides.push_back({side.name, {}});
    for (const Edge e : side.edges) out.sides.back().edges.push_back({new_node[e.a], new_node[e.b]});
  }
  return out;
}

}  // namespace udar

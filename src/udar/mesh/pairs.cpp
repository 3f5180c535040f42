#include "udar/mesh/pairs.hpp"

#include <algorithm>
#include <cstdint>

#include "udar/mesh/neighbours.hpp"

namespace udar {
namespace {

using Across = std::span<const std::array<Index, 3>>;

/// Sides of a triangle from the longest to the shortest.
std::array<int, 3> longest_first(const Mesh& mesh, Index t) {
  std::array<double, 3> square{};
  for (int k = 0; k < 3; ++k) {
    const Vec2 side = mesh.nodes[mesh.triangles[t][next_corner(k)]] - mesh.nodes[mesh.triangles[t][k]];
    square[k] = dot(side, side);
  }
  std::array<int, 3> sides{0, 1, 2};
  if (square[sides[1]] > square[sides[0]]) std::swap(sides[0], sides[1]);
  if (square[sides[2]] > square[sides[1]]) std::swap(sides[1], sides[2]);
  if (square[sides[1]] > square[sides[0]]) std::swap(sides[0], sides[1]);
  return sides;
}

/// Pairs those that are each other's neighbour across the longest side.
std::vector<Index> pair_across_longest(const Mesh& mesh, Across across) {
  const auto count = static_cast<Index>(across.size());
  std::vector<Index> wanted(count);
  for (Index t = 0; t < count; ++t) wanted[t] = across[t][longest_first(mesh, t)[0]];
  std::vector<Index> partner(count);
  for (Index t = 0; t < count; ++t) partner[t] = wanted[t] != none && wanted[wanted[t]] == t ? wanted[t] : t;
  return partner;
}

/// Single triangles from left to right.
std::vector<Index> singles(const Mesh& mesh, const std::vector<Index>& partner) {
  struct Place {
    Vec2 sum;  ///< m, of the corners
    Index triangle;
  };
  std::vector<Place> found;
  for (Index t = 0; t < partner.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (partner[t] == t) found.push_back({mesh.nodes[a] + mesh.nodes[b] + mesh.nodes[c], t});
  }
  std::sort(found.begin(), found.end(), [](const Place& p, const Place& q) {
    if (p.sum.x != q.sum.x) return p.sum.x < q.sum.x;
    return p.sum.y != q.sum.y ? p.sum.y < q.sum.y : p.triangle < q.triangle;
  });
  std::vector<Index> order;
  order.reserve(found.size());
  for (const Place& p : found) order.push_back(p.triangle);
  return order;
}

/// Breadth-first search for a path from one single triangle to another on which every second step is a pair. Taking
/// the other steps as pairs makes one pair more.
struct PathSearch {
  /// A triangle that would lose its partner if the path went on from it.
  struct Step {
    Index triangle;
    std::uint32_t from;  ///< place in `steps` of the one whose neighbour its partner is
  };
  /// Bounds the work where a path would have to cross the whole mesh, as on discs, whose sectors meet out of step.
  static constexpr std::size_t most_steps = 1600;

  const Mesh& mesh;
  Across across;
  std::vector<Index>& partner;
  std::vector<Index> seen_from;  ///< the last single triangle whose search came here
  std::vector<Step> steps;

  /// Pairs `steps[at]` with the single triangle `end`, and so on back along the path.
  void pair_along(std::uint32_t at, Index end) {
    while (true) {
      const Step step = steps[at];
      const Index left = partner[step.triangle];
      partner[step.triangle] = end;
      partner[end] = step.triangle;
      if (at == 0) return;
      end = left;
      at = step.from;
    }
  }

  void run(Index single) {
    steps.assign(1, {single, 0});
    seen_from[single] = single;
    for (std::uint32_t at = 0; at < steps.size() && steps.size() < most_steps; ++at) {
      const Index t = steps[at].triangle;
      for (const int side : longest_first(mesh, t)) {
        const Index next = across[t][side];
        if (next == none || seen_from[next] == single) continue;
        if (partner[next] == next) return pair_along(at, next);
        seen_from[next] = seen_from[partner[next]] = single;
        steps.push_back({partner[next], at});
      }
    }
  }
};

}  // namespace

std::vector<Index> pair_triangles(const Mesh& mesh, Across across) {
  std::vector<Index> partner = pair_across_longest(mesh, across);
  PathSearch paths{mesh, across, partner, std::vector<Index>(partner.size(), none), {}};
  for (const Index t : singles(mesh, partner)) {
    if (partner[t] == t) paths.run(t);
  }
  return partner;
}

}  // namespace udar

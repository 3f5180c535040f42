#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include "udar/mesh/cells.hpp"
#include "udar/mesh/grading.hpp"

namespace udar {
namespace {

/// A triangle on its way. It is split from corner 0 to the base, the side opposite.
struct Piece {
  std::array<Index, 3> corners;
  int level = 0;  ///< how often its area has been halved
};

constexpr Index none = 0xffffffff;

/// All sides of all pieces, each once, and the node in the middle of those that are to be split.
class Sides {
 public:
  explicit Sides(const std::vector<Piece>& pieces) {
    keys_.reserve(3 * pieces.size());
    for (const Piece& p : pieces) {
      for (int k = 0; k < 3; ++k) keys_.push_back(key(p.corners[k], p.corners[(k + 1) % 3]));
    }
    std::ranges::sort(keys_);
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    split_.resize(keys_.size());
    middles_.resize(keys_.size(), none);
  }

  [[nodiscard]] std::size_t find(Index a, Index b) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(keys_, key(a, b)) - keys_.begin());
  }
  /// Of a piece: the side opposite corner k.
  [[nodiscard]] std::array<std::size_t, 3> of(const Piece& p) const {
    const auto& [a, b, c] = p.corners;
    return {find(b, c), find(c, a), find(a, b)};
  }
  [[nodiscard]] bool is_split(std::size_t side) const { return split_[side]; }
  void split(std::size_t side) { split_[side] = true; }
  /// Gives every split side its node.
  void place_middles(std::vector<Vec2>& nodes) {
    for (std::size_t s = 0; s < keys_.size(); ++s) {
      if (!split_[s]) continue;
      middles_[s] = static_cast<Index>(nodes.size());
      nodes.push_back(0.5 * (nodes[keys_[s] >> 32] + nodes[keys_[s] & 0xffffffff]));
    }
  }
  [[nodiscard]] Index middle(std::size_t side) const { return middles_[side]; }

 private:
  static std::uint64_t key(Index a, Index b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }
  std::vector<std::uint64_t> keys_;
  std::vector<bool> split_;
  std::vector<Index> middles_;
};

/// What the grading wants of a piece.
class Wanted {
 public:
  Wanted(double coarse, const Grading& grading, const DistanceTo& distance)
      : coarse_(coarse), grading_(grading), distance_(distance) {}

  [[nodiscard]] bool smaller(const Piece& p, const std::vector<Vec2>& nodes) const {
    constexpr double rounding = 1 + 1e-9;
    const double halved = std::ldexp(coarse_, -(p.level / 2));
    const double size = p.level % 2 == 0 ? halved : std::sqrt(0.5) * halved;
    return size > rounding * allowed(nearest(p, nodes));
  }

 private:
  /// Distance of its nearest part, or less.
  [[nodiscard]] double nearest(const Piece& p, const std::vector<Vec2>& nodes) const {
    const auto& [a, b, c] = p.corners;
    const Vec2 middle = (1.0 / 3) * (nodes[a] + nodes[b] + nodes[c]);
    double reach = 0;
    for (const Index corner : p.corners) reach = std::max(reach, length(nodes[corner] - middle));
    return distance_(middle) - reach;
  }
  [[nodiscard]] double allowed(double distance) const {
    return *grading_.size + (grading_.growth - 1) * std::max(0.0, distance - grading_.within);
  }

  double coarse_;
  const Grading& grading_;
  const DistanceTo& distance_;
};

/// Whole pieces that are too large are to be split on all sides, halves on their base. Then, until nothing changes:
/// where a side is split, so is the base. Returns how many pieces there will be, or 0 if no more than now.
double choose_splits(const std::vector<Piece>& pieces, const std::vector<Vec2>& nodes, const Wanted& wanted,
                     Sides& sides) {
  bool any = false;
  for (const Piece& p : pieces) {
    if (!wanted.smaller(p, nodes)) continue;
    any = true;
    const auto [base, left, right] = sides.of(p);
    sides.split(base);
    if (p.level % 2 != 0) continue;
    sides.split(left);
    sides.split(right);
  }
  if (!any) return 0;
  double count = 0;
  for (bool changed = true; changed;) {
    changed = false;
    count = 0;
    for (const Piece& p : pieces) {
      const auto [base, left, right] = sides.of(p);
      const int halved = int(sides.is_split(left)) + int(sides.is_split(right));
      if (halved > 0 && !sides.is_split(base)) {
        sides.split(base);
        changed = true;
      }
      count += 1 + halved + int(sides.is_split(base));
    }
  }
  return count;
}

/// A piece and, where a side of it is split, its parts.
void add_parts(const Piece& p, const Sides& sides, const std::vector<Vec2>& nodes, std::vector<Piece>& parts) {
  const auto [a, b, c] = p.corners;
  const auto [base, left, right] = sides.of(p);  // opposite a, b, c
  if (!sides.is_split(base)) {
    parts.push_back(p);
    return;
  }
  const Index m = sides.middle(base);
  const Index n = sides.middle(right);
  const Index q = sides.middle(left);
  const int half = p.level + 1;
  const int quarter = p.level + 2;
  if (n != none && q != none && length(nodes[n] - nodes[q]) < 0.9 * length(nodes[a] - nodes[m])) {
    parts.insert(parts.end(), {{{a, n, q}, quarter}, {{n, b, m}, quarter}, {{q, m, c}, quarter}, {{m, q, n}, quarter}});
    return;
  }
  if (n == none) {
    parts.push_back({{m, a, b}, half});
  } else {
    parts.insert(parts.end(), {{{n, m, a}, quarter}, {{n, b, m}, quarter}});
  }
  if (q == none) {
    parts.push_back({{m, c, a}, half});
  } else {
    parts.insert(parts.end(), {{{q, m, c}, quarter}, {{q, a, m}, quarter}});
  }
}

void split_named_sides(std::vector<NamedEdges>& named, const Sides& sides, const OntoSide& onto,
                       std::vector<Vec2>& nodes) {
  for (NamedEdges& side : named) {
    std::vector<Edge> edges;
    for (const Edge e : side.edges) {
      const Index m = sides.middle(sides.find(e.a, e.b));
      if (m == none) {
        edges.push_back(e);
        continue;
      }
      if (onto) nodes[m] = onto(side.name, nodes[m]);
      edges.insert(edges.end(), {{e.a, m}, {m, e.b}});
    }
    side.edges = std::move(edges);
  }
}

}  // namespace

void longest_side_as_base(Mesh& mesh) {
  for (auto& [a, b, c] : mesh.triangles) {
    const double ab = length(mesh.nodes[b] - mesh.nodes[a]);
    const double bc = length(mesh.nodes[c] - mesh.nodes[b]);
    const double ca = length(mesh.nodes[a] - mesh.nodes[c]);
    if (bc >= ab && bc >= ca) continue;
    if (ca >= ab) {
      std::tie(a, b, c) = std::tuple(b, c, a);
    } else {
      std::tie(a, b, c) = std::tuple(c, a, b);
    }
  }
}

Mesh refine(Mesh mesh, const Grading& grading, double element_size, const DistanceTo& distance, const OntoSide& onto) {
  const Wanted wanted(coarse_size(grading, element_size), grading, distance);
  std::vector<Piece> pieces;
  pieces.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) pieces.push_back({t});
  for (;;) {
    Sides sides(pieces);
    const double count = choose_splits(pieces, mesh.nodes, wanted, sides);
    if (count == 0) break;
    check_triangle_count(count);
    sides.place_middles(mesh.nodes);
    split_named_sides(mesh.sides, sides, onto, mesh.nodes);
    std::vector<Piece> parts;
    parts.reserve(static_cast<std::size_t>(count));
    for (const Piece& p : pieces) add_parts(p, sides, mesh.nodes, parts);
    pieces = std::move(parts);
  }
  mesh.triangles.clear();
  for (const Piece& p : pieces) mesh.triangles.push_back(p.corners);
  number_as_generated(mesh);
  return mesh;
}

}  // namespace udar

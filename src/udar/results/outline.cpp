#include "udar/results/outline.hpp"

#include <algorithm>

namespace udar {
namespace {

using Edge = std::pair<std::int32_t, std::int32_t>;

/// Where the directed edges of triangles lead from each point, ascending.
struct EdgeEnds {
  std::vector<std::uint32_t> offsets;  ///< those of point i are ends[offsets[i]] to ends[offsets[i + 1] - 1]
  std::vector<std::int32_t> ends;

  explicit EdgeEnds(std::span<const Triangle> triangles) : ends(3 * triangles.size()) {
    std::int32_t largest = -1;
    for (const auto& [a, b, c] : triangles) largest = std::max({largest, a, b, c});
    offsets.resize(static_cast<std::size_t>(largest) + 3);
    // Counted one place further on, so that filling in moves the counts to where they belong.
    for (const Triangle& triangle : triangles) {
      for (const std::int32_t corner : triangle) ++offsets[static_cast<std::size_t>(corner) + 2];
    }
    for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
    for (const auto& [a, b, c] : triangles) {
      for (const auto& [from, to] : {Edge{a, b}, Edge{b, c}, Edge{c, a}}) {
        ends[offsets[static_cast<std::size_t>(from) + 1]++] = to;
      }
    }
    offsets.pop_back();
    for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
      std::sort(ends.begin() + offsets[i], ends.begin() + offsets[i + 1]);
    }
  }
  [[nodiscard]] std::span<const std::int32_t> of(std::int32_t point) const {
    const auto i = static_cast<std::size_t>(point);
    return {ends.data() + offsets[i], ends.data() + offsets[i + 1]};
  }
};

/// Edges without one the other way, sorted: an edge that two triangles share runs both ways, the others bound the
/// union.
std::vector<Edge> single_edges(std::span<const Triangle> triangles) {
  const EdgeEnds all(triangles);
  std::vector<Edge> edges;
  for (std::int32_t from = 0; static_cast<std::size_t>(from) + 1 < all.offsets.size(); ++from) {
    for (const std::int32_t to : all.of(from)) {
      const auto back = all.of(to);
      if (std::find(back.begin(), back.end(), from) == back.end()) edges.emplace_back(from, to);
    }
  }
  return edges;
}

}  // namespace

std::vector<Loop> outline(std::span<const Triangle> triangles) {
  const std::vector<Edge> edges = single_edges(triangles);
  std::vector<bool> used(edges.size());
  const auto unused_from = [&](std::int32_t point) {
    auto at = static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), Edge{point, -1}) - edges.begin());
    while (at < edges.size() && edges[at].first == point && used[at]) ++at;
    return at < edges.size() && edges[at].first == point ? at : edges.size();
  };

  std::vector<Loop> loops;
  for (std::size_t start = 0; start < edges.size(); ++start) {
    if (used[start]) continue;
    Loop loop;
    for (std::size_t at = start; at < edges.size(); at = unused_from(edges[at].second)) {
      used[at] = true;
      loop.push_back(edges[at].first);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

std::vector<Loop> loops_of(std::span<const std::array<std::int32_t, 2>> edges) {
  std::vector<Loop> loops;
  std::int32_t end = -1;
  for (const auto& [from, to] : edges) {
    if (from != end) loops.emplace_back();
    loops.back().push_back(from);
    end = to;
  }
  return loops;
}

std::vector<Edge> mesh_edges(std::span<const Triangle> triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const auto& [a, b, c] : triangles) {
    for (const auto& [from, to] : {Edge{a, b}, Edge{b, c}, Edge{c, a}}) edges.emplace_back(std::minmax(from, to));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

bool Extent::contains(const Extent& other) const {
  return other.low.x >= low.x && other.low.y >= low.y && other.high.x <= high.x && other.high.y <= high.y;
}

bool Extent::overlaps(const Extent& other) const {
  return other.low.x < high.x && other.high.x > low.x && other.low.y < high.y && other.high.y > low.y;
}

Extent Extent::common_with(const Extent& other) const {
  return {{std::max(low.x, other.low.x), std::max(low.y, other.low.y)},
          {std::min(high.x, other.high.x), std::min(high.y, other.high.y)}};
}

void Extent::add(Vec2 point) {
  if (empty()) {
    low = high = point;
    return;
  }
  low = {std::min(low.x, point.x), std::min(low.y, point.y)};
  high = {std::max(high.x, point.x), std::max(high.y, point.y)};
}

void Extent::add(const Extent& other) {
  if (other.empty()) return;
  add(other.low);
  add(other.high);
}

Extent bounds(std::span<const Vec2> points) {
  Extent box;
  for (const Vec2 point : points) {
    if (std::isfinite(point.x) && std::isfinite(point.y)) box.add(point);
  }
  return box;
}

std::vector<Vec2> clipped(std::vector<Vec2> polygon, const Extent& box) {
  struct Side {
    Vec2 inward;
    Vec2 through;
  };
  const std::array<Side, 4> sides{{{{1, 0}, box.low}, {{0, 1}, box.low}, {{-1, 0}, box.high}, {{0, -1}, box.high}}};
  for (const Side& side : sides) {
    std::vector<Vec2> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2 from = polygon[i];
      const Vec2 to = polygon[(i + 1) % polygon.size()];
      const double from_depth = dot(from - side.through, side.inward);
      const double to_depth = dot(to - side.through, side.inward);
      if (from_depth >= 0) kept.push_back(from);
      if ((from_depth >= 0) != (to_depth >= 0))
        kept.push_back(from + from_depth / (from_depth - to_depth) * (to - from));
    }
    polygon = std::move(kept);
  }
  return polygon;
}

}  // namespace udar

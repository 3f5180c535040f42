#include "udar/results/outline.hpp"

#include <algorithm>

namespace udar {
namespace {

using Edge = std::pair<std::int32_t, std::int32_t>;

std::vector<Edge> directed_edges(std::span<const Triangle> triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const auto& [a, b, c] : triangles) edges.insert(edges.end(), {{a, b}, {b, c}, {c, a}});
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace

std::vector<Loop> outline(std::span<const Triangle> triangles) {
  const std::vector<Edge> all = directed_edges(triangles);
  // An edge that two triangles share runs both ways; what is left bounds the union, sorted by first point.
  std::vector<Edge> edges;
  std::copy_if(all.begin(), all.end(), std::back_inserter(edges), [&](const Edge& edge) {
    return !std::binary_search(all.begin(), all.end(), Edge{edge.second, edge.first});
  });

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

std::vector<Edge> mesh_edges(std::span<const Triangle> triangles) {
  std::vector<Edge> edges = directed_edges(triangles);
  for (Edge& edge : edges) {
    if (edge.first > edge.second) std::swap(edge.first, edge.second);
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

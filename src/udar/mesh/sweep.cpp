#include "udar/mesh/sweep.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>

#include "udar/base/box.hpp"
#include "udar/mesh/neighbours.hpp"
#include "udar/mesh/pairs.hpp"

namespace udar {
namespace {

/// Corners of the convex hull, counter-clockwise (Andrew, Inf. Process. Lett. 9, 1979), without those that rounding
/// makes on straight sides.
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  const Vec2 size = bounding_box(points).size();
  const double rounding = 1e-12 * dot(size, size);
  std::sort(points.begin(), points.end(), [](Vec2 p, Vec2 q) { return p.x != q.x ? p.x < q.x : p.y < q.y; });
  std::vector<Vec2> hull;
  const auto add = [&](Vec2 p, std::size_t kept) {
    while (hull.size() > kept && twice_area(hull[hull.size() - 2], hull.back(), p) <= rounding) hull.pop_back();
    hull.push_back(p);
  };
  for (const Vec2 p : points) add(p, 1);
  const std::size_t lower = hull.size();
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.pop_back();  // the first point again
  return hull;
}

/// Unit vector along the narrowest strip that holds the hull, to the right. One side of the hull lies on the strip's
/// rim (Houle and Toussaint, IEEE Trans. PAMI 10, 1988): each is tried, while the corner opposite moves round.
Vec2 long_direction(const std::vector<Vec2>& hull) {
  const auto next = [&](std::size_t i) { return i + 1 < hull.size() ? i + 1 : 0; };
  Vec2 best;
  double narrowest = std::numeric_limits<double>::infinity();
  std::size_t opposite = 1;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 side = hull[next(i)] - hull[i];
    const Vec2 along = (1 / length(side)) * side;
    const auto width = [&](std::size_t corner) { return cross(along, hull[corner] - hull[i]); };
    if (opposite == i) opposite = next(i);
    while (width(next(opposite)) > width(opposite)) opposite = next(opposite);
    if (width(opposite) >= narrowest) continue;
    narrowest = width(opposite);
    best = along;
  }
  return best.x < 0 || (best.x == 0 && best.y < 0) ? -best : best;
}

/// A boundary node seen along the sweep.
struct Place {
  double ahead;  ///< m
  double aside;  ///< m, to the left
  Index node;
};

/// From the back, or from the right.
bool behind(const Place& p, const Place& q) {
  if (p.ahead != q.ahead) return p.ahead < q.ahead;
  return p.aside != q.aside ? p.aside < q.aside : p.node < q.node;
}
bool to_the_right(const Place& p, const Place& q) { return p.aside != q.aside ? p.aside < q.aside : p.node < q.node; }

/// Where the sweep starts: the nodes of the body's end from right to left, then all other boundary nodes from the back,
/// for bodies in several pieces. The end is what lies within half a boundary edge of the last node.
struct Starts {
  std::vector<Place> places;
  std::size_t at_end = 0;  ///< so many of them lie on the end
};

Starts find_starts(const Mesh& mesh, const std::vector<Edge>& edges) {
  std::vector<Vec2> points;
  double edge_length = 0;
  for (const Edge e : edges) {
    points.push_back(mesh.nodes[e.a]);
    edge_length += length(mesh.nodes[e.b] - mesh.nodes[e.a]) / static_cast<double>(edges.size());
  }
  const Vec2 along = long_direction(convex_hull(points));
  Starts starts;
  for (const Edge e : edges) {
    starts.places.push_back({dot(along, mesh.nodes[e.a]), cross(along, mesh.nodes[e.a]), e.a});
  }
  auto& places = starts.places;
  std::sort(places.begin(), places.end(), behind);
  const double limit = places.front().ahead + 0.5 * edge_length;
  while (starts.at_end < places.size() && places[starts.at_end].ahead <= limit) ++starts.at_end;
  std::sort(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(starts.at_end), to_the_right);
  return starts;
}

/// A sweep under way.
struct Front {
  const Mesh& mesh;
  NodeCorners map;
  std::vector<std::array<Index, 3>> across;
  std::vector<Index> partner;
  std::vector<Index> order;   ///< triangles taken
  std::vector<Index> queue;   ///< nodes reached
  std::size_t head = 0;       ///< so many of them have taken what is round them
  std::vector<bool> taken;    ///< for each triangle
  std::vector<bool> reached;  ///< for each node

  Front(const Mesh& swept, NodeCorners corners)
      : mesh(swept),
        map(std::move(corners)),
        across(neighbours(mesh.triangles, map)),
        partner(pair_triangles(mesh, across)),
        taken(mesh.triangles.size()),
        reached(mesh.nodes.size()) {
    order.reserve(mesh.triangles.size());
    queue.reserve(mesh.nodes.size());
  }

  void reach(Index node) {
    if (reached[node]) return;
    reached[node] = true;
    queue.push_back(node);
  }

  void take(Index t) {
    taken[t] = true;
    order.push_back(t);
    for (const Index node : mesh.triangles[t]) reach(node);
  }

  /// Takes what is left of the triangles round a node, counter-clockwise from `first`, with their partners.
  void take_fan(std::uint32_t first) {
    const Index node = mesh.triangles[first / 3][first % 3];
    std::uint32_t corner = first;
    do {
      const Index t = corner / 3;
      if (!taken[t]) {
        take(t);
        if (partner[t] != t) take(partner[t]);
      }
      const Index next = across[t][next_corner(next_corner(static_cast<int>(corner % 3)))];
      if (next == none) return;
      const auto& corners = mesh.triangles[next];
      corner = 3 * next + (corners[0] == node ? 0 : corners[1] == node ? 1 : 2);
    } while (corner != first);
  }

  /// Lets every node that was reached take what is left round it. That begins where the triangle before, clockwise,
  /// was taken or is not there, so that the front moves on without turning back.
  void run() {
    for (; head < queue.size(); ++head) {
      for (const std::uint32_t corner : map.of(queue[head])) {
        if (taken[corner / 3]) continue;
        const Index before = across[corner / 3][corner % 3];
        if (before == none || taken[before]) take_fan(corner);
      }
    }
  }
};

}  // namespace

Sweep sweep_through(const Mesh& mesh, NodeCorners corners) {
  Front front(mesh, std::move(corners));
  std::vector<Edge> boundary = outer_sides(mesh.triangles, front.across);
  const Starts starts = find_starts(mesh, boundary);
  for (std::size_t i = 0; i < starts.at_end; ++i) front.reach(starts.places[i].node);
  for (const Place& place : starts.places) {
    front.run();
    front.reach(place.node);  // of the next piece, if it was not reached
  }
  front.run();
  assert(front.order.size() == mesh.triangles.size());
  return {std::move(front.order), std::move(boundary)};
}

}  // namespace udar

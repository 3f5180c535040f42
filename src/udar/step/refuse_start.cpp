#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "udar/base/box.hpp"
#include "udar/base/error.hpp"
#include "udar/contact/search.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

Vec2 rest_place(const Model& model, std::uint32_t point) { return model.rest[model.contact_nodes[point]]; }

std::string text(Vec2 place) { return fmt::format("({:.5g}, {:.5g}) m", place.x, place.y); }

const std::string& name_at(const Model& model, std::uint32_t point) {
  return model.bodies[model.contact_bodies[point]].name;
}

/// How deep a point lies in a body at t = 0.
struct Depth {
  double depth = 0;  ///< m; 0 outside
  double size = 0;   ///< m, of the boundary edges there
};

Depth depth_in(const Model& model, Vec2 p, std::size_t body) {
  const auto place = [&](std::uint32_t point) { return rest_place(model, point); };
  bool inside = false;  // by how often a ray to the right crosses the boundary
  Depth nearest{std::numeric_limits<double>::infinity(), 0};
  for (std::uint32_t s = 0; s < model.segments.size(); ++s) {
    if (model.segments[s].body != body) continue;
    const Vec2 a = place(model.segments[s].a);
    const Vec2 b = place(model.segments[s].b);
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    const double distance = std::fabs(foot_on(model.segments, s, p, place).distance);
    if (distance < nearest.depth) nearest = {distance, model.contact_node_sizes[model.segments[s].a]};
  }
  return inside ? nearest : Depth{};
}

std::vector<Box> boxes_of_bodies(const Model& model) {
  std::vector<Box> boxes(model.bodies.size());
  for (std::uint32_t c = 0; c < model.contact_nodes.size(); ++c) {
    boxes[model.contact_bodies[c]].include(rest_place(model, c));
  }
  return boxes;
}

}  // namespace

void refuse_overlapping_bodies(const Model& model) {
  const std::vector<Box> boxes = boxes_of_bodies(model);
  for (std::uint32_t c = 0; c < model.contact_nodes.size(); ++c) {
    const Vec2 place = rest_place(model, c);
    for (std::uint32_t other = 0; other < model.bodies.size(); ++other) {
      if (!boxes[other].holds(place)) continue;
      if (other == model.contact_bodies[c] || !model.body_pair(c, other).touch) continue;
      if (model.is_tied(c, other)) continue;  // its springs rest where it is
      const double depth = depth_in(model, place, other).depth;
      if (depth <= deepest_start * model.contact_node_sizes[c]) continue;
      throw UserError(
          ExitCode::bad_case,
          fmt::format("bodies `{}` and `{}` overlap: a node of the first at {} is {:.4g} m deep in the second",
                      name_at(model, c), model.bodies[other].name, text(place), depth),
          "move one of them (`at` of its mesh), or let them pass through each other: [[contact.pairs]] with touch = "
          "\"no\"");
    }
  }
}

void refuse_closed_gaps(const Model& model) {
  if (model.segments.empty()) return;
  std::vector<Vec2> points;
  for (std::uint32_t c = 0; c < model.contact_nodes.size(); ++c) points.push_back(rest_place(model, c));
  std::vector<SegmentEnds> segments;
  for (const Segment& s : model.segments) segments.push_back({points[s.a], points[s.b]});
  constexpr double rounding = 1e-6;  // of the smallest stretch of boundary, which is twice the margin
  const Neighbours near = find_near(points, segments, rounding * model.contact_margin);
  for (std::uint32_t c = 0; c < points.size(); ++c) {
    for (std::uint32_t k = near.begin[c]; k < near.begin[c + 1]; ++k) {
      const Segment& s = model.segments[near.near[k]];
      if (s.body != model.contact_bodies[c] || s.a == c || s.b == c || !model.body_pair(c, s.body).touch) continue;
      throw UserError(
          ExitCode::bad_case,
          fmt::format("body `{}` touches itself at {}: its boundary lies on itself there, a gap of no width",
                      name_at(model, c), text(points[c])),
          "open the gap, or join its two sides; or let the body pass through itself: [[contact.pairs]] with "
          "touch = \"no\"");
    }
  }
}

void refuse_buried_corners(const Model& model) {
  const std::vector<Box> boxes = boxes_of_bodies(model);
  for (const ObstacleCorner& corner : model.obstacle_corners) {
    for (std::size_t body = 0; body < model.bodies.size(); ++body) {
      if (!boxes[body].holds(corner.place)) continue;
      const Depth found = depth_in(model, corner.place, body);
      if (found.depth <= deepest_start * found.size) continue;
      throw UserError(
          ExitCode::bad_case,
          fmt::format("obstacle `{}` starts inside body `{}`: its corner at {} is {:.4g} m deep",
                      model.obstacles[corner.obstacle].name, model.bodies[body].name, text(corner.place), found.depth),
          "move the body (`at` of its mesh) or the obstacle; or let the obstacle push nodes only: corners = "
          "false");
    }
  }
}

void refuse_buried_nodes(const Model& model, const State& state) {
  const std::size_t count = model.contact_nodes.size();
  std::size_t worst = 0;
  double ratio = 0;
  for (std::size_t k = 0; k < state.contacts.size(); ++k) {
    const double here = state.contacts[k].penetration / model.contact_node_sizes[k % count];
    if (here <= ratio) continue;
    ratio = here;
    worst = k;
  }
  if (ratio <= deepest_start) return;
  const Index node = model.contact_nodes[worst % count];
  const Vec2 place = model.rest[node];
  throw UserError(ExitCode::bad_case,
                  fmt::format("body `{}` starts inside obstacle `{}`: its node at {} is {:.4g} m deep",
                              model.body_of_node(node).name, model.obstacles[worst / count].name, text(place),
                              state.contacts[worst].penetration),
                  "move the body (`at` of its mesh) or the obstacle, so that they touch at most");
}

}  // namespace udar

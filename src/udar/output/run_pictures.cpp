#include "udar/output/run_pictures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "udar/base/text.hpp"
#include "udar/output/frame_writer.hpp"
#include "udar/output/observer.hpp"

namespace udar {
namespace {

Picture bodies_and_obstacles(const Model& model, const State& state, const std::string& title) {
  Picture picture;
  picture.title = title;
  picture.points.reserve(model.node_count);
  picture.triangles.reserve(model.element_count);
  const auto number = [](Index i) { return static_cast<std::int32_t>(i); };
  for (Index i = 0; i < model.node_count; ++i) picture.points.push_back({state.nodes[i].x, state.nodes[i].y});
  for (const Body& body : model.bodies) {
    for (Index e = body.element_begin; e < body.element_end; ++e) {
      const auto& [a, b, c] = model.corners[e];
      picture.triangles.push_back({number(a), number(b), number(c)});
    }
    for (const Edge& edge : body.boundary) picture.boundary.push_back({number(edge.a), number(edge.b)});
  }
  for (ObstacleOutline& outline : named_obstacle_outlines(model, state)) {
    picture.obstacles.push_back(std::move(outline.points));
    picture.obstacle_names.push_back(model.obstacles[outline.obstacle].name);
  }
  return picture;
}

/// All but the largest hundredth are below: a handful of crushed elements would leave everything else in one colour.
double largest_of_nearly_all(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// How a body moves at the start.
struct Motion {
  Vec2 centre{};    // m, of mass
  Vec2 velocity{};  // m/s
  double spin = 0;  // rad/s, that of a rigid body with the same momenta
};

Motion start_motion(const Model& model, const Body& body) {
  Motion motion;
  for (Index i = body.node_begin; i < body.node_end; ++i) {
    motion.centre += (model.mass[i] / body.mass) * model.rest[i];
    motion.velocity += (model.mass[i] / body.mass) * model.start_velocity[i];
  }
  double moment = 0;
  double inertia = 0;
  for (Index i = body.node_begin; i < body.node_end; ++i) {
    const Vec2 arm = model.rest[i] - motion.centre;
    moment += model.mass[i] * cross(arm, model.start_velocity[i] - motion.velocity);
    inertia += model.mass[i] * dot(arm, arm);
  }
  if (inertia > 0) motion.spin = moment / inertia;
  // What is left of cancelled sums is no motion.
  double fastest = 0;
  for (Index i = body.node_begin; i < body.node_end; ++i) {
    fastest = std::max(fastest, length(model.start_velocity[i]));
  }
  if (length(motion.velocity) <= 1e-9 * fastest) motion.velocity = {};
  if (std::fabs(motion.spin) * std::sqrt(inertia / body.mass) <= 1e-9 * fastest) motion.spin = 0;
  return motion;
}

/// Velocities and spins of bodies, velocities of obstacles. Of many bodies the arrows speak for themselves.
void add_motion(const Model& model, Picture& picture) {
  constexpr std::size_t most_labels = 12;
  const bool labelled = model.bodies.size() <= most_labels;
  for (const Body& body : model.bodies) {
    const Motion motion = start_motion(model, body);
    const double v = length(motion.velocity);
    std::string words;  // on the circle where it turns, else on the arrow
    if (v > 0) words = fmt::format(", {:.4g} m/s", v);
    if (motion.spin != 0) words += fmt::format(", {:.4g} rad/s", motion.spin);
    words = labelled && !words.empty() ? body.name + ": " + words.substr(2) : "";
    if (v > 0) picture.arrows.push_back({motion.centre, motion.velocity, motion.spin != 0 ? "" : words});
    if (motion.spin != 0) picture.spins.push_back({motion.centre, motion.spin, words});
  }
  for (std::size_t k = 0; k < picture.obstacles.size(); ++k) {
    for (const Obstacle& obstacle : model.obstacles) {
      if (obstacle.name != picture.obstacle_names[k] || !(length(obstacle.velocity) > 0)) continue;
      picture.arrows.push_back({bounds(picture.obstacles[k]).centre(), obstacle.velocity,
                                fmt::format("{}: {:.4g} m/s", obstacle.name, length(obstacle.velocity))});
      picture.obstacle_names[k].clear();  // the arrow names it
    }
  }
}

Vec2 middle_of(const Model& model, const std::vector<Index>& nodes) {
  Vec2 sum;
  for (const Index i : nodes) sum += model.rest[i];
  return nodes.empty() ? sum : (1 / static_cast<double>(nodes.size())) * sum;
}

/// What of a load is largest, at whatever time.
double largest_factor(const Load& load) {
  double largest = 0;
  for (const double value : load.factor.values) {
    if (std::fabs(value) > std::fabs(largest)) largest = value;
  }
  return largest;
}

PictureLoad picture_of(const Model& model, const Load& load) {
  PictureLoad out;
  const double factor = largest_factor(load);
  const char* const changes = load.factor.values.size() > 1 ? " at most" : "";
  if (!load.edges.empty()) {
    for (const Edge& edge : load.edges) {
      const Vec2 a = model.rest[edge.a];
      const Vec2 b = model.rest[edge.b];
      if (a == b) continue;
      // The body lies on the left of the edge, and a pressure pushes into it.
      out.at.push_back(0.5 * (a + b));
      out.value.push_back(factor * load.pressure / length(b - a) * perpendicular(b - a));
    }
    out.label = fmt::format("{}: {}{}", load.name, in_units(factor * load.pressure, "Pa"), changes);
    return out;
  }
  for (const Index node : load.nodes) {
    out.at.push_back(model.rest[node]);
    out.value.push_back(factor * load.value);
  }
  const bool spread = std::any_of(load.shares.begin(), load.shares.end(), [](double share) { return share != 1; });
  out.label = fmt::format("{}: {}{}{}", load.name, in_units(length(factor * load.value), spread ? "Pa" : "N"),
                          !spread && load.nodes.size() > 1 ? " at each node" : "", changes);
  return out;
}

}  // namespace

Vec2 centroid(const Model& model, const State& state, Index element) {
  Vec2 sum;
  for (const Index c : model.corners[element]) sum += Vec2{state.nodes[c].x, state.nodes[c].y};
  return (1.0 / 3.0) * sum;
}

Picture setup_picture(const Model& model, const State& state, const std::string& title) {
  Picture picture = bodies_and_obstacles(model, state, title);
  picture.subtitle = fmt::format("{} elements, {} nodes", model.element_count, model.node_count);
  picture.dimensions = true;
  picture.gravity = model.run.gravity;
  add_motion(model, picture);
  for (const NodeObserver& node : model.observed_nodes) picture.markers.push_back({model.rest[node.node], node.name});
  for (const ElementObserver& element : model.observed_elements) {
    picture.markers.push_back({centroid(model, state, element.element), element.name});
  }
  for (const RegionObserver& region : model.observed_regions) {
    picture.labels.push_back({middle_of(model, region.nodes), region.name});
  }
  for (const Support& support : model.supports) {
    for (const Index node : support.nodes) {
      picture.supports.push_back({model.rest[node], support.holds_x, support.holds_y});
    }
    if (!support.nodes.empty()) picture.labels.push_back({middle_of(model, support.nodes), support.name});
  }
  for (const Load& load : model.loads) picture.loads.push_back(picture_of(model, load));
  return picture;
}

Picture state_picture(const Model& model, const State& state, const std::string& title) {
  Picture picture = bodies_and_obstacles(model, state, title);
  picture.subtitle = fmt::format("t = {:.4g} ms", 1e3 * state.clock.time.value());
  const bool flowed =
      std::any_of(state.plastic_strain.begin(), state.plastic_strain.end(), [](double p) { return p > 0; });
  PictureField field{.name = flowed ? "plastic strain" : "largest shear stress", .unit = flowed ? "" : "MPa"};
  field.values.reserve(model.element_count);
  for (const Body& body : model.bodies) {
    for (Index e = body.element_begin; e < body.element_end; ++e) {
      const auto p = principal_stresses(state, e);
      const double value = flowed ? state.plastic_strain[e] : 0.5e-6 * (p[0] - p[2]);
      field.values.push_back(body.rigid ? std::numeric_limits<double>::quiet_NaN() : value);
    }
  }
  field.min = 0;
  if (const double most = largest_of_nearly_all(field.values); most > 0) field.max = most;
  picture.field = std::move(field);
  return picture;
}

}  // namespace udar

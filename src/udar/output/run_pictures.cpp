#include "udar/output/run_pictures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
  picture.obstacles = obstacle_outlines(model, state);
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

}  // namespace

Vec2 centroid(const Model& model, const State& state, Index element) {
  Vec2 sum;
  for (const Index c : model.corners[element]) sum += Vec2{state.nodes[c].x, state.nodes[c].y};
  return (1.0 / 3.0) * sum;
}

Picture setup_picture(const Model& model, const State& state, const std::string& title) {
  Picture picture = bodies_and_obstacles(model, state, title);
  picture.subtitle = fmt::format("{} elements, {} nodes", model.element_count, model.node_count);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    Vec2 centre;
    Vec2 momentum;
    for (Index i = body.node_begin; i < body.node_end; ++i) {
      centre += (model.mass[i] / body.mass) * model.rest[i];
      momentum += model.mass[i] * model.start_velocity[i];
    }
    const Vec2 v = (1 / body.mass) * momentum;
    if (length(v) > 0) picture.arrows.push_back({centre, v, fmt::format("{}: {:.4g} m/s", body.name, length(v))});
  }
  for (const NodeObserver& node : model.observed_nodes) picture.markers.push_back({model.rest[node.node], node.name});
  for (const ElementObserver& element : model.observed_elements) {
    picture.markers.push_back({centroid(model, state, element.element), element.name});
  }
  for (const Support& support : model.supports) {
    for (const Index node : support.nodes) {
      picture.supports.push_back({model.rest[node], support.holds_x, support.holds_y});
    }
  }
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

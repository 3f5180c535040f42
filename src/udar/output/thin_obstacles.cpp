#include "udar/output/thin_obstacles.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace udar {
namespace {

/// Of the inner radius: what sinks no deeper is pushed back to where it came from, wherever the obstacle is as thick as
/// at its middle.
constexpr double safe_part = 0.5;

}  // namespace

std::vector<std::string> obstacles_sunk_through(const Model& model, const State& state) {
  std::vector<std::string> out;
  for (std::size_t o = 0; o < model.obstacles.size(); ++o) {
    const Obstacle& obstacle = model.obstacles[o];
    const Sinking& sunk = state.sunk[o];
    if (!(sunk.depth > safe_part * obstacle.inner_radius)) continue;
    const std::string& body = model.body_of_node(static_cast<Index>(sunk.node)).name;
    out.push_back(
        sunk.depth < obstacle.inner_radius
            ? fmt::format("a node of body `{}` sank by {:.3g} m into obstacle `{}`, of which no point is deeper than "
                          "{:.3g} m, at t = {:.4g} s: what sinks beyond the middle comes out at the other side; a "
                          "thicker obstacle or a larger `stiffness` in [obstacles.{}] keeps it back",
                          body, sunk.depth, obstacle.name, obstacle.inner_radius, sunk.time, obstacle.name)
            : fmt::format("a node of body `{}` passed through obstacle `{}` in one step, at t = {:.4g} s; a thicker "
                          "obstacle or a shorter time step keeps it back",
                          body, obstacle.name, sunk.time));
  }
  return out;
}

std::vector<Diagnostic> obstacles_too_thin(const Model& model, const State& state) {
  std::vector<Diagnostic> out;
  for (const Obstacle& obstacle : model.obstacles) {
    double deepest = 0;
    Index node = 0;
    for (std::size_t c = 0; c < model.contact_nodes.size(); ++c) {
      const Index i = model.contact_nodes[c];
      const double speed = length(velocity(state, i) - obstacle.velocity);
      const double stops_after = std::sqrt(model.mass[i] / obstacle.normal_stiffness[c]);
      const double depth = speed * std::max(state.clock.next_step, stops_after);
      if (depth <= deepest) continue;
      deepest = depth;
      node = i;
    }
    if (!(deepest > safe_part * obstacle.inner_radius)) continue;
    Diagnostic warning;
    warning.message = fmt::format(
        "body `{}` is too fast for obstacle `{}`: with {:.4g} m/s its nodes sink by {:.2g} m or more in a step or "
        "before a spring stops them, and no point of the obstacle is deeper than {:.3g} m",
        model.body_of_node(node).name, obstacle.name, length(velocity(state, node) - obstacle.velocity), deepest,
        obstacle.inner_radius);
    // The inner radius of a plate is half of its thickness.
    warning.cure = fmt::format("make [obstacles.{}] at least {:.2g} m thick", obstacle.name, 2 / safe_part * deepest);
    out.push_back(warning);
  }
  return out;
}

}  // namespace udar

// Plastic indentation in theory, and the shape of what was indented.

#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools.hpp"

namespace udar::verification {

constexpr double degree = std::numbers::pi / 180;

/// What presses one face of a smooth rigid wedge into a rigid, perfectly plastic half-plane.
struct Indentation {
  double pressure = 0;  ///< over the yield stress (Tresca)
  double width = 0;     ///< of what the face presses, seen along the axis, over the depth below the first surface
  [[nodiscard]] double load() const { return pressure * width; }
};

/// Hill, Lee and Tupper (1947); Hill, The Mathematical Theory of Plasticity, 1950, chapter VIII. `angle` is that
/// between the axis and a face, rad.
inline Indentation indentation(double angle) {
  const double fan = root_between(
      [&](double psi) { return std::cos(psi) / (1 + std::sin(psi)) - std::cos(2 * angle - psi); }, 0, 2 * angle);
  const double depth_over_face = std::cos(angle) - std::sin(angle - fan);
  return {1 + fan, std::sin(angle) / depth_over_face};
}

/// Area of a body now, m2.
inline double area_of(const Run& run, std::size_t body) {
  double area = 0;
  for (const Edge& e : run.model.bodies[body].boundary) {
    area += 0.5 * cross(place(run.state, e.a), place(run.state, e.b));
  }
  return area;
}

/// Area of the hollow in the top of a body, m2: between its top and the line through its upper corners where that lies
/// above.
inline double area_below_corners(const Run& run, std::size_t body) {
  const auto& sides = run.model.bodies[body].sides;
  const auto top = std::find_if(sides.begin(), sides.end(), [](const NamedEdges& s) { return s.name == "top"; });
  const double level = 0.5 * (run.state.nodes[top->edges.front().a].y + run.state.nodes[top->edges.back().b].y);
  double area = 0;
  for (const Edge& e : top->edges) {
    const Vec2 a = place(run.state, e.a);
    const Vec2 b = place(run.state, e.b);
    const double deep_a = std::max(0.0, level - a.y);
    const double deep_b = std::max(0.0, level - b.y);
    // Where the edge passes the level, only a part of it counts.
    const bool passes = (a.y < level) != (b.y < level);
    const double part = passes ? (deep_a + deep_b) / std::fabs(a.y - b.y) : 1;
    area += 0.5 * (deep_a + deep_b) * part * (a.x - b.x);
  }
  return area;
}

/// Angle of the straight line nearest to some places, rad against the x-axis.
inline double slope_of(const std::vector<Vec2>& places) {
  Vec2 mean;
  for (const Vec2 p : places) mean += (1.0 / static_cast<double>(places.size())) * p;
  double xx = 0;
  double xy = 0;
  for (const Vec2 p : places) {
    xx += (p.x - mean.x) * (p.x - mean.x);
    xy += (p.x - mean.x) * (p.y - mean.y);
  }
  return std::atan2(xy, xx);
}

}  // namespace udar::verification

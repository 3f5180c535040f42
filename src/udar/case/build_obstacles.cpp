#include "udar/case/build_parts.hpp"

namespace udar {
namespace {

/// The corners of a polygon, which may dig into a boundary where no node of it is inside the polygon.
void add_corners(Model& model, std::uint32_t obstacle, const PreparedPolygon& shape) {
  const std::size_t n = shape.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = (i + n - 1) % n;
    const Vec2 normal = shape.normals[before] + shape.normals[i];
    const double faces = length(shape.points[i] - shape.points[before]) + length(shape.after(i) - shape.points[i]);
    model.obstacle_corners.push_back(
        {.obstacle = obstacle, .place = shape.points[i], .normal = unit(normal, {}), .stretch = 0.5 * faces});
  }
}

/// A smooth outline has none.
template <class Smooth>
void add_corners(Model&, std::uint32_t, const Smooth&) {}

}  // namespace

void add_obstacles(Model& model, const Case& input) {
  for (const ObstacleCase& from : input.obstacles) {
    const PreparedShape prepared = prepare(from.shape);
    Obstacle obstacle{.name = from.name,
                      .shape = from.shape,
                      .prepared = prepared,
                      .bounds = bounds(prepared),
                      .inner_radius = inner_radius(prepared),
                      .friction = from.friction,
                      .velocity = from.velocity,
                      .normal_stiffness = {},
                      .tangential_stiffness = {}};
    obstacle.normal_stiffness.reserve(model.contact_stiffness.size());
    obstacle.tangential_stiffness.reserve(model.contact_stiffness.size());
    for (const double automatic : model.contact_stiffness) {
      const double normal = from.stiffness.value_or(automatic);
      obstacle.normal_stiffness.push_back(normal);
      obstacle.tangential_stiffness.push_back(from.tangential_stiffness.value_or(normal));
    }
    const auto number = static_cast<std::uint32_t>(model.obstacles.size());
    if (from.corners) std::visit([&](const auto& shape) { add_corners(model, number, shape); }, prepared);
    model.obstacles.push_back(std::move(obstacle));
  }
}

}  // namespace udar

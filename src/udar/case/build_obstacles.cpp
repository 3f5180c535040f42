#include "udar/case/build_parts.hpp"

namespace udar {

void add_obstacles(Model& model, const Case& input) {
  for (const ObstacleCase& from : input.obstacles) {
    const PreparedShape prepared = prepare(from.shape);
    Obstacle obstacle{.name = from.name,
                      .shape = from.shape,
                      .prepared = prepared,
                      .bounds = bounds(prepared),
                      .friction = from.friction,
                      .velocity = from.velocity,
                      .normal_stiffness = {},
                      .tangential_stiffness = {}};
    for (const double automatic : model.contact_stiffness) {
      const double normal = from.stiffness.value_or(automatic);
      obstacle.normal_stiffness.push_back(normal);
      obstacle.tangential_stiffness.push_back(from.tangential_stiffness.value_or(normal));
    }
    model.obstacles.push_back(std::move(obstacle));
  }
}

}  // namespace udar

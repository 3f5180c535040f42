#include "udar/model/model.hpp"

#include <algorithm>

#include "udar/model/find_pair.hpp"

namespace udar {
const BodyPair& BodyPairs::look_up(Index a, Index b) const {
  const Exception* const own = entry_of(exceptions, in_order(a, b));
  return own != nullptr ? own->pair : usual;
}

void BodyPairs::set(Index a, Index b, const BodyPair& pair) {
  const BodyNumbers bodies = in_order(a, b);
  if (Exception* const own = entry_of(exceptions, bodies)) {
    own->pair = pair;
  } else {
    exceptions.insert(find_pair(exceptions.begin(), exceptions.end(), bodies), {bodies.first, bodies.second, pair});
  }
}

bool Model::is_tied(std::uint32_t point, Index body) const {
  auto tie =
      std::lower_bound(ties.begin(), ties.end(), point, [](const Tie& t, std::uint32_t p) { return t.point < p; });
  while (tie != ties.end() && tie->point == point && segments[tie->segment].body != body) ++tie;
  return tie != ties.end() && tie->point == point;
}

TouchStiffness Model::touch_stiffness(std::uint32_t point, std::uint32_t segment, double along) const {
  const Segment& s = segments[segment];
  if (is_obstacle_corner(point)) {
    const Obstacle& obstacle = obstacle_of(point);
    const auto between = [&](const std::vector<double>& at) { return (1 - along) * at[s.a] + along * at[s.b]; };
    const double part = std::min(1.0, corner_of(point).stretch / between(contact_node_sizes));
    return {part * between(obstacle.normal_stiffness), part * between(obstacle.tangential_stiffness)};
  }
  const double automatic =
      0.5 * std::min(contact_stiffness[point], segment_softness[segment] * contact_node_sizes[point]);
  const double k = body_pair(point, s.body).stiffness.value_or(automatic);
  return {k, k};
}

const Body& Model::body_of_element(Index element) const {
  return *std::find_if(bodies.begin(), bodies.end(), [=](const Body& b) { return element < b.padded_end; });
}

const Body& Model::body_of_node(Index node) const {
  return *std::find_if(bodies.begin(), bodies.end(), [=](const Body& b) { return node < b.node_end; });
}

}  // namespace udar

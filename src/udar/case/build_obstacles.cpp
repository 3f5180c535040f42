#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include "udar/case/build_parts.hpp"

namespace udar {
namespace {

/// What the boundary offers to a spring at each contact node.
struct ContactNode {
  Index node = 0;
  double edge_length = 0;  ///< m, half of the two boundary edges at the node
  double stiffness = 0;    ///< N/m, automatic
};

/// Height of the element at each boundary edge over that edge, m.
std::vector<double> element_heights(const Model& model, const Body& body) {
  // A body has far more elements than boundary edges: those are looked up where an element may have one, and no map
  // from nodes to elements is made.
  std::map<std::pair<Index, Index>, std::size_t> number;
  std::vector<bool> outer(body.node_end - body.node_begin);
  for (std::size_t k = 0; k < body.boundary.size(); ++k) {
    number[{body.boundary[k].a, body.boundary[k].b}] = k;
    outer[body.boundary[k].a - body.node_begin] = true;
  }
  std::vector<double> heights(body.boundary.size());
  for (Index e = body.element_begin; e < body.element_end; ++e) {
    const auto& t = model.corners[e];
    for (const auto& [a, b] : {std::pair{t[0], t[1]}, {t[1], t[2]}, {t[2], t[0]}}) {
      if (!outer[a - body.node_begin] || !outer[b - body.node_begin]) continue;
      const auto found = number.find({a, b});
      if (found == number.end()) continue;
      const double area = twice_area(model.rest[t[0]], model.rest[t[1]], model.rest[t[2]]);
      heights[found->second] = area / length(model.rest[b] - model.rest[a]);
    }
  }
  return heights;
}

/// Automatic stiffness: (lambda + 2 G) t times tributary edge length over element height, so that a spring is as stiff
/// as the element behind it.
std::vector<ContactNode> contact_nodes(const Model& model) {
  std::vector<ContactNode> found;
  for (const Body& body : model.bodies) {
    std::unordered_map<Index, std::size_t> place;
    const double modulus =
        std::visit([](const auto& law) { return law.elasticity().wave_modulus(); }, body.law) * body.thickness;
    const std::vector<double> heights = element_heights(model, body);
    for (std::size_t k = 0; k < body.boundary.size(); ++k) {
      const Edge edge = body.boundary[k];
      const double edge_length = length(model.rest[edge.b] - model.rest[edge.a]);
      const double stiffness = modulus * 0.5 * edge_length / heights[k];
      for (const Index node : {edge.a, edge.b}) {
        const auto [at, fresh] = place.try_emplace(node, found.size());
        if (fresh) found.push_back({.node = node});
        found[at->second].edge_length += 0.5 * edge_length;
        found[at->second].stiffness += stiffness;
      }
    }
  }
  std::sort(found.begin(), found.end(), [](const ContactNode& a, const ContactNode& b) { return a.node < b.node; });
  return found;
}

/// k/m of the springs and c/m of the dashpots that may act on a node at the same time: of all obstacles.
void limit_steps(Model& model) {
  std::vector<double> spring(model.node_count);
  std::vector<double> dashpot(model.node_count);
  for (const Obstacle& obstacle : model.obstacles) {
    for (std::size_t c = 0; c < model.contact_nodes.size(); ++c) {
      const Index node = model.contact_nodes[c];
      const double stiffer = obstacle.friction > 0
                                 ? std::max(obstacle.normal_stiffness[c], obstacle.tangential_stiffness[c])
                                 : obstacle.normal_stiffness[c];
      spring[node] += stiffer * model.inverse_mass[node];
      dashpot[node] += 2 * model.contact.damping * std::sqrt(obstacle.normal_stiffness[c] * model.inverse_mass[node]);
    }
  }
  model.contact_spring.assign(model.corners.size(), 0);
  for (ElementBlock& block : model.element_blocks) {
    for (Index e = block.begin; e < block.end; ++e) {
      for (const Index corner : model.corners[e]) {
        if (corner >= model.node_count) continue;
        model.contact_spring[e] = std::max(model.contact_spring[e], spring[corner]);
        block.dashpot = std::max(block.dashpot, dashpot[corner]);
      }
    }
  }
}

}  // namespace

void add_obstacles(Model& model, const Case& input) {
  const std::vector<ContactNode> nodes = contact_nodes(model);
  for (const ContactNode& n : nodes) {
    model.contact_nodes.push_back(n.node);
    model.contact_node_sizes.push_back(n.edge_length);
  }
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
    for (const ContactNode& n : nodes) {
      const double normal = from.stiffness.value_or(n.stiffness);
      obstacle.normal_stiffness.push_back(normal);
      obstacle.tangential_stiffness.push_back(from.tangential_stiffness.value_or(normal));
    }
    model.obstacles.push_back(std::move(obstacle));
  }
  limit_steps(model);
}

}  // namespace udar

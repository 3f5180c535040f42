#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

#include "udar/case/build_parts.hpp"

namespace udar {
namespace {

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

/// A contact node as its edges are put together.
struct ContactNode {
  Index node = 0;
  Index body = 0;
  double edge_length = 0;  ///< m, half of the two boundary edges at the node
  double stiffness = 0;    ///< N/m, (lambda + 2 G) t times tributary edge length over element height
};

/// The edges of a body as segments between its contact nodes. Where a body hangs together in a single node, any of the
/// segments that begin there counts as the one after.
void add_segments(Model& model, Index body, const std::vector<double>& softness) {
  const auto point_of = [&](Index node) {
    const auto found = std::lower_bound(model.contact_nodes.begin(), model.contact_nodes.end(), node);
    return static_cast<std::uint32_t>(found - model.contact_nodes.begin());
  };
  const auto first = static_cast<std::uint32_t>(model.segments.size());
  std::vector<std::uint32_t>& begins = model.segment_from;
  begins.resize(model.contact_nodes.size());
  for (const Edge& edge : model.bodies[body].boundary) {
    const auto number = static_cast<std::uint32_t>(model.segments.size());
    model.segments.push_back({.a = point_of(edge.a), .b = point_of(edge.b), .body = body});
    begins[model.segments.back().a] = number;
  }
  for (auto number = first; number < model.segments.size(); ++number) {
    Segment& s = model.segments[number];
    s.after = begins[s.b];
    model.segments[s.after].before = number;
  }
  model.segment_softness.insert(model.segment_softness.end(), softness.begin(), softness.end());
}

/// What the bound on an element's frequency^2 leaves room for at each contact node: a spring of its own, and those of
/// other bodies' nodes on its two segments. Counted whether they touch or not, since a step that jumps with every touch
/// costs energy; a single body may fold and touch itself, and tied bodies may touch beside their ties, but seldom do:
/// nothing for that. What more comes to touch is added when it does.
void allow_for_touches(Model& model) {
  model.contact_allowance.assign(model.contact_nodes.size(), 0);
  const std::size_t n = model.bodies.size();
  std::vector<double> coarsest(n);  // m, contact node of each body
  std::vector<double> stiffest(n);  // N/m
  for (std::size_t c = 0; c < model.contact_nodes.size(); ++c) {
    const std::size_t body = model.contact_bodies[c];
    coarsest[body] = std::max(coarsest[body], model.contact_node_sizes[c]);
    stiffest[body] = std::max(stiffest[body], model.contact_stiffness[c]);
  }
  for (std::size_t c = 0; c < model.contact_nodes.size(); ++c) {
    double most = 0;
    for (std::size_t other = 0; other < n; ++other) {
      const BodyPair& pair = model.body_pair(static_cast<std::uint32_t>(c), static_cast<Index>(other));
      if (other == model.contact_bodies[c] || !pair.touch || pair.tied) continue;
      const double size = model.contact_node_sizes[c];
      const double automatic = 0.5 * model.contact_stiffness[c];  // at most, see touch_stiffness
      const double own = pair.stiffness.value_or(automatic);
      // A rigid body may be meshed very coarsely: its springs are as stiff as its own elements at most.
      const double stiffest_other = model.bodies[other].rigid ? std::max(automatic, 0.5 * stiffest[other])
                                                              : std::numeric_limits<double>::infinity();
      const double coarser = automatic * std::max(1.0, coarsest[other] / size);
      const double others = pair.stiffness.value_or(std::min(coarser, stiffest_other));
      most = std::max(most, 2 * (own + others));
    }
    model.contact_allowance[c] = most * model.inverse_mass[model.contact_nodes[c]];
  }
}

}  // namespace

void add_contact_nodes(Model& model) {
  std::vector<ContactNode> found;
  std::vector<std::vector<double>> softness;  // N/m2, edge by edge of each body
  for (Index b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    std::unordered_map<Index, std::size_t> place;
    const double modulus =
        std::visit([](const auto& law) { return law.elasticity().wave_modulus(); }, body.law) * body.thickness;
    const std::vector<double> heights = element_heights(model, body);
    std::vector<double>& soft = softness.emplace_back();
    for (std::size_t k = 0; k < body.boundary.size(); ++k) {
      const Edge edge = body.boundary[k];
      const double edge_length = length(model.rest[edge.b] - model.rest[edge.a]);
      const double stiffness = modulus * 0.5 * edge_length / heights[k];
      // A rigid boundary yields nothing: the spring is that of the other side.
      soft.push_back(body.rigid ? std::numeric_limits<double>::infinity() : modulus / heights[k]);
      for (const Index node : {edge.a, edge.b}) {
        const auto [at, fresh] = place.try_emplace(node, found.size());
        if (fresh) found.push_back({.node = node, .body = b});
        found[at->second].edge_length += 0.5 * edge_length;
        found[at->second].stiffness += stiffness;
      }
    }
  }
  std::sort(found.begin(), found.end(), [](const ContactNode& a, const ContactNode& b) { return a.node < b.node; });
  for (const ContactNode& n : found) {
    model.contact_nodes.push_back(n.node);
    model.contact_bodies.push_back(n.body);
    model.contact_node_sizes.push_back(n.edge_length);
    model.contact_stiffness.push_back(n.stiffness);
  }
  for (Index b = 0; b < model.bodies.size(); ++b) add_segments(model, b, softness[b]);
  double shortest = std::numeric_limits<double>::infinity();
  for (const double size : model.contact_node_sizes) shortest = std::min(shortest, size);
  model.contact_margin = 0.25 * shortest;
}

void add_body_pairs(Model& model, const Case& input) {
  model.body_pairs.usual = {.friction = input.contact.friction, .stiffness = input.contact.stiffness};
  const auto number = [&](const std::string& name) {
    const auto found =
        std::find_if(model.bodies.begin(), model.bodies.end(), [&](const Body& b) { return b.name == name; });
    return static_cast<Index>(found - model.bodies.begin());
  };
  for (const ContactPairCase& from : input.contact_pairs) {
    model.body_pairs.set(number(from.body), number(from.other),
                         {.touch = from.touch != ContactPairCase::Touch::no,
                          .friction = from.friction.value_or(input.contact.friction),
                          .stiffness = from.stiffness ? from.stiffness : input.contact.stiffness,
                          .tied = from.touch == ContactPairCase::Touch::tied});
  }
  for (const RigidBody& rigid : model.rigid_bodies) {
    BodyPair itself = model.body_pairs.of(rigid.body, rigid.body);
    itself.touch = false;
    model.body_pairs.set(rigid.body, rigid.body, itself);
  }
  allow_for_touches(model);
}

namespace {

/// A rigid body has three frequencies; their squares are at most the sum of what all its springs add, one by one.
void limit_rigid_bodies(Model& model, const std::vector<double>& spring, const std::vector<double>& dashpot) {
  for (RigidBody& rigid : model.rigid_bodies) {
    const Body& body = model.bodies[rigid.body];
    for (std::size_t c = 0; c < model.contact_nodes.size(); ++c) {
      const Index node = model.contact_nodes[c];
      if (node < body.node_begin || node >= body.node_end) continue;
      const double part = model.mass[node] * rigid.inverse_mass_at(model.rest[node]);
      // Where nothing may touch it there is no bound at all: the springs of its own material give a step to fly with.
      rigid.springs += part * std::max(spring[node], model.contact_stiffness[c] * model.inverse_mass[node]);
      rigid.dashpots += part * dashpot[node];
    }
  }
}

}  // namespace

void limit_contact_steps(Model& model) {
  std::vector<double> spring(model.node_count);
  std::vector<double> dashpot(model.node_count);
  for (std::size_t c = 0; c < model.contact_nodes.size(); ++c) {
    spring[model.contact_nodes[c]] = model.contact_allowance[c];
  }
  for (const Tie& tie : model.ties) {
    const Segment& s = model.segments[tie.segment];
    const double size = length(model.rest[model.contact_nodes[s.b]] - model.rest[model.contact_nodes[s.a]]);
    const double tilt = std::fabs(tie.gap) / size;
    const double ends = std::fabs(1 - tie.along) + std::fabs(tie.along);
    const auto add = [&](std::uint32_t point, double share) {
      const Index node = model.contact_nodes[point];
      spring[node] += tie.stiffness * share * (1 + ends + 2 * tilt) * model.inverse_mass[node];
    };
    add(tie.point, 1);
    add(s.a, std::fabs(1 - tie.along) + tilt);
    add(s.b, std::fabs(tie.along) + tilt);
  }
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
  limit_rigid_bodies(model, spring, dashpot);
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

}  // namespace udar

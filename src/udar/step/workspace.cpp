#include "udar/step/workspace.hpp"

#include <algorithm>

namespace udar {
namespace {

Index node_of(Index node) { return node; }
template <class Entry>
Index node_of(const Entry& entry) {
  return entry.node;
}

/// First entry of a list in the order of nodes that is not before `node`.
template <class Entry>
std::size_t position(const std::vector<Entry>& entries, Index node) {
  const auto before = [](const Entry& entry, Index n) { return node_of(entry) < n; };
  return static_cast<std::size_t>(std::lower_bound(entries.begin(), entries.end(), node, before) - entries.begin());
}

template <class Entry>
void sort_by_node(std::vector<Entry>& entries) {
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.node < b.node; });
}

}  // namespace

ContactSums& ContactSums::operator+=(const ContactSums& other) {
  touching += other.touching;
  normal_energy += other.normal_energy;
  tangential_energy += other.tangential_energy;
  largest_penetration = std::max(largest_penetration, other.largest_penetration);
  sink(other.depth, other.deepest);
  losses.friction += other.losses.friction;
  losses.dropped += other.losses.dropped;
  return *this;
}

BodyContact::BodyContact(const Model& model)
    : outer{.nodes = std::vector<NodeRecord>(model.contact_nodes.size()),
            .places = std::vector<Box>(model.node_blocks.size()),
            .velocities = std::vector<Box>(model.node_blocks.size())},
      corner_forces(model.obstacles.size()),
      rigid_excess(model.rigid_bodies.size()),
      rigid_dashpot(model.rigid_bodies.size()) {
  if (model.segments.empty()) return;
  const std::size_t points = model.point_count();
  runs.resize((model.contact_nodes.size() + points_per_run - 1) / points_per_run);
  places.resize(points);
  forces.resize(points);
  springs.resize(points);
  dashpots.resize(points);
}

Workspace::Workspace(const Model& model, int threads)
    : pool(threads),
      forces(model, pool),
      contact_sums(model.obstacles.size() * model.node_blocks.size()),
      bodies(model),
      element_sums(model.element_blocks.size()),
      node_sums(model.node_blocks.size()),
      support_motions(model.supports.size()) {
  for (const Load& load : model.loads) {
    for (const Index node : load.nodes) loaded.push_back({node, loaded.size()});
  }
  for (std::size_t s = 0; s < model.supports.size(); ++s) {
    for (const Index node : model.supports[s].nodes) held.push_back({node, s, held.size()});
  }
  sort_by_node(loaded);
  sort_by_node(held);
  for (const NodeBlock& block : model.node_blocks) {
    const auto range = [&](const auto& entries, std::size_t& begin, std::size_t& end) {
      begin = position(entries, block.begin);
      end = position(entries, block.end);
    };
    OuterNodes& nodes = outer_nodes.emplace_back();
    range(model.contact_nodes, nodes.contact_begin, nodes.contact_end);
    range(loaded, nodes.loaded_begin, nodes.loaded_end);
    range(held, nodes.held_begin, nodes.held_end);
  }
}

}  // namespace udar

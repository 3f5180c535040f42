#include "udar/step/quad_forces.hpp"

namespace udar {
namespace {

/// Calls f(node, slot) for every corner force, in the order of the quads.
template <class F>
void for_each_corner(const Model& model, F&& f) {
  for (const ElementBlock& block : model.element_blocks) {
    const Index corners = block.paired ? 4 : 3;
    for (Index q = block.quads; q < block.quads + block.quad_count(); ++q) {
      const std::uint32_t within = q % lanes % 2 * (lanes / 2) + q % lanes / 2;
      for (Index k = 0; k < corners; ++k) f(model.quads[q][k], q / lanes * (4 * lanes) + k * lanes + within);
    }
  }
}

}  // namespace

QuadForces::QuadForces(const Model& model)
    : forces(4 * model.quads.size()), offsets(model.rest.size() + 1), slots(4 * model.quads.size()) {
  for_each_corner(model, [&](Index node, std::uint32_t) { ++offsets[node + 1]; });
  for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  std::vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
  for_each_corner(model, [&](Index node, std::uint32_t slot) { slots[next[node]++] = slot; });
}

}  // namespace udar

#include <cstdlib>
#include <string_view>

#include "udar/step/stages.hpp"

namespace udar {

BlockKernels widest_block_kernels() {
#if defined(__x86_64__)
  const char* asked = std::getenv("UDAR_LANES");
  const std::string_view most = asked != nullptr ? asked : "avx512";
  if (most == "avx512" && __builtin_cpu_supports("avx512f")) return avx512::block_kernels();
  if (most != "baseline" && __builtin_cpu_supports("avx2")) return avx2::block_kernels();
#endif
  return baseline::block_kernels();
}

void deform_elements(const Model& model, State& state, Workspace& work, std::size_t b) {
  const ElementBlock& block = model.element_blocks[b];
  const Body& body = model.bodies[block.body];
  const ElementTask task{.nodes = state.nodes.data(),
                         .quads = &model.quads[block.quads],
                         .count = block.quad_count(),
                         .step = state.clock.last_step,
                         .half_thickness = 0.5 * body.thickness,
                         .area_density = &model.area_density[block.begin],
                         .contact_spring = &model.contact_spring[block.begin],
                         .xx = &state.stress_xx[block.begin],
                         .yy = &state.stress_yy[block.begin],
                         .xy = &state.stress_xy[block.begin],
                         .zz = &state.stress_zz[block.begin],
                         .plastic_strain = &state.plastic_strain[block.begin],
                         .flowing = &state.flowing[block.begin / lanes],
                         .forces = work.forces.of_block(b),
                         .first_element = block.begin,
                         .compute_above = state.clock.compute_above,
                         .frequency = &state.frequency[b]};
  const void* law = std::visit([](const auto& l) { return static_cast<const void*>(&l); }, body.law);
  const ElementKernel* kernels = block.paired ? work.kernels.deform_paired : work.kernels.deform;
  work.element_sums[b] = kernels[body.law.index()](task, law);
}

void find_frequencies(const Model& model, State& state, Workspace& work) {
  work.pool.for_each_block(model.element_blocks.size(), [&](std::size_t b) { deform_elements(model, state, work, b); });
}

}  // namespace udar

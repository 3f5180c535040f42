#include <cstdlib>
#include <string_view>

#include "udar/step/deform_block.hpp"
#include "udar/step/failure.hpp"
#include "udar/step/stages.hpp"

namespace udar {

const BlockKernel* widest_block_kernels() {
#if defined(__x86_64__)
  const char* asked = std::getenv("UDAR_LANES");
  const std::string_view most = asked != nullptr ? asked : "avx512";
  if (most == "avx512" && __builtin_cpu_supports("avx512f")) return avx512::block_kernels();
  if (most != "baseline" && __builtin_cpu_supports("avx2")) return avx2::block_kernels();
#endif
  return baseline::block_kernels();
}

void deform_elements(const Model& model, State& state, Workspace& work) {
  work.pool.for_each_block(model.element_blocks.size(), [&](std::size_t b) {
    const ElementBlock& block = model.element_blocks[b];
    const Body& body = model.bodies[block.body];
    const BlockTask task{.nodes = state.nodes.data(),
                         .corners = model.corners[block.begin].data(),
                         .count = block.end - block.begin,
                         .step = state.clock.last_step,
                         .half_thickness = 0.5 * body.thickness,
                         .area_density = &model.area_density[block.begin],
                         .xx = &state.stress_xx[block.begin],
                         .yy = &state.stress_yy[block.begin],
                         .xy = &state.stress_xy[block.begin],
                         .zz = &state.stress_zz[block.begin],
                         .plastic_strain = &state.plastic_strain[block.begin],
                         .plastic_power = &state.plastic_power[block.begin],
                         .corner_forces = &work.corner_forces[3 * std::size_t{block.begin}].x};
    const void* law = std::visit([](const auto& l) { return static_cast<const void*>(&l); }, body.law);
    work.element_sums[b] = work.block_kernels[body.law.index()](task, law);
  });

  Ledger& ledger = state.ledger;
  bool inverted = false;
  for (const ElementSums& sums : work.element_sums) {
    ledger.stress_work.add(sums.stress_work);
    ledger.plastic_work.add(sums.plastic_work);
    inverted = inverted || !(sums.smallest_area > 0);
  }
  if (inverted) fail_inverted(model, state);
}

}  // namespace udar

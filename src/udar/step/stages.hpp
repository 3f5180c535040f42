#pragma once

#include "udar/model/state.hpp"
#include "udar/step/workspace.hpp"

namespace udar {

/// The stages of a step, in the order in which they run; each stands in the file of its name. docs/the-step.md says
/// what each reads and writes.

void advance_clock(const Model& model, State& state);
void move_nodes(const Model& model, State& state, Workspace& work);
void deform_elements(const Model& model, State& state, Workspace& work);
void add_contact_force(const Model& model, State& state);
void add_load_force(const Model& model, State& state);
void choose_time_step(const Model& model, State& state, Workspace& work);
void add_support_force(const Model& model, State& state, Workspace& work);
void accelerate_nodes(const Model& model, State& state, Workspace& work);
void close_books(const Model& model, State& state, Workspace& work);

// Only at the start.
State rest_state(const Model& model);
void refuse_buried_nodes(const Model& model, const State& state);
void open_books(const Model& model, State& state);

/// Sum of the corner forces at a node in element order, N.
inline Vec2 internal_force(const Model& model, const Workspace& work, Index node) {
  Vec2 sum;
  const auto& map = model.node_corners;
  for (std::uint32_t k = map.offsets[node]; k < map.offsets[node + 1]; ++k) sum += work.corner_forces[map.corners[k]];
  return sum;
}

}  // namespace udar

#pragma once

#include "udar/model/state.hpp"
#include "udar/step/workspace.hpp"

namespace udar {

/// The stages of a step, in the order in which they run; each stands in the file of its name. docs/the-step.md says
/// what each reads and writes.

void advance_clock(const Model& model, State& state);
void deform_elements(const Model& model, State& state, Workspace& work);
void add_contact_force(const Model& model, State& state, Workspace& work);
void add_load_force(const Model& model, State& state);
void choose_time_step(const Model& model, State& state);
void add_support_force(const Model& model, State& state, Workspace& work);
void accelerate_nodes(const Model& model, State& state, Workspace& work);
void close_books(const Model& model, State& state, Workspace& work);

// Only at the start.
State rest_state(const Model& model);
void refuse_buried_nodes(const Model& model, const State& state);
void open_books(const Model& model, State& state);

}  // namespace udar

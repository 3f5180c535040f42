#pragma once

#include "udar/model/state.hpp"
#include "udar/step/workspace.hpp"

namespace udar {

/// The stages of a step, in the order in which they run. docs/the-step.md says what each reads and writes. Each stands
/// in the file of its name; `sweep` in step.cpp, `set_loads` and `set_supports` beside what adds their forces.

void advance_clock(const Model& model, State& state);
void set_loads(const Model& model, State& state);
void set_supports(const Model& model, const State& state, Workspace& work);
void touch_bodies(const Model& model, State& state, Workspace& work);
void move_rigid_bodies(const Model& model, State& state, Workspace& work);
void sweep(const Model& model, State& state, Workspace& work);
void choose_time_step(const Model& model, State& state, const Workspace& work);
void close_books(const Model& model, State& state, Workspace& work);

// Parts of the sweep, for one block of elements or of nodes.
void deform_elements(const Model& model, State& state, Workspace& work, std::size_t block);
void add_contact_force(const Model& model, State& state, Workspace& work, std::size_t block, NodeForces& forces);
void add_load_force(const State& state, const Workspace& work, std::size_t block, NodeForces& forces);
void add_support_force(const Model& model, State& state, Workspace& work, std::size_t block, NodeForces& forces);
/// `common`: as node_task gives it.
void accelerate_nodes(const Model& model, State& state, Workspace& work, std::size_t block, const NodeForces& forces,
                      const NodeTask& common);
/// What all blocks of nodes have in common in a step: times, weights of the integrator, gravity, damping.
NodeTask node_task(const Model& model, const State& state);

/// Notes where the outer nodes of a block are and how they move on; `look_at_outer_nodes`, the first part of
/// touch_bodies, does it for a state that the workspace does not come from.
void note_outer_nodes(const Model& model, const State& state, Workspace& work, std::size_t block);
void look_at_outer_nodes(const Model& model, const State& state, Workspace& work);

/// Part of close_books: what the springs hold and have lost, and how deep they are pressed.
void enter_springs(const Model& model, State& state, Workspace& work);
/// Part of close_books: adds up the forces of each pair of bodies that touch, and opens a book for those that never
/// did.
void sum_pair_forces(const Model& model, State& state, BodyContact& contact);

/// Part of touch_bodies: adds the forces of ties.
void pull_ties(const Model& model, BodyContact& contact);

// Only at the start.

/// A body may start at rest on its springs, by this part of an element deep; more is a body put in the wrong place,
/// which its springs would shoot off.
inline constexpr double deepest_start = 0.2;

void find_frequencies(const Model& model, State& state, Workspace& work);
State rest_state(const Model& model);
void refuse_overlapping_bodies(const Model& model);
void refuse_closed_gaps(const Model& model);
void refuse_buried_corners(const Model& model);
void refuse_buried_nodes(const Model& model, const State& state);
void open_books(const Model& model, State& state);

}  // namespace udar

#include "udar/step/step.hpp"

#include "udar/step/failure.hpp"
#include "udar/step/stages.hpp"

namespace udar {

/// From the stresses at x_n to the velocity to x_{n+2}, in one pass over memory: a block of nodes follows as soon as
/// the last of its elements is done, while all that they share is at hand.
void sweep(const Model& model, State& state, Workspace& work) {
  const NodeTask common = node_task(model, state);
  work.forces.for_each_block(
      work.pool,
      [&](std::size_t elements) {
        deform_elements(model, state, work, elements);  // strain and turn, stress, corner forces at x_{n+1}
      },
      [&](std::size_t nodes, NodeForces& forces) {                    // those of the elements are summed
        add_contact_force(model, state, work, nodes, forces);         // springs and friction at x_{n+1}
        add_load_force(state, work, nodes, forces);                   // point forces, tractions, pressures
        add_support_force(model, state, work, nodes, forces);         // what it takes to move the held nodes as given
        accelerate_nodes(model, state, work, nodes, forces, common);  // x_{n+1}, a_{n+1} and the velocity to x_{n+2}
      });
  refuse_inverted(model, state, work);
}

void step(const Model& model, State& state, Workspace& work) {
  advance_clock(model, state);            // t_{n+1}, with the step that is already under way
  set_loads(model, state);                // forces at t_{n+1}
  set_supports(model, state, work);       // where held nodes have to be at t_{n+2}
  touch_bodies(model, state, work);       // with each other and with themselves, at x_{n+1}
  move_rigid_bodies(model, state, work);  // those that move as one piece, from t_n to t_{n+1}
  sweep(model, state, work);              // those that deform
  choose_time_step(model, state, work);   // is h_{n+2} still safe? h_{n+3}, and who limits it
  close_books(model, state, work);        // energy, momentum, spin; is everything still finite?
}

void prepare(const Model& model, State& state, Workspace& work) {
  find_frequencies(model, state, work);
  touch_bodies(model, state, work);
  choose_time_step(model, state, work);
  open_books(model, state);
  set_loads(model, state);
  set_supports(model, state, work);
  move_rigid_bodies(model, state, work);
  sweep(model, state, work);
  close_books(model, state, work);
}

State start(const Model& model, Workspace& work) {
  refuse_overlapping_bodies(model);
  refuse_closed_gaps(model);
  refuse_buried_corners(model);
  State state = rest_state(model);
  prepare(model, state, work);
  refuse_buried_nodes(model, state);
  return state;
}

bool finished(const Model& model, const State& state) { return state.clock.time.value() >= model.run.end_time; }

}  // namespace udar

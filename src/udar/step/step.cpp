#include "udar/step/step.hpp"

#include "udar/step/stages.hpp"

namespace udar {

void step(const Model& model, State& state, Workspace& work) {
  advance_clock(model, state);            // t_{n+1}, with the step chosen at the end of the last one
  deform_elements(model, state, work);    // strain and turn, stress, corner forces on the way to x_{n+1}
  add_contact_force(model, state, work);  // springs and friction at x_{n+1}
  add_load_force(model, state);           // point forces, tractions, pressures
  choose_time_step(model, state);         // h_{n+2}, and who limits it
  add_support_force(model, state, work);  // what it takes to move the held nodes as given
  accelerate_nodes(model, state, work);   // x_{n+1}, a_{n+1} and the velocity to x_{n+2}
  close_books(model, state, work);        // energy, momentum, spin; is everything still finite?
}

void prepare(const Model& model, State& state, Workspace& work) {
  deform_elements(model, state, work);
  add_contact_force(model, state, work);
  add_load_force(model, state);
  choose_time_step(model, state);
  open_books(model, state);
  add_support_force(model, state, work);
  accelerate_nodes(model, state, work);
  close_books(model, state, work);
}

State start(const Model& model, Workspace& work) {
  State state = rest_state(model);
  prepare(model, state, work);
  refuse_buried_nodes(model, state);
  return state;
}

bool finished(const Model& model, const State& state) { return state.clock.time.value() >= model.run.end_time; }

}  // namespace udar

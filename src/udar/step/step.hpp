#pragma once

#include "udar/model/state.hpp"
#include "udar/step/workspace.hpp"

namespace udar {

/// The state at t = 0: undeformed or as given places, start velocities, first forces, accelerations and step size.
/// Throws UserError where a fixed step is above the stable limit.
State start(const Model& model, Workspace& work);

/// Completes a state whose stresses or places were set by hand: forces, accelerations and step size at t_0.
void prepare(const Model& model, State& state, Workspace& work);

/// One step, from t_n to t_{n+1}. Throws NumericalError where the computation cannot go on; docs/the-step.md has a
/// section for each line of it.
void step(const Model& model, State& state, Workspace& work);

/// True when the end time is reached.
bool finished(const Model& model, const State& state);

}  // namespace udar

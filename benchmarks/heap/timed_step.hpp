#pragma once

#include "udar/model/model.hpp"
#include "udar/model/state.hpp"
#include "udar/step/workspace.hpp"

namespace udar::heap {

/// Seconds spent in parts of steps so far.
struct StageTimes {
  double touch_bodies = 0;    ///< search, springs and forces between bodies
  double contact_forces = 0;  ///< in the sweep: forces of bodies taken over, obstacles; 0 with more than one thread
  double books = 0;           ///< all of close_books
  double all = 0;
};

/// The step (src/udar/step/step.cpp) with a clock around its parts. Gives the same bits.
void timed_step(const Model& model, State& state, Workspace& work, StageTimes& times);

}  // namespace udar::heap

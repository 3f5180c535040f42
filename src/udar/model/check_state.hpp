#pragma once

#include "udar/model/model.hpp"
#include "udar/model/state.hpp"

namespace udar {

/// Refuses a state that came from a file and does not fit the model: numbers of nodes, elements, segments and bodies
/// that do not exist, lists out of order, a clock that does not tick. What the numbers say of the physics is not
/// judged; the next step does that. Throws OutputError.
void check_state(const Model& model, const State& state);

}  // namespace udar

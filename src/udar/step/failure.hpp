#pragma once

#include "udar/model/model.hpp"
#include "udar/model/state.hpp"
#include "udar/step/workspace.hpp"

namespace udar {

/// Numerical failures: each finds the culprit and throws NumericalError with body, element or node, place, time, step
/// size, likely cause and cure.

/// In a step an element had no area any more, in its middle or at its end.
void refuse_inverted(const Model& model, const State& state, const Workspace& work);
/// Something is not a number any more: names the body, node or element where that began.
[[noreturn]] void fail_not_finite(const Model& model, const State& state);
/// The stable limit fell below a fixed step and the case says to stop then.
[[noreturn]] void fail_unstable(const Model& model, const State& state);
/// The automatic step has become so small that the run would never end.
[[noreturn]] void fail_collapsing_step(const Model& model, const State& state);
/// The energy books are further apart than the case allows.
[[noreturn]] void fail_energy(const Model& model, const State& state);

}  // namespace udar

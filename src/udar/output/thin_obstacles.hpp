#pragma once

#include <string>
#include <vector>

#include "udar/base/error.hpp"
#include "udar/model/model.hpp"
#include "udar/model/state.hpp"

namespace udar {

/// Springs push a node to the nearest side of an obstacle. Of one that nodes sank into by more than half of what it is
/// deep at most, or passed in one step, they may have come out at the wrong side, with books that close: a sentence for
/// each such obstacle.
std::vector<std::string> obstacles_sunk_through(const Model& model, const State& state);

/// What is to be expected of the velocities that nodes have now, whatever their way: in one step they move by v h, and
/// a spring k stops the mass m of a node alone after v sqrt(m / k). A warning for each obstacle that is too thin.
std::vector<Diagnostic> obstacles_too_thin(const Model& model, const State& state);

}  // namespace udar

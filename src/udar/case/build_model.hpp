#pragma once

#include "udar/case/case.hpp"
#include "udar/model/model.hpp"

namespace udar {

/// Everything of the case that does not change in a run: meshes made, placed and numbered for speed, masses lumped,
/// springs given their stiffness, sets and observers found. Throws UserError where a place or name leads nowhere.
Model build_model(const Case& input);

}  // namespace udar

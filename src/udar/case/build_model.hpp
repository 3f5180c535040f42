#pragma once

#include <vector>

#include "udar/case/case.hpp"
#include "udar/mesh/mesh.hpp"
#include "udar/model/model.hpp"

namespace udar {

/// Everything of the case that does not change in a run: meshes made, placed and numbered for speed, masses lumped,
/// springs given their stiffness, sets and observers found. Throws UserError where a place or name leads nowhere, and
/// where there is not the memory for it.
Model build_model(const Case& input);

/// The same with the bodies' meshes given, one for each in the order of the case: from another program, say. They may
/// be numbered in any way and must pass `check_mesh`.
Model build_model(const Case& input, std::vector<Mesh> meshes);

}  // namespace udar

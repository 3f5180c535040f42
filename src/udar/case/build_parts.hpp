#pragma once

#include <vector>

#include "udar/case/case.hpp"
#include "udar/model/model.hpp"

namespace udar {

/// The parts of `build_model` that need the meshes of the bodies, in the order of the case.

/// Obstacles, the nodes that may touch them, and their springs.
void add_obstacles(Model& model, const Case& input);
void add_supports(Model& model, const Case& input, const std::vector<Mesh>& meshes);
void add_loads(Model& model, const Case& input, const std::vector<Mesh>& meshes);
void add_observers(Model& model, const Case& input, const std::vector<Mesh>& meshes);

}  // namespace udar

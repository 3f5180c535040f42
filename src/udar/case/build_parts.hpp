#pragma once

#include <vector>

#include "udar/case/case.hpp"
#include "udar/model/model.hpp"

namespace udar {

/// The parts of `build_model` that need the meshes of the bodies, in the order of the case.

/// The nodes and segments of all boundaries, which may touch obstacles and each other.
void add_contact_nodes(Model& model);
/// Obstacles and their springs.
void add_obstacles(Model& model, const Case& input);
/// What holds between the bodies.
void add_body_pairs(Model& model, const Case& input);
/// Ties the boundaries of bodies that are to stay together. Throws UserError(bad_case) where two do not touch.
void add_ties(Model& model);
/// What all these springs and their dashpots add to the bounds on the frequency of elements.
void limit_contact_steps(Model& model);
void add_supports(Model& model, const Case& input, const std::vector<Mesh>& meshes);
void add_loads(Model& model, const Case& input, const std::vector<Mesh>& meshes);
void add_observers(Model& model, const Case& input, const std::vector<Mesh>& meshes);

}  // namespace udar

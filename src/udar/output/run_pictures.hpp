#pragma once

#include "udar/model/model.hpp"
#include "udar/model/state.hpp"
#include "udar/results/picture.hpp"

namespace udar {

/// What the case describes: bodies, mesh, obstacles, start velocities, supports, observed places.
Picture setup_picture(const Model& model, const State& state, const std::string& title);
/// Where a run has come to: deformed bodies with their plastic strain, or with the largest shear stress where nothing
/// flowed.
Picture state_picture(const Model& model, const State& state, const std::string& title);

/// Where an element is now, m.
Vec2 centroid(const Model& model, const State& state, Index element);

}  // namespace udar

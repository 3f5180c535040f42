#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "udar/model/model.hpp"
#include "udar/model/state.hpp"
#include "udar/results/histories.hpp"

namespace udar {

/// One thing that is watched: it measures its quantities at t_n from the state, without changing it.
struct Observer {
  std::string name;
  std::vector<Column> columns;
  ObserverWindow window;
  /// Fills one value for each column.
  std::function<void(const State&, std::span<double>)> measure;
};

/// A node: displacement, velocity, acceleration.
Observer observe_node(const Model& model, const NodeObserver& node);
/// An element: stresses in the fixed axes, principal stresses (largest first, the out-of-plane one among them),
/// largest shear stress, plastic strain, whether it flows.
Observer observe_element(const Model& model, const ElementObserver& element);
/// Nodes taken together: centre of mass, its velocity and acceleration (sum of forces over mass, unfiltered), momentum,
/// spin momentum about the centre of mass.
Observer observe_region(const Model& model, const RegionObserver& region);
/// The same of a body; of a rigid one also its angle and angular velocity.
Observer observe_body(const Model& model, std::size_t number);
/// Force and impulse of an obstacle on the bodies, and how many nodes touch.
Observer observe_obstacle(const Model& model, std::size_t obstacle);
/// Force and impulse of the second of two bodies on the first, and how many of their nodes touch.
Observer observe_pair(const Model& model, Index first, Index second);
/// Sum of the reactions at a support.
Observer observe_support(const Model& model, std::size_t support);
/// Energy by term; momentum and impulses by term.
Observer observe_energy(const Model& model);
Observer observe_momentum(const Model& model);

/// What is always watched, energy and momentum, bodies, obstacles, supports, and everything the model asks for; pairs
/// of bodies where these are few, or an exception is made for them. Of several with one name all but the first get a
/// number: `beam`, `beam_2`.
std::vector<Observer> make_observers(const Model& model);

/// Elastic energy from the stresses themselves, s : C^-1 : s / 2 over the volume now, J.
double stored_elastic_energy(const Model& model, const State& state);

/// Principal stresses, largest first, Pa.
inline std::array<double, 3> principal_stresses(const State& state, std::size_t element) {
  const double zz = state.stress_zz[element];
  const double centre = 0.5 * (state.stress_xx[element] + state.stress_yy[element]);
  const double half = 0.5 * (state.stress_xx[element] - state.stress_yy[element]);
  const double radius = std::sqrt(half * half + state.stress_xy[element] * state.stress_xy[element]);
  const double larger = centre + radius;
  const double smaller = centre - radius;
  // Choices, no branches: a loop over elements becomes vectors.
  const double above = zz > larger ? zz : larger;
  const double middle = zz > smaller ? zz : smaller;
  const double below = zz > smaller ? smaller : zz;
  return {above, zz > larger ? larger : middle, below};
}

}  // namespace udar

#pragma once

#include <array>
#include <optional>

#include "udar/base/time_table.hpp"
#include "udar/base/vec2.hpp"

namespace udar {

/// How velocities and positions are carried over a step; see docs/theory.md.
enum class Integrator { central_difference, adams, adams2, adams2_new_velocity };
/// What a case file calls them, in the same order; step/integrators.hpp has their rules.
inline constexpr std::array<const char*, 4> integrator_words{"central_difference", "adams", "adams2",
                                                             "adams2_new_velocity"};

/// What to do when the stable limit falls below a fixed step.
enum class WhenUnstable { shorten, stop, carry_on };

/// Damping proportional to mass: force = -rate m (v - v0), v0 being rest or the mean velocity of the body.
struct MassDamping {
  enum class Against { rest, mean_motion };
  double rate = 0;  ///< 1/s; 0: none
  Against against = Against::rest;
  TimeTable factor = TimeTable::constant(1);  ///< multiplies the rate
};

struct RunSettings {
  double end_time = 0;  ///< s
  Integrator integrator = Integrator::central_difference;
  std::optional<double> time_step;  ///< s; none: automatic
  double step_safety = 0.9;         ///< automatic step over stable limit
  WhenUnstable when_unstable = WhenUnstable::shorten;
  double stop_at_energy_error = 0.05;  ///< the run stops when the energy balance is off by more than this part
  Vec2 gravity{};                      ///< m/s2
  MassDamping damping;
};

struct ContactSettings {
  double damping = 0;   ///< fraction of critical damping of a contact spring on its node; normal direction only
  double friction = 0;  ///< Coulomb's coefficient between bodies
  std::optional<double> stiffness;  ///< N/m, of each spring between bodies; none: automatic
};

}  // namespace udar

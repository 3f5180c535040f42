#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "run.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {

// The case's own units, in SI.
constexpr double cm = 1e-2;
constexpr double kgf_cm2 = 98066.5;
constexpr double start_velocity = 80;  ///< m/s, downwards
constexpr double width = 0.4;          ///< m
constexpr double height = 0.1;         ///< m
constexpr double density = 7850;       ///< kg/m3
constexpr double young_modulus = 2e6 * kgf_cm2;
constexpr double poisson_ratio = 0.25;
constexpr double yield_stress = 2400 * kgf_cm2;

/// The first front: waves of pressure in plane strain. 5475.59 m/s.
inline const double pressure_wave =
    std::sqrt(young_modulus * (1 - poisson_ratio) / (density * (1 + poisson_ratio) * (1 - 2 * poisson_ratio)));
/// The main plastic front: sqrt(K / density), 4082 m/s.
inline const double plastic_wave = std::sqrt(young_modulus / (3 * (1 - 2 * poisson_ratio) * density));
/// Elastic limit in uniaxial strain: 3600 kgf/cm2.
constexpr double elastic_limit = yield_stress * (1 - poisson_ratio) / (1 - 2 * poisson_ratio);

inline const std::string elastic =
    "materials.steel={ law = \"elastic\", density = \"7850 kg/m^3\", young_modulus = \"2e6 kgf/cm^2\", "
    "poisson_ratio = 0.25 }";

inline std::string diagonals(const std::string& kind) { return "bodies.beam.mesh.diagonals=" + kind; }
inline std::string end_time(const std::string& time) { return "run.end_time=" + time; }
inline std::string integrator(const std::string& name) { return "run.integrator=" + name; }

using Changes = std::vector<std::string>;

inline Changes mesh(const std::string& size, const std::string& step) {
  return {"bodies.beam.mesh.element_size=" + size, "run.time_step=" + step};
}
inline const Changes coarse = mesh("1 cm", "2.56e-7 s");
inline const Changes medium = mesh("0.25 cm", "6.4e-8 s");

inline Changes operator+(Changes all, const std::string& change) {
  all.push_back(change);
  return all;
}

inline Case beam_case(const Changes& changes) { return load("cases/short-beam/short-beam.toml", changes); }

/// The case's own observers, by name.
inline const NodeObserver& node_called(const Model& model, const std::string& name) {
  return *std::ranges::find(model.observed_nodes, name, &NodeObserver::name);
}
inline Index element_called(const Model& model, const std::string& name) {
  return std::ranges::find(model.observed_elements, name, &ElementObserver::name)->element;
}

/// Of the whole beam, at t_n.
inline Vec2 mean_velocity(const Run& run) {
  Vec2 momentum;
  for (Index i = 0; i < run.model.node_count; ++i) momentum += run.model.mass[i] * velocity(run.state, i);
  return (1 / run.model.bodies.front().mass) * momentum;
}
inline Vec2 centre_of_mass(const Run& run) {
  Vec2 sum;
  for (Index i = 0; i < run.model.node_count; ++i) {
    sum += run.model.mass[i] * Vec2{run.state.nodes[i].x, run.state.nodes[i].y};
  }
  return (1 / run.model.bodies.front().mass) * sum;
}

/// What a run is compared by.
struct Impact {
  double displacement = 0;      ///< m, lowest of the corner in the case's window (0.52 ms)
  double velocity = 0;          ///< m/s, likewise
  double first_touch = -1;      ///< s
  double last_separation = -1;  ///< s; -1: still touching
  double velocity_after = 0;    ///< m/s, of the centre of mass, upwards, at the last separation
  double energy_error = 0;
  double plastic_part = 0;  ///< plastic work over the energy of the start
  std::uint64_t shortened = 0;

  [[nodiscard]] double duration() const { return last_separation - first_touch; }
};

inline Impact strike(const Case& input) {
  Run run(input);
  const NodeObserver& corner = node_called(run.model, "corner");
  Impact impact;
  bool touched = false;
  run.run([&](const Run& now) {
    if (now.time() <= corner.window.end) {
      impact.displacement = std::min(impact.displacement, now.displacement(corner.node).y);
      impact.velocity = std::min(impact.velocity, velocity(now.state, corner.node).y);
    }
    const bool touches = now.state.obstacles.front().touching > 0;
    if (touches && impact.first_touch < 0) impact.first_touch = now.time();
    if (touched && !touches) {
      impact.last_separation = now.time();
      impact.velocity_after = mean_velocity(now).y;
    }
    touched = touches;
  });
  if (touched) impact.last_separation = -1;
  impact.energy_error = run.state.ledger.energy_error();
  impact.plastic_part = run.state.ledger.plastic_work.value() / run.state.ledger.start_energy;
  impact.shortened = run.state.clock.shortened;
  return impact;
}

/// A number against what it should be, with a relative bound; also a row of the page of the case. `size`: what one of
/// `unit` is in SI, whose unit is `si`.
inline void compare(Checks& checks, const std::string& what, double computed, double expected, double bound,
                    const std::string& unit, const std::string& si, double size = 1) {
  checks.page_row(what, fmt::format("{:.5g} {} | {:.5g} {} | {:.2f} % | {:.3g} %", computed, unit, expected, unit,
                                    100 * std::fabs(computed / expected - 1), 100 * bound));
  checks.within(what, computed * size, expected * size, bound, si);
}

// --- parts of the problem in fronts.cpp
namespace short_beam_parts {
void check_first_front(Checks& checks);
void check_first_front_fine(Checks& checks);
void check_plastic_front(Checks& checks);
void check_tension(Checks& checks);
void check_plateau(Checks& checks);
void check_lateral(Checks& checks);
void check_accelerations(Checks& checks);
}  // namespace short_beam_parts

}  // namespace udar::verification

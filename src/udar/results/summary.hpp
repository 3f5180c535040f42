#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "udar/base/vec2.hpp"

namespace udar {

/// Everything in `summary.json`, in SI units. A number that does not exist (no contact, an empty window) is NaN here
/// and null in the file. The names are for ever: scripts read them.

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// What one quantity of an observer did, taken in every step of its window; unit of the quantity.
struct HistorySummary {
  double min = no_number;
  double max = no_number;
  double max_abs = no_number;
  double last = no_number;
  double time_of_min = no_number;  ///< s
  double time_of_max = no_number;  ///< s

  template <class Archive>
  void carry(Archive& archive) {
    archive(min, max, max_abs, last, time_of_min, time_of_max);
  }
};

/// One interval with contact force between an obstacle and the bodies, or between two bodies. What belongs to the place
/// of contact is that of rigid bodies with the same momenta, see docs/theory.md.
struct EpisodeSummary {
  double first_touch = no_number;  ///< s
  double separation = no_number;   ///< s
  double duration = no_number;     ///< s
  Vec2 impulse{};                  ///< N s, on the bodies
  double peak_force = no_number;   ///< N
  Vec2 velocity_before{};          ///< m/s, of the centre of mass of what touched
  Vec2 velocity_after{};           ///< m/s
  double restitution = no_number;  ///< speed away from the obstacle over speed towards it
  /// Velocity along the boundary at the place of contact before over the same after, sign turned: -1 without friction,
  /// 0 where it ends up rolling, 1 where it is thrown back.
  double tangential_restitution = no_number;
  double slip_velocity_before =
      no_number;  ///< m/s, that velocity, along the direction of the push turned by +90 degrees
  double slip_velocity_after = no_number;     ///< m/s
  std::map<std::string, double> spin_before;  ///< kg m2/s, of each body that touched, about its centre of mass
  std::map<std::string, double> spin_after;
};

struct ContactSummary {
  double first_touch = no_number;      ///< s
  double last_separation = no_number;  ///< s
  double duration = no_number;         ///< s, from first touch to last separation
  double duration_99 = no_number;      ///< s, from first touch until 99 % of the final impulse
  Vec2 impulse{};                      ///< N s, on the bodies
  double peak_force = no_number;       ///< N
  int merged_gaps = 0;                 ///< gaps too short to part episodes
  std::vector<EpisodeSummary> episodes;
};

/// The energy balance at the end, J: start + gravity + loads + supports + obstacles = total + error.
struct LedgerSummary {
  double start = 0;
  double kinetic = 0;
  double elastic = 0;         ///< stress work that was not plastic
  double plastic = 0;         ///< dissipated
  double stored_elastic = 0;  ///< from the stress at the end; differs from `elastic` by the error of the step
  double contact = 0;         ///< in the contact springs
  double ties = 0;            ///< in the springs of ties
  double friction = 0;        ///< dissipated
  double dropped = 0;         ///< in springs that were let go while loaded
  double damping = 0;         ///< dissipated
  double gravity = 0;         ///< work done by gravity
  double loads = 0;           ///< work done by loads
  double supports = 0;        ///< work done by moved supports
  double obstacles = 0;       ///< work done by moving obstacles
  double total = 0;           ///< kinetic + elastic + plastic + contact + ties + friction + dropped + damping
  double error = 0;
};

/// The balance of momentum at the end, N s: start + impulses = end + error.
struct MomentumSummary {
  Vec2 start{};
  Vec2 end{};
  Vec2 obstacles{};  ///< impulse of contact and friction
  Vec2 gravity{};
  Vec2 loads{};
  Vec2 supports{};
  Vec2 damping{};
  Vec2 error{};
};

/// The balance of the spin momentum about the origin at the end, N m s: start + moments = end + error.
struct SpinSummary {
  double start = 0;
  double end = 0;
  double obstacles = 0;  ///< moment of contact and friction, over time
  double gravity = 0;
  double loads = 0;
  double supports = 0;
  double damping = 0;
  double error = 0;
};

/// The touch in which a node sank deepest, compared with the boundary at it: Summary::penetration_ratio.
struct PenetrationSummary {
  double depth = no_number;          ///< m
  double time = no_number;           ///< s
  Vec2 place{no_number, no_number};  ///< m
  std::string body;                  ///< whose node it is
  std::string into;                  ///< obstacle or body; the same body where it touched itself
  double stiffness = no_number;      ///< N/m, of the spring there
};

struct TimeStepSummary {
  double min = no_number;              ///< s
  double max = no_number;              ///< s
  double time_of_min = no_number;      ///< s
  std::string limited_by;              ///< what set the smallest step: "beam element 1873"
  long long shortened_steps = 0;       ///< steps shorter than the fixed step asked for
  double first_shortened = no_number;  ///< s
  std::string first_shortened_by;      ///< "beam element 1873"
};

/// A body of the case.
struct BodySummary {
  std::string name;
  bool rigid = false;
  long long elements = 0;
  long long nodes = 0;
};

/// Where an observer of a node or an element sits: the number that the user's mesh gave it.
struct ObservedSummary {
  std::string on;  ///< node or element
  std::string body;
  long long number = 0;
};

/// The computer that the case ran on.
struct MachineSummary {
  std::string processor;  ///< its model; empty where the system does not tell
  int threads = 0;        ///< that it runs at once
};

struct Summary {
  std::string version;
  std::string case_name;
  std::string started;  ///< UTC, "2025-07-01T12:34:56Z"
  MachineSummary machine;
  long long elements = 0;
  long long nodes = 0;
  long long steps = 0;
  int threads = 1;
  int resumed = 0;              ///< how often the run was stopped and gone on with; times below are of all its parts
  double wall_seconds = 0;      ///< of the whole run, output included
  double stepping_seconds = 0;  ///< of these, from the first step to the last
  double element_steps_per_second = 0;
  double end_time = 0;                   ///< s, reached
  double energy_error = no_number;       ///< part of the energy, largest over time
  double identity_error = no_number;     ///< the same of the nodes' work and kinetic energy: rounding only
  double momentum_error = no_number;     ///< part of the momentum, largest over time
  double spin_error = no_number;         ///< part of the spin momentum about the origin, largest over time
  double penetration_ratio = no_number;  ///< deepest penetration over element size
  PenetrationSummary deepest_penetration;
  std::string verdict;                              ///< good, doubtful or bad
  std::vector<std::string> reasons;                 ///< why not good
  std::vector<std::string> warnings;                ///< what may spoil the result though the books close, with its cure
  std::string stop_reason;                          ///< end_time, interrupted, numerical or disk
  std::map<std::string, double> masses;             ///< kg, by body
  std::vector<BodySummary> bodies;                  ///< in the order of the case
  std::vector<std::string> obstacles;               ///< names, in the order of the case
  std::map<std::string, ObservedSummary> observed;  ///< nodes and elements, by name of their history
  TimeStepSummary time_step;
  LedgerSummary ledger;
  MomentumSummary momentum;
  SpinSummary spin;
  std::map<std::string, std::map<std::string, HistorySummary>> histories;  ///< by observer, then quantity
  /// By obstacle, and by pair of bodies, "hammer/anvil": then forces on the first of them, velocities against the
  /// second.
  std::map<std::string, ContactSummary> contacts;
};

std::string to_json(const Summary& summary);
/// Throws OutputError where `text` is not a summary of this schema. Missing and unknown names are passed over.
Summary summary_from_json(std::string_view text);

/// Writes `summary.json`, all or nothing. Throws OutputError.
void write_summary(const std::filesystem::path& path, const Summary& summary);
Summary read_summary(const std::filesystem::path& path);

}  // namespace udar

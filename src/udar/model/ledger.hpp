#pragma once

#include <array>

#include "udar/base/compensated_sum.hpp"
#include "udar/base/vec2.hpp"

namespace udar {

/// Where a force on a node comes from. Each has its own account of work and impulse.
enum class ForceKind { internal, contact, friction, contact_damping, tie, gravity, load, support, damping };
inline constexpr std::size_t force_kinds = 9;

/// The account of one kind of force.
struct ForceBook {
  Vec2 force{};                ///< N, sum over the nodes at t_n
  std::array<Vec2, 3> past{};  ///< N, the same at the last three times, for the Adams integrators
  CompensatedSum impulse_x;    ///< N s, through the velocity that is current
  CompensatedSum impulse_y;
  CompensatedSum work;  ///< J, through the middle of the coming step
  double work_now = 0;  ///< J, through t_n

  [[nodiscard]] Vec2 impulse() const { return {impulse_x.value(), impulse_y.value()}; }
};

/// Who changes the spin momentum of all bodies together: forces from outside. Those between bodies and within them make
/// no moment, and have no book: where they did, the books would open.
enum class SpinKind { obstacle, gravity, load, support, damping };
inline constexpr std::size_t spin_kinds = 5;

/// The account of the moments about the origin of one kind of force.
struct SpinBook {
  double moment = 0;             ///< N m, sum over the nodes at t_n
  std::array<double, 3> past{};  ///< N m, the same at the last three times, for the Adams integrators
  CompensatedSum impulse;        ///< N m s, through the velocity that is current
};

/// The books of energy, momentum and spin. Two independent accounts must agree: stress work and spring energies are
/// summed over elements and springs, everything else over nodes.
struct Ledger {
  std::array<ForceBook, force_kinds> books{};
  std::array<SpinBook, spin_kinds> spin_books{};

  // Element side.
  CompensatedSum stress_work;   ///< J, A_mid t (s_n + s_{n+1}) : de / 2
  CompensatedSum plastic_work;  ///< J

  // Spring side.
  double contact_energy = 0;             ///< J, in normal contact springs now
  double tangential_energy = 0;          ///< J, in tangential contact springs now
  double tie_energy = 0;                 ///< J, in ties now
  CompensatedSum friction_work;          ///< J, lost in sliding
  CompensatedSum dropped_energy;         ///< J, of tangential springs whose node left or changed face
  CompensatedSum obstacle_work;          ///< J, given by moving obstacles, through the middle of the coming step
  double obstacle_work_now = 0;          ///< J, through t_n
  CompensatedSum obstacle_damping_work;  ///< J, part of the obstacles' work that their dashpots swallow at once
  double obstacle_damping_now = 0;       ///< J, through t_n

  // Node side.
  double start_energy = 0;       ///< J, kinetic and in contact springs at t = 0
  double start_kinetic = 0;      ///< J
  double kinetic_energy = 0;     ///< J at t_n, sum m v_{n-1/2} . (v_{n-1/2} + h_n a_n) / 2
  double half_step_kinetic = 0;  ///< J, sum m v_{n+1/2}^2 / 2
  Vec2 carried{};                ///< kg m/s, sum of m (x_{n+1} - x_n) / h
  Vec2 momentum{};               ///< kg m/s, what the impulses add up to: at t_{n+1/2} for central difference, else t_n
  Vec2 start_momentum{};         ///< kg m/s
  double momentum_scale = 0;     ///< kg m/s, sum m |v| at t = 0
  double spin = 0;               ///< kg m2/s, spin momentum about the origin, at the time of `momentum`
  double start_spin = 0;         ///< kg m2/s
  double spin_scale = 0;         ///< kg m2/s, sum m |x| |v| at t = 0
  CompensatedSum external_throughput;  ///< J, integral of |external power|

  // How far the accounts are apart: the largest so far.
  double energy_gap = 0;    ///< J, physical balance
  double identity_gap = 0;  ///< J, work-kinetic identity (central difference)
  double momentum_gap = 0;  ///< kg m/s
  double spin_gap = 0;      ///< kg m2/s; rounding only for central difference

  [[nodiscard]] ForceBook& book(ForceKind kind) { return books[static_cast<std::size_t>(kind)]; }
  [[nodiscard]] const ForceBook& book(ForceKind kind) const { return books[static_cast<std::size_t>(kind)]; }

  [[nodiscard]] SpinBook& spin_book(SpinKind kind) { return spin_books[static_cast<std::size_t>(kind)]; }
  [[nodiscard]] const SpinBook& spin_book(SpinKind kind) const { return spin_books[static_cast<std::size_t>(kind)]; }
  /// Spin momentum now less that of the start and all moments: 0 when the books close. kg m2/s.
  [[nodiscard]] double spin_balance() const {
    double balance = spin - start_spin;
    for (const SpinBook& book : spin_books) balance -= book.impulse.value();
    return balance;
  }

  [[nodiscard]] double elastic_energy() const { return stress_work.value() - plastic_work.value(); }
  /// Lost in mass damping and contact damping, J at t_n. A dashpot has two ends: what an obstacle that moves does on
  /// its own is lost as well as what nodes do on theirs.
  [[nodiscard]] double damped_energy() const {
    return obstacle_damping_now - book(ForceKind::damping).work_now - book(ForceKind::contact_damping).work_now;
  }
  /// Gravity, loads, supports and moving obstacles, J at t_n.
  [[nodiscard]] double external_work() const {
    return book(ForceKind::gravity).work_now + book(ForceKind::load).work_now + book(ForceKind::support).work_now +
           obstacle_work_now;
  }
  /// Everything the energy went into, J at t_n.
  [[nodiscard]] double total_energy() const {
    return kinetic_energy + elastic_energy() + plastic_work.value() + contact_energy + tangential_energy + tie_energy +
           friction_work.value() + dropped_energy.value() + damped_energy();
  }
  /// The same less what came in: 0 when the books close. J at t_n.
  [[nodiscard]] double energy_balance() const { return total_energy() - start_energy - external_work(); }
  [[nodiscard]] double energy_scale() const { return start_energy + external_throughput.value(); }
  /// Largest imbalance so far over start energy and work done; 0 where nothing happened yet.
  [[nodiscard]] double energy_error() const { return energy_scale() > 0 ? energy_gap / energy_scale() : 0; }
  [[nodiscard]] double identity_error() const { return energy_scale() > 0 ? identity_gap / energy_scale() : 0; }
};

}  // namespace udar

#include <algorithm>
#include <cmath>

#include "udar/step/account.hpp"
#include "udar/step/failure.hpp"
#include "udar/step/integrators.hpp"
#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

/// How forces at t_n enter the books of the integrator in use.
class Booking {
 public:
  Booking(const Model& model, const State& state) : state_(state), rule_(rule_of(model.run.integrator)) {
    const Clock& clock = state.clock;
    span_ = velocity_span(clock);
    // Central difference: m (v+^2 - v-^2) / 2 = f . span (v- + v+) / 2 exactly. The Adams family: trapezoids over
    // steps.
    before_ = rule_.weights == nullptr ? 0.5 * span_ : 0.5 * clock.last_step;
    after_ = rule_.weights == nullptr ? 0.5 * span_ : 0.5 * clock.next_step;
    if (rule_.weights != nullptr && clock.step > 0) {
      done_ = weights_of(rule_, clock.step - 1, {clock.last_step, clock.step_before, clock.second_step_before});
    }
  }

  [[nodiscard]] Vec2 after(Index node) const { return {state_.nodes[node].vx, state_.nodes[node].vy}; }
  [[nodiscard]] Vec2 before(Index node) const { return velocity_of_last_step(state_, node); }
  /// Work from the middle of the last step to t_n, J.
  [[nodiscard]] double work_until_now(const Account& a) const { return 0.5 * state_.clock.last_step * a.power_before; }
  /// Work from the middle of the last step to the middle of the coming one, J.
  [[nodiscard]] double work(const Account& a) const { return before_ * a.power_before + after_ * a.power_after; }

  void enter(const Account& account, ForceBook& book) const {
    book.work_now = book.work.value() + work_until_now(account);
    book.work.add(work(account));
    Vec2 impulse = span_ * account.force;
    if (rule_.weights != nullptr) {
      impulse = done_.implicit * account.force;
      for (std::size_t k = 0; k < 3; ++k) impulse += done_.velocity[k] * book.past[k];
      book.past = {account.force, book.past[0], book.past[1]};
    }
    book.impulse_x.add(impulse.x);
    book.impulse_y.add(impulse.y);
    book.force = account.force;
  }

  void enter(double moment, SpinBook& book) const {
    double impulse = span_ * moment;
    if (rule_.weights != nullptr) {
      impulse = done_.implicit * moment;
      for (std::size_t k = 0; k < 3; ++k) impulse += done_.velocity[k] * book.past[k];
      book.past = {moment, book.past[0], book.past[1]};
    }
    book.impulse.add(impulse);
    book.moment = moment;
  }

 private:
  const State& state_;
  const IntegratorRule& rule_;
  StepWeights done_;
  double span_ = 0;
  double before_ = 0;
  double after_ = 0;
};

/// All forces of contact by kind.
struct ContactAccounts {
  Account normal, friction, damping;

  void add(const TouchForces& forces, Vec2 before, Vec2 after) {
    normal.add(forces.normal, before, after);
    friction.add(forces.friction, before, after);
    damping.add(forces.damping, before, after);
  }
};

/// Forces between bodies, in the books of their pairs and in those of all contact.
void enter_touches(const Model& model, State& state, Workspace& work, const Booking& booking, ContactAccounts& all) {
  for (const BodyTouch& touch : state.touches) {
    for_each_force(model.segments, touch, [&](std::uint32_t point, const TouchForces& forces) {
      const Index node = model.contact_nodes[point];
      all.add(forces, booking.before(node), booking.after(node));
    });
  }
  sum_pair_forces(model, state, work.bodies);
  for (std::size_t k = 0; k < state.pairs.size(); ++k) {
    ContactBook& book = state.pairs[k].book;
    PairForces& now = work.bodies.pair_forces[k];
    // Of all that have met, few may touch.
    const bool idle = now.touching == 0 && book.touching == 0 && book.total.past == ForceBook{}.past;
    if (idle) continue;
    book.touching = now.touching;
    booking.enter(now.total, book.total);
    booking.enter(now.pressing, book.normal);
    now = {};
  }
}

/// Forces of obstacles' corners on bodies, in the books of all contact; `total` and `pressing` are those of each
/// obstacle.
void enter_corners(const Model& model, const State& state, const Booking& booking, ContactAccounts& all,
                   std::vector<PairForces>& obstacles) {
  std::fill(obstacles.begin(), obstacles.end(), PairForces{});
  for (const CornerTouch& touch : state.corner_touches) {
    PairForces& of_obstacle = obstacles[model.corner_of(touch.point).obstacle];
    for_each_force(model.segments, touch, [&](std::uint32_t point, const TouchForces& forces) {
      const Vec2 before = booking.before(model.contact_nodes[point]);
      const Vec2 after = booking.after(model.contact_nodes[point]);
      all.add(forces, before, after);
      of_obstacle.pressing.add(forces.normal + forces.damping, before, after);
      of_obstacle.total.add(forces.total(), before, after);
      of_obstacle.damping += forces.damping;
      of_obstacle.total.moment += cross(place(state, model.contact_nodes[point]), forces.total());
    });
  }
}

Account sum_ties(const Model& model, const BodyContact& contact, const Booking& booking) {
  Account account;
  for (std::size_t k = 0; k < contact.tie_pulls.size(); ++k) {
    const Segment& s = model.segments[model.ties[k].segment];
    const auto add = [&](std::uint32_t point, Vec2 force) {
      const Index node = model.contact_nodes[point];
      account.add(force, booking.before(node), booking.after(node));
    };
    add(model.ties[k].point, contact.tie_pulls[k].on_point);
    add(s.a, contact.tie_pulls[k].on_a);
    add(s.b, contact.tie_pulls[k].on_b);
  }
  return account;
}

/// What moving obstacles do themselves, W; and the moment of all obstacles' forces on the bodies.
struct ObstacleAccounts {
  Account work;
  Account damping;  ///< of `work` what goes into dashpots
};

/// Contact forces, obstacle by obstacle and touch by touch; returns the accounts of the obstacles' own work.
ObstacleAccounts enter_contacts(const Model& model, State& state, Workspace& work, const Booking& booking) {
  ContactAccounts all;
  ObstacleAccounts obstacles;
  const std::size_t count = model.contact_nodes.size();
  const std::size_t blocks = model.node_blocks.size();
  std::vector<PairForces>& corners = work.bodies.corner_forces;
  enter_corners(model, state, booking, all, corners);
  for (std::size_t o = 0; o < model.obstacles.size(); ++o) {
    const Vec2 velocity = model.obstacles[o].velocity;
    Account total = corners[o].total;
    Account pressing = corners[o].pressing;
    Vec2 damping = corners[o].damping;
    for (std::size_t b = 0; b < blocks; ++b) {
      if (work.contact_sums[o * blocks + b].touching == 0) continue;
      for (std::size_t c = work.outer_nodes[b].contact_begin; c < work.outer_nodes[b].contact_end; ++c) {
        const SpringState& springs = state.contacts[o * count + c];
        if (springs.touches == 0) continue;
        const Vec2 before = booking.before(model.contact_nodes[c]);
        const Vec2 after = booking.after(model.contact_nodes[c]);
        all.add({springs.normal_force, springs.friction_force, springs.damping_force}, before, after);
        const Vec2 pressing_force = springs.normal_force + springs.damping_force;
        pressing.add(pressing_force, before, after);
        damping += springs.damping_force;
        total.add(pressing_force + springs.friction_force, before, after);
        total.moment += cross(place(state, model.contact_nodes[c]), pressing_force + springs.friction_force);
      }
    }
    booking.enter(total, state.obstacles[o].total);
    booking.enter(pressing, state.obstacles[o].normal);
    obstacles.work.add(total.force, velocity, velocity);
    obstacles.work.moment += total.moment;
    obstacles.damping.add(damping, velocity, velocity);
  }
  enter_touches(model, state, work, booking, all);
  booking.enter(all.normal, state.ledger.book(ForceKind::contact));
  booking.enter(all.friction, state.ledger.book(ForceKind::friction));
  booking.enter(all.damping, state.ledger.book(ForceKind::contact_damping));
  booking.enter(sum_ties(model, work.bodies, booking), state.ledger.book(ForceKind::tie));
  return obstacles;
}

/// Forces that are kept node by node, of loads or of supports.
template <class Part>
Account sum_forces(const std::vector<Part>& parts, const State& state, const std::vector<Vec2>& forces,
                   const Booking& booking) {
  Account account;
  std::size_t k = 0;
  for (const Part& part : parts) {
    for (const Index node : part.nodes) {
      account.add(forces[k], booking.before(node), booking.after(node));
      account.moment += cross(place(state, node), forces[k++]);
    }
  }
  return account;
}

/// Work of the stresses and of the springs, J.
void enter_elements_and_springs(const Model& model, State& state, Workspace& work) {
  double stress_work = 0;
  double plastic_work = 0;
  double unseen = 0;
  for (const ElementSums& sums : work.element_sums) {
    stress_work += sums.stress_work;
    plastic_work += sums.plastic_work;
    unseen += sums.unseen;
  }
  if (!std::isfinite(unseen)) fail_not_finite(model, state);
  Ledger& ledger = state.ledger;
  ledger.stress_work.add(stress_work);
  ledger.plastic_work.add(plastic_work);
  enter_springs(model, state, work);
  // What springs hold at the start was there before.
  if (state.clock.step == 0) {
    ledger.start_energy = ledger.start_kinetic + ledger.contact_energy + ledger.tangential_energy + ledger.tie_energy;
  }
}

/// Where t_n lies between the times of the velocities before and after: a half for equal steps.
double part_until_now(const Clock& clock) {
  return (0.5 * clock.last_step - clock.velocity_ahead) / velocity_span(clock);
}

/// Sums of the bodies at t_n. For central difference those of v_n lie between those of the velocities before and after,
/// as v_n does.
void sum_bodies(const Model& model, State& state, const Workspace& work) {
  const bool half_steps = rule_of(model.run.integrator).weights == nullptr;
  const double part = part_until_now(state.clock);
  std::size_t block = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    BodySums now{.force = model.bodies[b].mass * model.run.gravity};
    Vec2 carried;
    double spin_after = 0;
    for (; block < model.node_blocks.size() && model.node_blocks[block].body == b; ++block) {
      const NodeSums& sums = work.node_sums[block];
      now.position += sums.position;
      now.force += sums.force;
      now.momentum += sums.momentum;
      now.spin += sums.spin;
      carried += sums.carried;
      spin_after += sums.spin_after;
    }
    if (half_steps) {
      now.momentum = (1 - part) * state.body_momentum[b] + part * carried;
      now.spin = (1 - part) * state.body_spin[b] + part * spin_after;
    }
    state.body_sums[b] = now;
    state.body_momentum[b] = carried;
    state.body_spin[b] = spin_after;
  }
}

NodeSums total_of_nodes(const Workspace& work) {
  NodeSums total;
  for (const NodeSums& sums : work.node_sums) {
    total.internal_power += sums.internal_power;
    total.kinetic += sums.kinetic;
    total.kinetic_after += sums.kinetic_after;
    total.damping_before += sums.damping_before;
    total.damping_after += sums.damping_after;
    total.damping_force += sums.damping_force;
    total.damping_moment += sums.damping_moment;
    total.position += sums.position;
    total.spin += sums.spin;
    total.spin_after += sums.spin_after;
    total.carried += sums.carried;
    total.momentum += sums.momentum;
    total.held_momentum += sums.held_momentum;
    total.held_spin += sums.held_spin;
  }
  return total;
}

double total_mass(const Model& model) {
  double mass = 0;
  for (const Body& body : model.bodies) mass += body.mass;
  return mass;
}

}  // namespace

void open_books(const Model& model, State& state) {
  Ledger& ledger = state.ledger;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    for (Index i = body.node_begin; i < body.node_end; ++i) {
      const Vec2 v{state.nodes[i].vx, state.nodes[i].vy};
      ledger.momentum_scale += model.mass[i] * length(v);
      ledger.spin_scale += model.mass[i] * length(place(state, i)) * length(v);
      if (body.rigid) continue;
      ledger.start_kinetic += 0.5 * model.mass[i] * dot(v, v);
      ledger.start_momentum += model.mass[i] * v;
      state.body_momentum[b] += model.mass[i] * v;
      state.body_spin[b] += model.mass[i] * cross(place(state, i), v);
    }
  }
  for (std::size_t k = 0; k < model.rigid_bodies.size(); ++k) {
    const RigidBody& rigid = model.rigid_bodies[k];
    const RigidRate& v = state.rigid[k].velocity;
    ledger.start_kinetic += 0.5 * (rigid.mass * dot(v.linear, v.linear) + rigid.inertia * v.angular * v.angular);
    ledger.start_momentum += rigid.mass * v.linear;
    state.body_momentum[rigid.body] = rigid.mass * v.linear;
    state.body_spin[rigid.body] = rigid.mass * cross(rigid.centre, v.linear) + rigid.inertia * v.angular;
  }
  for (const double spin : state.body_spin) ledger.start_spin += spin;
  ledger.half_step_kinetic = ledger.start_kinetic;
  ledger.carried = ledger.start_momentum;
}

void close_books(const Model& model, State& state, Workspace& work) {
  enter_elements_and_springs(model, state, work);
  Ledger& ledger = state.ledger;
  const Booking booking(model, state);
  const NodeSums nodes = total_of_nodes(work);
  sum_bodies(model, state, work);
  // Forces on the nodes of rigid bodies show in their power only.
  if (!std::isfinite(nodes.kinetic_after + nodes.internal_power)) fail_not_finite(model, state);

  const bool half_steps = rule_of(model.run.integrator).weights == nullptr;
  ledger.kinetic_energy = 0.5 * nodes.kinetic;
  if (half_steps) {
    // v- . (v- + h_n a), as if the next step were as long as the last: with v+ after a step of another length the
    // energy at t_n would be wrong to first order.
    const double weight = 2 * part_until_now(state.clock);
    ledger.kinetic_energy = (1 - weight) * ledger.half_step_kinetic + weight * ledger.kinetic_energy;
  }
  ledger.half_step_kinetic = 0.5 * nodes.kinetic_after;
  ledger.momentum = half_steps ? nodes.carried : nodes.momentum;
  ledger.book(ForceKind::support).impulse_x.add(nodes.held_momentum.x);
  ledger.book(ForceKind::support).impulse_y.add(nodes.held_momentum.y);
  ledger.spin = half_steps ? nodes.spin_after : nodes.spin;
  ledger.spin_book(SpinKind::support).impulse.add(nodes.held_spin);

  const Vec2 weight = total_mass(model) * model.run.gravity;
  const Account gravity{weight, dot(model.run.gravity, ledger.carried), dot(model.run.gravity, nodes.carried),
                        cross(nodes.position, model.run.gravity)};
  ledger.carried = nodes.carried;
  const Account loads = sum_forces(model.loads, state, state.load_forces, booking);
  const Account supports = sum_forces(model.supports, state, state.support_forces, booking);
  const ObstacleAccounts obstacles = enter_contacts(model, state, work, booking);
  booking.enter(gravity, ledger.book(ForceKind::gravity));
  booking.enter(loads, ledger.book(ForceKind::load));
  booking.enter(supports, ledger.book(ForceKind::support));
  booking.enter({nodes.damping_force, nodes.damping_before, nodes.damping_after}, ledger.book(ForceKind::damping));
  booking.enter(obstacles.work.moment, ledger.spin_book(SpinKind::obstacle));
  booking.enter(gravity.moment, ledger.spin_book(SpinKind::gravity));
  booking.enter(loads.moment, ledger.spin_book(SpinKind::load));
  booking.enter(supports.moment, ledger.spin_book(SpinKind::support));
  booking.enter(nodes.damping_moment, ledger.spin_book(SpinKind::damping));
  ledger.book(ForceKind::internal).work.add(0.5 * velocity_span(state.clock) * nodes.internal_power);

  ledger.obstacle_work_now = ledger.obstacle_work.value() + booking.work_until_now(obstacles.work);
  ledger.obstacle_work.add(booking.work(obstacles.work));
  ledger.obstacle_damping_now = ledger.obstacle_damping_work.value() + booking.work_until_now(obstacles.damping);
  ledger.obstacle_damping_work.add(booking.work(obstacles.damping));
  Account external = gravity;
  external += loads;
  external += supports;
  external += obstacles.work;
  ledger.external_throughput.add(std::fabs(booking.work(external)));

  ledger.energy_gap = std::max(ledger.energy_gap, std::fabs(ledger.energy_balance()));
  double node_work = 0;
  Vec2 impulses;
  for (const ForceBook& book : ledger.books) {
    node_work += book.work.value();
    impulses += book.impulse();
  }
  ledger.identity_gap =
      std::max(ledger.identity_gap, std::fabs(ledger.half_step_kinetic - ledger.start_kinetic - node_work));
  ledger.momentum_gap = std::max(ledger.momentum_gap, length(ledger.momentum - ledger.start_momentum - impulses));
  ledger.spin_gap = std::max(ledger.spin_gap, std::fabs(ledger.spin_balance()));

  // In the very first steps there may be hardly any energy to compare with: the end of the run judges them.
  constexpr std::uint64_t first_judged = 100;
  const bool judged = state.clock.step >= first_judged && model.run.when_unstable != WhenUnstable::carry_on;
  if (judged && ledger.energy_error() > model.run.stop_at_energy_error) fail_energy(model, state);
}

}  // namespace udar

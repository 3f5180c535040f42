#pragma once

// Part of block_kernels.cpp, which is compiled for each instruction set: everything lives in a namespace of its name.

#include "udar/base/transpose.hpp"
#include "udar/step/block_kernels.hpp"

namespace udar::UDAR_ISA {
namespace {

/// A vector of the plane for each lane; `Real` is a pack, or a double for the few nodes that fill none.
template <class Real>
struct Vector {
  Real x, y;

  friend Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y}; }
  friend Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y}; }
  friend Vector operator*(Real s, Vector a) { return {s * a.x, s * a.y}; }
  friend Real dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y; }
  friend Real cross(Vector a, Vector b) { return a.x * b.y - a.y * b.x; }
};

template <class Real>
struct Node {
  Vector<Real> place, velocity;
};

/// How a double and a pack are read and written.
template <class Real>
struct Access;

template <>
struct Access<double> {
  static constexpr Index lanes = 1;
  static double load(const double* from) { return *from; }
  static void store(double value, double* to) { *to = value; }
  static Vector<double> load(const Vec2* from) { return {from->x, from->y}; }
  static void store(Vector<double> v, Vec2* to) { *to = {v.x, v.y}; }
  static Node<double> load(const NodeRecord* from) { return {{from->x, from->y}, {from->vx, from->vy}}; }
  static void store(const Node<double>& n, NodeRecord* to) { *to = {n.place.x, n.place.y, n.velocity.x, n.velocity.y}; }
};

template <>
struct Access<Pack> {
  static constexpr Index lanes = Pack::lanes;
  static Pack load(const double* from) { return Pack::load(from); }
  static void store(Pack value, double* to) { value.store(to); }
  static Vector<Pack> load(const Vec2* from) {
    Vector<Pack> v;
    split_pairs(Pack::load(&from->x), Pack::load(&from->x + lanes), v.x, v.y);
    return v;
  }
  static void store(Vector<Pack> v, Vec2* to) {
    Pack first, second;
    join_pairs(v.x, v.y, first, second);
    first.store(&to->x);
    second.store(&to->x + lanes);
  }
  static Node<Pack> load(const NodeRecord* from) {
    const Columns c = columns(load_records([&](int lane) { return &from[lane].x; }));
    return {{c.at[0], c.at[1]}, {c.at[2], c.at[3]}};
  }
  static void store(const Node<Pack>& n, NodeRecord* to) {
    store_records(records({{n.place.x, n.place.y, n.velocity.x, n.velocity.y}}), [&](int lane) { return &to[lane].x; });
  }
};

/// Sum over the nodes of a block: lane by lane, then over the lanes. The order is fixed, whatever computes it.
class LaneSum {
 public:
  template <class Real>
  void add(Real value, Index node) {
    double* lane = sum_ + node % lanes;
    Access<Real>::store(Access<Real>::load(lane) + value, lane);
  }
  template <class Real>
  friend void add(LaneSum& x, LaneSum& y, Vector<Real> v, Index node) {
    x.add(v.x, node);
    y.add(v.y, node);
  }
  [[nodiscard]] double total() const {
    double total = 0;
    for (const double lane : sum_) total += lane;
    return total;
  }

 private:
  double sum_[lanes] = {};
};

struct NodeLaneSums {
  LaneSum internal_power, kinetic, kinetic_after, spin_after, carried_x, carried_y;
  LaneSum momentum_x, momentum_y, spin, position_x, position_y, force_x, force_y;
  LaneSum damping_before, damping_after, damping_x, damping_y;
};

/// What a loop over nodes keeps in registers.
template <class Real>
struct Constants {
  Real last_step, span;
  Vector<Real> gravity;

  explicit Constants(const NodeTask& task)
      : last_step(task.last_step), span(task.span), gravity{Real(task.gravity.x), Real(task.gravity.y)} {}
};

/// v_{n+1/2} = v_{n-1/2} + a_n (h_n + h_{n+1}) / 2.
struct CentralDifference {
  const NodeTask& task;

  template <class Real>
  Vector<Real> next_velocity(const Constants<Real>& k, Index, Vector<Real> before, Vector<Real> acceleration) const {
    return before + k.span * acceleration;
  }

  /// v_{n-1/2} . v_{n+1/2} as if the next step were as long as the last: with the velocity after a step of another
  /// length the energy at t_n would be wrong to first order.
  template <class Real>
  void book(const Constants<Real>& k, NodeLaneSums& sums, Index i, Real mass, const Node<Real>& node,
            Vector<Real> before, Vector<Real> acceleration) const {
    sums.kinetic.add(mass * dot(before, before + k.last_step * acceleration), i);
    sums.spin.add(mass * cross(node.place, acceleration), i);
  }
  /// v_n = v_{n+1/2} - a_n h_{n+1} / 2.
  void finish(NodeSums& sums) const {
    const double half = 0.5 * task.next_step;
    sums.momentum = {sums.carried.x - half * sums.force.x, sums.carried.y - half * sums.force.y};
    sums.spin = sums.spin_after - half * sums.spin;
  }
};

/// The Adams family and its start: closes v_n with the weights of the step just done, then extrapolates the mean
/// velocity of the step to come.
struct Multistep {
  const NodeTask& task;

  template <class Real>
  Vector<Real> next_velocity(const Constants<Real>&, Index i, Vector<Real> before, Vector<Real> acceleration) const {
    using On = Access<Real>;
    Vector<Real> v = On::load(task.velocity + i);
    const Vector<Real> a0 = On::load(task.acceleration + i);
    const Vector<Real> a1 = On::load(task.last_acceleration + i);
    const Vector<Real> a2 = On::load(task.second_acceleration + i);
    if (!task.first) {
      const auto& w = task.done.velocity;
      v = v + (Real(task.done.implicit) * acceleration + Real(w[0]) * a0 + Real(w[1]) * a1 + Real(w[2]) * a2);
      On::store(v, task.velocity + i);
    }
    On::store(a1, task.second_acceleration + i);
    On::store(a0, task.last_acceleration + i);
    On::store(before, task.velocity_before + i);
    const auto& w = task.coming.mean;
    return v + Real(w[0]) * acceleration + Real(w[1]) * a0 + Real(w[2]) * a1;
  }

  template <class Real>
  void book(const Constants<Real>&, NodeLaneSums& sums, Index i, Real mass, const Node<Real>& node, Vector<Real>,
            Vector<Real>) const {
    const Vector<Real> v = Access<Real>::load(task.velocity + i);
    const Vector<Real> momentum = mass * v;
    sums.kinetic.add(dot(momentum, v), i);
    add(sums.momentum_x, sums.momentum_y, momentum, i);
    sums.spin.add(cross(node.place, momentum), i);
  }
  static void finish(NodeSums&) {}
};

/// One pack of nodes, or a single one.
template <class Real, class Rule>
void accelerate(const NodeTask& task, const Constants<Real>& k, const Rule& rule, Index i, NodeLaneSums& sums) {
  using On = Access<Real>;
  Node<Real> node = On::load(task.nodes + i);
  const Vector<Real> before = node.velocity;
  const Real mass = On::load(task.mass + i);
  const Vector<Real> internal = On::load(task.internal + i);
  Vector<Real> force = internal;
  if (task.external != nullptr) force = force + On::load(task.external + i);
  Vector<Real> damping{Real(0), Real(0)};
  if (task.damping > 0) {
    const Vector<Real> reference{Real(task.damping_reference.x), Real(task.damping_reference.y)};
    damping = (Real(-task.damping) * mass) * (before - reference);
    force = force + damping;
  }
  const Vector<Real> acceleration = On::load(task.inverse_mass + i) * force + k.gravity;
  const Vector<Real> after = rule.next_velocity(k, i, before, acceleration);
  node.place = node.place + k.last_step * before;
  node.velocity = after;
  On::store(node, task.nodes + i);
  On::store(acceleration, task.acceleration + i);

  sums.internal_power.add(dot(internal, before + after), i);
  rule.book(k, sums, i, mass, node, before, acceleration);
  const Vector<Real> carried = mass * after;
  sums.kinetic_after.add(dot(carried, after), i);
  add(sums.carried_x, sums.carried_y, carried, i);
  sums.spin_after.add(cross(node.place, carried), i);
  add(sums.position_x, sums.position_y, mass * node.place, i);
  add(sums.force_x, sums.force_y, mass * acceleration, i);
  if (task.damping > 0) {
    add(sums.damping_x, sums.damping_y, damping, i);
    sums.damping_before.add(dot(damping, before), i);
    sums.damping_after.add(dot(damping, after), i);
  }
}

template <class Rule>
[[gnu::flatten]] NodeSums accelerate_block(const NodeTask& task) {
  const Rule rule{task};
  NodeLaneSums sums;
  const Constants<Pack> in_packs(task);
  const Constants<double> alone(task);
  Index i = 0;
  for (; i + Pack::lanes <= task.count; i += Pack::lanes) accelerate(task, in_packs, rule, i, sums);
  for (; i < task.count; ++i) accelerate(task, alone, rule, i, sums);

  NodeSums total{.internal_power = sums.internal_power.total(),
                 .kinetic = sums.kinetic.total(),
                 .kinetic_after = sums.kinetic_after.total(),
                 .damping_before = sums.damping_before.total(),
                 .damping_after = sums.damping_after.total(),
                 .spin_after = sums.spin_after.total(),
                 .spin = sums.spin.total(),
                 .position = {sums.position_x.total(), sums.position_y.total()},
                 .force = {sums.force_x.total(), sums.force_y.total()},
                 .carried = {sums.carried_x.total(), sums.carried_y.total()},
                 .momentum = {sums.momentum_x.total(), sums.momentum_y.total()},
                 .damping_force = {sums.damping_x.total(), sums.damping_y.total()}};
  rule.finish(total);
  return total;
}

}  // namespace
}  // namespace udar::UDAR_ISA

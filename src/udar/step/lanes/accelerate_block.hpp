#pragma once

// Part of block_kernels.cpp, which is compiled for each instruction set: everything lives in a namespace of its name.

#include "udar/base/transpose.hpp"
#include "udar/step/block_kernels.hpp"
#include "udar/step/lanes/lane_sums.hpp"

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

/// Sum over the nodes of a block: lane by lane, then over the lanes. The order is fixed, whatever computes it. Packs
/// are added in registers; what is left is added to the lanes one by one.
template <class Real>
struct LaneSum;

template <>
struct LaneSum<Pack> {
  Pack pack[lanes / Pack::lanes];

  LaneSum() {
    for (Pack& p : pack) p = Pack(0);
  }
  void add(Pack value, Index lane) { pack[lane / Pack::lanes] = pack[lane / Pack::lanes] + value; }
};

template <>
struct LaneSum<double> {
  double lane[lanes];

  explicit LaneSum(const LaneSum<Pack>& packs) {
    for (Index p = 0; p < lanes / Pack::lanes; ++p) packs.pack[p].store(lane + p * Pack::lanes);
  }
  void add(double value, Index at) { lane[at] += value; }
  [[nodiscard]] double total() const { return sum_of_lanes(lane); }
};

template <class Real>
struct LaneVector {
  LaneSum<Real> x, y;

  LaneVector() = default;
  explicit LaneVector(const LaneVector<Pack>& packs) : x(packs.x), y(packs.y) {}
  void add(Vector<Real> v, Index lane) {
    x.add(v.x, lane);
    y.add(v.y, lane);
  }
  [[nodiscard]] Vec2 total() const { return {x.total(), y.total()}; }
};

/// As NodeSums.
template <class Real>
struct NodeLaneSums {
  LaneSum<Real> internal_power, kinetic, kinetic_after, spin, spin_after;
  LaneVector<Real> position, force, carried, momentum;
  LaneSum<Real> damping_before, damping_after, damping_moment;
  LaneVector<Real> damping;

  NodeLaneSums() = default;
  explicit NodeLaneSums(const NodeLaneSums<Pack>& p)
      : internal_power(p.internal_power),
        kinetic(p.kinetic),
        kinetic_after(p.kinetic_after),
        spin(p.spin),
        spin_after(p.spin_after),
        position(p.position),
        force(p.force),
        carried(p.carried),
        momentum(p.momentum),
        damping_before(p.damping_before),
        damping_after(p.damping_after),
        damping_moment(p.damping_moment),
        damping(p.damping) {}
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

  template <class Real>
  void book(NodeLaneSums<Real>& sums, Index, Index lane, Real, const Node<Real>&, Vector<Real> before,
            Vector<Real> carried) const {
    sums.kinetic.add(dot(carried, before), lane);
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
  void book(NodeLaneSums<Real>& sums, Index i, Index lane, Real mass, const Node<Real>& node, Vector<Real>,
            Vector<Real>) const {
    const Vector<Real> v = Access<Real>::load(task.velocity + i);
    const Vector<Real> momentum = mass * v;
    sums.kinetic.add(dot(momentum, v), lane);
    sums.momentum.add(momentum, lane);
    sums.spin.add(cross(node.place, momentum), lane);
  }
};

/// One pack of nodes, or a single one, whose (first) lane of the sums is `lane`.
template <class Real, class Rule>
void accelerate(const NodeTask& task, const Constants<Real>& k, const Rule& rule, Index i, Index lane,
                NodeLaneSums<Real>& sums) {
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

  sums.internal_power.add(dot(internal, before + after), lane);
  const Vector<Real> carried = mass * after;
  rule.book(sums, i, lane, mass, node, before, carried);
  sums.kinetic_after.add(dot(carried, after), lane);
  sums.carried.add(carried, lane);
  sums.spin_after.add(cross(node.place, carried), lane);
  sums.position.add(mass * node.place, lane);
  sums.force.add(force, lane);
  if (task.damping > 0) {
    sums.damping.add(damping, lane);
    sums.damping_before.add(dot(damping, before), lane);
    sums.damping_after.add(dot(damping, after), lane);
    sums.damping_moment.add(cross(node.place, damping), lane);
  }
}

template <class Rule>
[[gnu::flatten]] NodeSums accelerate_block(const NodeTask& task) {
  const Rule rule{task};
  const Constants<Pack> in_packs(task);
  const Constants<double> alone(task);
  NodeLaneSums<Pack> packs;
  Index i = 0;
  for (; i + lanes <= task.count; i += lanes) {
    for (Index lane = 0; lane < lanes; lane += Pack::lanes) accelerate(task, in_packs, rule, i + lane, lane, packs);
  }
  NodeLaneSums<double> sums(packs);
  for (Index lane = 0; i < task.count; ++i, ++lane) accelerate(task, alone, rule, i, lane, sums);

  return {.internal_power = sums.internal_power.total(),
          .kinetic = sums.kinetic.total(),
          .kinetic_after = sums.kinetic_after.total(),
          .damping_before = sums.damping_before.total(),
          .damping_after = sums.damping_after.total(),
          .spin_after = sums.spin_after.total(),
          .spin = sums.spin.total(),
          .position = sums.position.total(),
          .force = sums.force.total(),
          .carried = sums.carried.total(),
          .momentum = sums.momentum.total(),
          .damping_force = sums.damping.total(),
          .damping_moment = sums.damping_moment.total()};
}

}  // namespace
}  // namespace udar::UDAR_ISA

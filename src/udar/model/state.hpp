#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "udar/base/array.hpp"
#include "udar/base/vec2.hpp"
#include "udar/contact/corner_touch.hpp"
#include "udar/mesh/mesh.hpp"
#include "udar/model/find_pair.hpp"
#include "udar/model/ledger.hpp"

namespace udar {

/// A node as the element sweep loads it: its place at t_n and its mean velocity over the coming step,
/// (x_{n+1} - x_n) / h_{n+1}. For central difference that is v_{n+1/2}.
struct alignas(32) NodeRecord {
  double x = 0;   ///< m
  double y = 0;   ///< m
  double vx = 0;  ///< m/s
  double vy = 0;  ///< m/s
};

/// What one obstacle has done to all bodies together, or one body to another.
struct ContactBook {
  ForceBook total;             ///< contact, friction and damping
  ForceBook normal;            ///< contact springs and damping: without friction
  std::uint64_t touching = 0;  ///< nodes now
};

/// What two bodies have done to each other, or a body to itself.
struct PairBook {
  Index first = 0;  ///< body, not above `second`
  Index second = 0;
  ContactBook book;  ///< forces on the first
};

/// Rates of the motion of a rigid body: of its centre of mass, and of its turn.
struct RigidRate {
  Vec2 linear{};       ///< m/s, or m/s2
  double angular = 0;  ///< rad/s, or rad/s2

  RigidRate& operator+=(const RigidRate& b) { return linear += b.linear, angular += b.angular, *this; }
  friend RigidRate operator+(RigidRate a, const RigidRate& b) { return a += b; }
  friend RigidRate operator*(double s, const RigidRate& a) { return {s * a.linear, s * a.angular}; }
};

/// A rigid body at t_n, with the velocity that carries it to t_{n+1}.
struct RigidMotion {
  Vec2 place{};                              ///< m, of its centre of mass
  double angle = 0;                          ///< rad, since t = 0
  RigidRate velocity;                        ///< mean over the coming step
  RigidRate now;                             ///< v_n; Adams integrators only
  std::array<RigidRate, 3> accelerations{};  ///< at t_n, t_{n-1}, t_{n-2}
};

/// Where a node sank deepest into what it touched, compared with the boundary edges at it.
struct DeepestTouch {
  double depth = 0;             ///< m
  double time = 0;              ///< s
  Vec2 place{};                 ///< m, of the node
  double stiffness = 0;         ///< N/m, of its normal spring
  Index node = 0;               ///< that sank in
  std::uint32_t into_body = 0;  ///< 1: into a body, 0: into an obstacle
  std::uint64_t partner = 0;    ///< number of that body or obstacle
};

/// How deep a node has sunk into an obstacle, the deepest so far.
struct Sinking {
  double depth = 0;  ///< m; that it can be at most (Obstacle::inner_radius) where a node passed through in one step
  double time = 0;   ///< s
  std::uint64_t node = 0;
};

/// What limits the step.
struct StepLimit {
  double size = 0;  ///< s, stable limit
  Index element = 0;
  std::uint32_t by_contact = 0;  ///< 1 where contact springs lower the element's limit
};

/// Sums over the nodes of a body at t_n.
struct BodySums {
  Vec2 position{};  ///< kg m, of m x
  Vec2 momentum{};  ///< kg m/s, of m v
  Vec2 force{};     ///< N, of m a
  double spin = 0;  ///< kg m2/s, of m x cross v
};

/// The largest frequency of a block of elements, contact springs included. It is computed now and then; in between it
/// may have grown by what the elements were stretched at most.
struct FrequencyBound {
  double squared = std::numeric_limits<double>::infinity();  ///< 1/s2, never below the block's largest
  double computed = 0;                                       ///< 1/s2, the largest when it was last computed
  Index element = 0;                                         ///< that had it
  std::uint32_t unused = 0;
};

struct Clock {
  CompensatedSum time;             ///< s, t_n
  std::uint64_t step = 0;          ///< n
  double last_step = 0;            ///< s, h_n; 0 at the start
  double step_before = 0;          ///< s, h_{n-1}
  double second_step_before = 0;   ///< s, h_{n-2}
  double next_step = 0;            ///< s, h_{n+1}
  double following_step = 0;       ///< s, h_{n+2} as planned
  double velocity_ahead = 0;       ///< s, by which the velocity of the last step is later than its middle: 0, but
  double next_velocity_ahead = 0;  ///< s, for a step that was cut short after its velocity was computed; the next one's
  std::uint64_t next_is_last = 0;  ///< 1 where the next step ends on the end time
  std::uint64_t following_is_last = 0;
  double planned_step = 0;      ///< s, the last one chosen, before it was fitted to the end time
  StepLimit limit;              ///< at t_n; see choose_time_step for how near the exact one
  double compute_above = 0;     ///< 1/s2: a block whose bound is above computes its frequency in the next step
  double start_limit = 0;       ///< s, stable limit at t = 0
  StepLimit tightest;           ///< smallest stable limit so far, and what set it
  double tightest_time = 0;     ///< s
  double smallest_step = 0;     ///< s
  double largest_step = 0;      ///< s
  std::uint64_t shortened = 0;  ///< steps in which a fixed step was above the stable limit
  double first_shortened = 0;   ///< s
  std::uint64_t first_shortened_element = 0;
  double largest_excess = 0;  ///< largest step over stable limit
};

/// Everything that changes: plain arrays and numbers, no pointer, nothing sized by the number of threads. Only the step
/// writes it. At rest between two steps it holds t_n: places x_n, stresses s_n, accelerations a_n, and the velocity
/// that carries the nodes to x_{n+1}.
struct State {
  Clock clock;
  Array<NodeRecord> nodes;   ///< padding nodes at the end
  Array<Vec2> acceleration;  ///< m/s2, a_n

  // Adams integrators only, else empty.
  Array<Vec2> velocity;             ///< m/s, v_n
  Array<Vec2> velocity_before;      ///< m/s, mean over the last step
  Array<Vec2> last_acceleration;    ///< m/s2, a_{n-1}
  Array<Vec2> second_acceleration;  ///< m/s2, a_{n-2}

  // Elements, padded.
  Array<double> stress_xx;  ///< Pa, fixed axes
  Array<double> stress_yy;
  Array<double> stress_xy;
  Array<double> stress_zz;
  Array<double> plastic_strain;
  Array<std::uint8_t> flowing;      ///< bit e % 8 of byte e / 8: element e flowed in the last step
  Array<FrequencyBound> frequency;  ///< one for each block of elements

  std::vector<RigidMotion> rigid;           ///< one for each of Model::rigid_bodies
  std::vector<SpringState> contacts;        ///< obstacle by obstacle, one for each contact node
  std::vector<BodyTouch> touches;           ///< of bodies with each other, in the order of points, then of bodies
  std::vector<CornerTouch> corner_touches;  ///< the same of the corners of obstacles with bodies
  std::vector<ContactBook> obstacles;
  std::vector<Sinking> sunk;         ///< one for each obstacle
  std::vector<PairBook> pairs;       ///< only those that have touched; in the order of first, then second body
  std::vector<Vec2> load_forces;     ///< N, load by load, node by node
  std::vector<Vec2> support_forces;  ///< N, support by support, node by node
  std::vector<Vec2> body_momentum;   ///< kg m/s, one for each body: sum of m times the velocity over the coming step
  std::vector<double> body_spin;     ///< kg m2/s, the same of m x cross that velocity
  std::vector<BodySums> body_sums;   ///< one for each body
  double largest_penetration = 0;    ///< over the mean length of the boundary edges at the node
  DeepestTouch deepest;              ///< that touch
  Ledger ledger;
};

/// Where a node is at t_n, m.
inline Vec2 place(const State& state, Index node) { return {state.nodes[node].x, state.nodes[node].y}; }

/// Velocity at t_n, m/s, from what the integrator keeps.
inline Vec2 velocity(const State& state, Index node) {
  if (!state.velocity.empty()) return state.velocity[node];
  const NodeRecord& r = state.nodes[node];
  const Clock& clock = state.clock;
  return Vec2{r.vx, r.vy} - (0.5 * clock.next_step + clock.next_velocity_ahead) * state.acceleration[node];
}

/// Rates of a rigid body at t_n.
inline RigidRate velocity(const State& state, const RigidMotion& motion) {
  if (!state.velocity.empty()) return motion.now;
  const Clock& clock = state.clock;
  return motion.velocity + (-0.5 * clock.next_step - clock.next_velocity_ahead) * motion.accelerations[0];
}

/// Did this element flow in the last step?
inline bool flows(const State& state, Index element) { return (state.flowing[element / 8] >> element % 8 & 1) != 0; }

/// The book of two bodies in either order, or of a body with itself; nullptr if they never touched.
inline const ContactBook* book_of_pair(const State& state, Index a, Index b) {
  const PairBook* const found = entry_of(state.pairs, in_order(a, b));
  return found != nullptr ? &found->book : nullptr;
}

/// Names every array of the state once: for hashing its bits, finding what is not a number, counting memory, saving.
template <class S, class Visitor>
void for_each_field(S& state, Visitor&& visit) {
  visit("clock", state.clock);
  visit("nodes", state.nodes);
  visit("acceleration", state.acceleration);
  visit("velocity", state.velocity);
  visit("velocity_before", state.velocity_before);
  visit("last_acceleration", state.last_acceleration);
  visit("second_acceleration", state.second_acceleration);
  visit("stress_xx", state.stress_xx);
  visit("stress_yy", state.stress_yy);
  visit("stress_xy", state.stress_xy);
  visit("stress_zz", state.stress_zz);
  visit("plastic_strain", state.plastic_strain);
  visit("flowing", state.flowing);
  visit("frequency", state.frequency);
  visit("rigid", state.rigid);
  visit("contacts", state.contacts);
  visit("touches", state.touches);
  visit("corner_touches", state.corner_touches);
  visit("obstacles", state.obstacles);
  visit("sunk", state.sunk);
  visit("pairs", state.pairs);
  visit("load_forces", state.load_forces);
  visit("support_forces", state.support_forces);
  visit("body_momentum", state.body_momentum);
  visit("body_spin", state.body_spin);
  visit("body_sums", state.body_sums);
  visit("largest_penetration", state.largest_penetration);
  visit("deepest", state.deepest);
  visit("ledger", state.ledger);
}

}  // namespace udar

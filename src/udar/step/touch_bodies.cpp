#include <algorithm>
#include <cmath>

#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"
#include "udar/step/touch_search.hpp"

namespace udar {
namespace {

/// A point is never near the segments that it ends, nor those of a body that its own is not to touch or that it is tied
/// to.
void drop_own_segments(const Model& model, Neighbours& near) {
  const auto may_touch = [&](std::uint32_t point, const Segment& s) {
    if (model.is_obstacle_corner(point)) return true;
    return s.a != point && s.b != point && model.body_pair(point, s.body).touch && !model.is_tied(point, s.body);
  };
  std::uint32_t kept = 0;
  std::uint32_t from = 0;
  for (std::uint32_t point = 0; point + 1 < near.begin.size(); ++point) {
    const std::uint32_t to = near.begin[point + 1];
    for (; from < to; ++from) {
      if (may_touch(point, model.segments[near.near[from]])) near.near[kept++] = near.near[from];
    }
    near.begin[point + 1] = kept;
  }
  near.near.resize(kept);
}

/// Smallest box that holds the velocities of all points, m/s.
Box velocities(const Model& model, const BodyContact& contact) {
  Box all;
  for (const Box& box : contact.outer.velocities) {
    if (box.low.x > box.high.x) continue;
    all.include(box.low);
    all.include(box.high);
  }
  for (const ObstacleCorner& corner : model.obstacle_corners) all.include(model.obstacles[corner.obstacle].velocity);
  return all;
}

/// Where the points are, a time after t_n, m.
void place_points(const Model& model, const State& state, double after, BodyContact& contact) {
  const std::size_t nodes = model.contact_nodes.size();
  for (std::size_t c = 0; c < nodes; ++c) contact.places[c] = place_after(contact.outer.nodes[c], after);
  // The clock is at the end of the step.
  const double time = state.clock.time.value() - state.clock.last_step + after;
  for (std::size_t k = 0; k < model.obstacle_corners.size(); ++k) {
    const ObstacleCorner& corner = model.obstacle_corners[k];
    contact.places[nodes + k] = corner.place + time * model.obstacles[corner.obstacle].velocity;
  }
}

/// Keeps the list of segments near each point. It has all that were within a margin, and serves until points and
/// segments may have come nearer by as much: no touch is missed, however fast they are.
void keep_list(const Model& model, const State& state, BodyContact& contact) {
  const Clock& clock = state.clock;
  const bool goes_on = contact.listed && clock.step == contact.step + 1;
  contact.moved = length(velocities(model, contact).size()) * clock.last_step;
  contact.travel += contact.moved;
  contact.step = clock.step;
  if (goes_on && contact.travel <= model.contact_margin) return;

  place_points(model, state, 0, contact);
  std::vector<SegmentEnds> segments;
  segments.reserve(model.segments.size());
  for (const Segment& s : model.segments) segments.push_back({contact.places[s.a], contact.places[s.b]});
  contact.near = find_near(contact.places, segments, model.contact_margin + contact.moved);
  drop_own_segments(model, contact.near);
  contact.travel = contact.moved;
  contact.listed = true;
}

/// Looks at every point from `begin` to `end` that is near a boundary or touched one in the last step; `touches` are
/// those of the last step.
template <class Touch>
void find_touches(const Model& model, const State& state, const BodyContact& contact, const std::vector<Touch>& touches,
                  std::size_t begin, std::size_t end, ContactSums& sums, std::vector<Touch>& found) {
  sums = {};
  found.clear();
  TouchSearch search(model, state, contact, sums);
  auto before = std::lower_bound(touches.begin(), touches.end(), begin,
                                 [](const Touch& t, std::size_t point) { return t.point < point; });
  for (auto point = static_cast<std::uint32_t>(begin); point < end; ++point) {
    const std::uint32_t* near = contact.near.near.data() + contact.near.begin[point];
    const std::uint32_t* const near_end = contact.near.near.data() + contact.near.begin[point + 1];
    const auto touched = [&] { return before != touches.end() && before->point == point; };
    while (near != near_end || touched()) {
      std::uint32_t body = near != near_end ? model.segments[*near].body : before->body;
      if (touched()) body = std::min(body, before->body);
      const std::uint32_t* last = near;
      while (last != near_end && model.segments[*last].body == body) ++last;
      const bool lasts = touched() && before->body == body;
      search.look(point, body, near, last, lasts ? &*before : nullptr, found);
      if (lasts) ++before;
      near = last;
    }
  }
}

/// Points in runs of some hundred, which several threads may take: the sums of the runs are added in their order.
void find_touches(const Model& model, State& state, Workspace& work) {
  BodyContact& contact = work.bodies;
  const std::size_t nodes = model.contact_nodes.size();
  const auto find = [&](std::size_t run) {
    TouchRun& to = contact.runs[run];
    const std::size_t begin = run * points_per_run;
    find_touches(model, state, contact, state.touches, begin, std::min(begin + points_per_run, nodes), to.sums,
                 to.found);
  };
  constexpr std::size_t few = 512;  // pairs of a point and a segment: to wake the other threads would take longer
  if (contact.near.near.size() < few) {
    for (std::size_t run = 0; run < contact.runs.size(); ++run) find(run);
  } else {
    work.pool.for_each_block(contact.runs.size(), find);
  }
  // Few in number: one run.
  find_touches(model, state, contact, state.corner_touches, nodes, model.point_count(), contact.sums,
               contact.found_corners);
  std::swap(state.corner_touches, contact.found_corners);
  state.touches.clear();
  for (const TouchRun& run : contact.runs) {
    contact.sums += run.sums;
    state.touches.insert(state.touches.end(), run.found.begin(), run.found.end());
  }
}

/// Sum of the shares |g| of all that moves in a touch, see Model::contact_allowance. `tilt` is its depth over its
/// lever.
double sum_of_shares(const BodyTouch&, double tilt) { return 2 + 2 * tilt; }
/// A corner of an obstacle moves by itself, but it may relieve a node. Its spring changes along the segment: |w'| d / L
/// and |w''| (d / L)^2 / 2 come to w.
double sum_of_shares(const CornerTouch& touch, double tilt) {
  return (1 + 8 * tilt) * (1 + 2 * tilt + (touch.relieves != 0 ? 1 : 0));
}

/// Adds the forces of a touch on its points, and what it adds to the bounds on the frequency there.
template <class Touch>
void push(const Model& model, const Touch& touch, BodyContact& contact) {
  for_each_force(model.segments, touch,
                 [&](std::uint32_t point, const TouchForces& f) { contact.forces[point] += f.total(); });
  const bool rubs = friction_of(model, touch) > 0;
  const double stiffness = rubs ? std::max(touch.stiffness, touch.tangential_stiffness) : touch.stiffness;
  const double dashpot = dashpot_of(model, touch);
  const double tilt = touch.lever > 0 ? touch.springs.penetration / touch.lever : 0;
  const double all = sum_of_shares(touch, tilt);
  const auto add = [&](std::uint32_t point, double share) {
    contact.springs[point] += stiffness * share * all;
    contact.dashpots[point] += dashpot * share * all;
  };
  for (const TouchShare& share : shares_of(model.segments, touch.segment, touch.along)) {
    add(share.point, share.weight + std::fabs(share.couple) * tilt);
  }
  if constexpr (std::is_same_v<Touch, CornerTouch>) {
    if (touch.relieves != 0) add(touch.relieved, 1);
  } else {
    add(touch.point, 1);
  }
}

/// Bound on what touches add to the largest frequency^2, 1/s2, beyond what the elements' bounds allow for, and on what
/// their dashpots add to c, 1/s.
void limit_step(const Model& model, BodyContact& contact) {
  std::size_t rigid = 0;
  for (std::size_t c = 0; c < model.contact_nodes.size(); ++c) {
    if (contact.springs[c] == 0) continue;
    const Index node = model.contact_nodes[c];
    const double inverse_mass = model.inverse_mass[node];
    while (rigid < model.rigid_bodies.size() && model.rigid_bodies[rigid].body < model.contact_bodies[c]) ++rigid;
    if (rigid < model.rigid_bodies.size() && model.rigid_bodies[rigid].body == model.contact_bodies[c]) {
      const double part = model.rigid_bodies[rigid].inverse_mass_at(model.rest[node]);
      const double allowed = model.contact_allowance[c] * model.mass[node];
      contact.rigid_excess[rigid] += part * std::max(0.0, contact.springs[c] - allowed);
      contact.rigid_dashpot[rigid] += part * contact.dashpots[c];
      continue;
    }
    contact.excess = std::max(contact.excess, contact.springs[c] * inverse_mass - model.contact_allowance[c]);
    contact.dashpot = std::max(contact.dashpot, contact.dashpots[c] * inverse_mass);
  }
}

void clear_bounds(BodyContact& contact) {
  contact.excess = contact.dashpot = 0;
  std::fill(contact.rigid_excess.begin(), contact.rigid_excess.end(), 0.0);
  std::fill(contact.rigid_dashpot.begin(), contact.rigid_dashpot.end(), 0.0);
}

}  // namespace

void touch_bodies(const Model& model, State& state, Workspace& work) {
  look_at_outer_nodes(model, state, work);
  BodyContact& contact = work.bodies;
  if (model.segments.empty()) return;
  keep_list(model, state, contact);
  clear_bounds(contact);
  contact.sums = {};
  contact.pushes =
      !contact.near.empty() || !state.touches.empty() || !state.corner_touches.empty() || !model.ties.empty();
  if (!contact.pushes) return;

  place_points(model, state, state.clock.last_step, contact);
  find_touches(model, state, work);
  std::fill(contact.springs.begin(), contact.springs.end(), 0.0);
  std::fill(contact.dashpots.begin(), contact.dashpots.end(), 0.0);
  std::fill(contact.forces.begin(), contact.forces.end(), Vec2{});
  for (const BodyTouch& touch : state.touches) push(model, touch, contact);
  for (const CornerTouch& touch : state.corner_touches) push(model, touch, contact);
  limit_step(model, contact);
  pull_ties(model, contact);
}

}  // namespace udar

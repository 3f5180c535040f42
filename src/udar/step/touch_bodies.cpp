#include <algorithm>
#include <cmath>

#include "udar/contact/search.hpp"
#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

/// Looks for touches of points with boundaries in one step, in the order of points and bodies.
class TouchSearch {
 public:
  TouchSearch(const Model& model, const State& state, BodyContact& contact)
      : model_(model), state_(state), contact_(contact), h_(state.clock.last_step) {}

  /// Touches of a point with the boundary of one body. `near` are its segments near the point.
  void look(std::uint32_t point, std::uint32_t body, const std::uint32_t* near, const std::uint32_t* near_end,
            const BodyTouch* before, std::vector<BodyTouch>& touches) {
    const Vec2 p = contact_.places[point];
    const auto place = [&](std::uint32_t c) { return contact_.places[c]; };
    const Segment& from = model_.segments[model_.segment_from[point]];
    const Vec2 normal = unit(normal_between(model_.segments[from.before], from, place), {});
    if (before != nullptr) {
      press(*before, follow_foot(model_.segments, before->segment, p, normal, place), touches);
      return;
    }
    Foot nearest{.distance = std::numeric_limits<double>::infinity()};
    for (; near != near_end; ++near) {
      if (!faces(model_.segments[*near], normal, place)) continue;
      const Foot foot = foot_on(model_.segments, *near, p, place);
      if (std::fabs(foot.distance) < std::fabs(nearest.distance)) nearest = foot;
    }
    if (nearest.distance >= 0 || -nearest.distance > deepest_first_touch(point)) return;
    nearest = settle_tie(model_.segments, nearest, p, place);
    const double stiffness = model_.touch_stiffness(point, nearest.segment);
    press({.point = point, .body = body, .stiffness = stiffness, .tangential_stiffness = stiffness}, nearest, touches);
  }

 private:
  /// A point that just came in is no deeper than it moved; deeper ones see the far side of their own wall, or a
  /// boundary on which an end was taken for the inside. At the start bodies may rest on their springs.
  [[nodiscard]] double deepest_first_touch(std::uint32_t point) const {
    constexpr double rounding = 1 + 1e-9;
    return state_.clock.step == 0 ? deepest_start * model_.contact_node_sizes[point] : rounding * contact_.moved;
  }

  void press(BodyTouch touch, const Foot& foot, std::vector<BodyTouch>& touches) {
    const BodyPair& settings = model_.body_pair(touch.point, touch.body);
    const SpringState before = touch.springs;
    touch.segment = foot.segment;
    touch.along = foot.along;
    const Vec2 tangent = perpendicular(foot.normal);
    const TouchShares shares = shares_of(model_.segments, touch.segment, touch.along);
    Vec2 move = moved(touch.point);
    Vec2 spread, turn;
    for (const TouchShare& share : shares) {
      move -= share.weight * moved(share.point);
      spread += share.couple * contact_.places[share.point];
      turn += share.couple * moved(share.point);
    }
    // Where a boundary folds back on itself in an end nothing can take up the couple: no friction there.
    constexpr double shortest_lever = 0.1;
    touch.lever = dot(tangent, spread);
    const bool rubs = touch.lever > shortest_lever * model_.contact_node_sizes[shares.begin()->point];
    if (!rubs) touch.lever = 0;
    const double mass = model_.mass[model_.contact_nodes[touch.point]];
    const ContactSprings springs{touch.stiffness, touch.tangential_stiffness, rubs ? settings.friction : 0,
                                 2 * model_.contact.damping * std::sqrt(touch.stiffness * mass)};
    if (rubs) move += (foot.distance / touch.lever * dot(foot.normal, turn)) * tangent;
    // The stick spring goes along from segment to segment, but not round a corner. Let go, its energy is booked.
    constexpr double same_direction = 0.7;
    const bool bends = before.touches != 0 && dot(before.normal, foot.normal) < same_direction;
    const Gap gap{foot.distance, foot.normal, before.face + (bends || !rubs ? 1U : 0U)};
    ContactSums& sums = contact_.sums;
    touch.springs = spring_step(before, gap, move, h_, springs, sums.losses);
    if (touch.springs.touches == 0) return;

    ++sums.touching;
    sums.normal_energy += 0.5 * touch.stiffness * touch.springs.penetration * touch.springs.penetration;
    sums.tangential_energy += tangential_energy(touch.springs, springs);
    sums.largest_penetration =
        std::max(sums.largest_penetration, touch.springs.penetration / model_.contact_node_sizes[touch.point]);
    const double stiffer =
        rubs && settings.friction > 0 ? std::max(springs.normal, springs.tangential) : springs.normal;
    couple(touch, shares, stiffer, springs.dashpot);
    touches.push_back(touch);
  }

  [[nodiscard]] Vec2 moved(std::uint32_t point) const {
    const NodeRecord& r = state_.nodes[model_.contact_nodes[point]];
    return {h_ * r.vx, h_ * r.vy};
  }

  /// What the touch adds to the bounds on the frequency at its points, see Model::contact_allowance: k |g| (sum of all
  /// |g|), with g the share of a point.
  void couple(const BodyTouch& touch, const TouchShares& shares, double stiffness, double dashpot) {
    const double tilt = touch.lever > 0 ? touch.springs.penetration / touch.lever : 0;
    const double all = 2 + 2 * tilt;
    const auto add = [&](std::uint32_t point, double share) {
      contact_.springs[point] += stiffness * share * all;
      contact_.dashpots[point] += dashpot * share * all;
    };
    add(touch.point, 1);
    for (const TouchShare& share : shares) add(share.point, share.weight + std::fabs(share.couple) * tilt);
  }

  const Model& model_;
  const State& state_;
  BodyContact& contact_;
  double h_;
};

/// A point is never near the segments that it ends, nor those of a body that its own is not to touch.
void drop_own_segments(const Model& model, Neighbours& near) {
  std::uint32_t kept = 0;
  std::uint32_t from = 0;
  for (std::uint32_t point = 0; point + 1 < near.begin.size(); ++point) {
    const std::uint32_t to = near.begin[point + 1];
    for (; from < to; ++from) {
      const Segment& s = model.segments[near.near[from]];
      if (s.a == point || s.b == point || !model.body_pair(point, s.body).touch) continue;
      near.near[kept++] = near.near[from];
    }
    near.begin[point + 1] = kept;
  }
  near.near.resize(kept);
}

/// Smallest box that holds the velocities of all contact nodes, m/s. Within the sweep every block notes those of its
/// own nodes; a state that the workspace does not come from is looked at as a whole.
Box velocities(const Model& model, const State& state, const BodyContact& contact, bool goes_on) {
  Box all;
  if (goes_on) {
    for (const Box& box : contact.velocities) {
      if (box.low.x > box.high.x) continue;
      all.include(box.low);
      all.include(box.high);
    }
  } else {
    for (const Index node : model.contact_nodes) all.include({state.nodes[node].vx, state.nodes[node].vy});
  }
  return all;
}

/// Keeps the list of segments near each point. It has all that were within a margin, and serves until points and
/// segments may have come nearer by as much: no touch is missed, however fast they are.
void keep_list(const Model& model, const State& state, BodyContact& contact) {
  const Clock& clock = state.clock;
  const bool goes_on = contact.listed && clock.step == contact.step + 1;
  contact.moved = length(velocities(model, state, contact, goes_on).size()) * clock.last_step;
  contact.travel += contact.moved;
  contact.step = clock.step;
  if (goes_on && contact.travel <= model.contact_margin) return;

  std::vector<Vec2> points;
  points.reserve(model.contact_nodes.size());
  for (const Index node : model.contact_nodes) points.push_back({state.nodes[node].x, state.nodes[node].y});
  std::vector<SegmentEnds> segments;
  segments.reserve(model.segments.size());
  for (const Segment& s : model.segments) segments.push_back({points[s.a], points[s.b]});
  contact.near = find_near(points, segments, model.contact_margin + contact.moved);
  drop_own_segments(model, contact.near);
  contact.travel = contact.moved;
  contact.listed = true;
}

/// Looks at every point that is near a boundary or touched one.
void find_touches(const Model& model, const State& state, BodyContact& contact, std::vector<BodyTouch>& found) {
  TouchSearch search(model, state, contact);
  auto before = state.touches.begin();
  for (std::uint32_t point = 0; point < model.contact_nodes.size(); ++point) {
    const std::uint32_t* near = contact.near.near.data() + contact.near.begin[point];
    const std::uint32_t* const near_end = contact.near.near.data() + contact.near.begin[point + 1];
    const auto touched = [&] { return before != state.touches.end() && before->point == point; };
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

/// Bound on what touches add to the largest frequency^2, 1/s2, beyond what the elements' bounds allow for, and on what
/// their dashpots add to c, 1/s.
void limit_step(const Model& model, BodyContact& contact) {
  contact.excess = 0;
  contact.dashpot = 0;
  std::fill(contact.rigid_excess.begin(), contact.rigid_excess.end(), 0.0);
  std::fill(contact.rigid_dashpot.begin(), contact.rigid_dashpot.end(), 0.0);
  std::size_t rigid = 0;
  for (std::size_t c = 0; c < model.contact_nodes.size(); ++c) {
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

}  // namespace

void touch_bodies(const Model& model, State& state, Workspace& work) {
  BodyContact& contact = work.bodies;
  if (model.segments.empty()) return;
  keep_list(model, state, contact);
  contact.sums = {};
  contact.pushes = !contact.near.empty() || !state.touches.empty();
  if (!contact.pushes) {
    contact.excess = contact.dashpot = 0;
    std::fill(contact.rigid_excess.begin(), contact.rigid_excess.end(), 0.0);
    std::fill(contact.rigid_dashpot.begin(), contact.rigid_dashpot.end(), 0.0);
    return;
  }
  for (std::size_t c = 0; c < model.contact_nodes.size(); ++c) {
    contact.places[c] = place_after(state.nodes[model.contact_nodes[c]], state.clock.last_step);
  }
  std::fill(contact.springs.begin(), contact.springs.end(), 0.0);
  std::fill(contact.dashpots.begin(), contact.dashpots.end(), 0.0);
  contact.found.clear();
  find_touches(model, state, contact, contact.found);
  std::swap(state.touches, contact.found);
  limit_step(model, contact);

  std::fill(contact.forces.begin(), contact.forces.end(), Vec2{});
  for (const BodyTouch& touch : state.touches) {
    for_each_force(model.segments, touch,
                   [&](std::uint32_t point, const TouchForces& f) { contact.forces[point] += f.total(); });
  }
}

}  // namespace udar

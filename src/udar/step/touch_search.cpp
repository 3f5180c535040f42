#include "udar/step/touch_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "udar/step/stages.hpp"

namespace udar {
namespace {

/// Is the line that a segment lies on farther from a point than `reach`? Without a root or a division, since nearly
/// all are.
bool is_far(Vec2 a, Vec2 b, Vec2 p, double reach) {
  const Vec2 along = b - a;
  const double area = cross(along, p - a);
  return area * area > reach * reach * dot(along, along);
}

/// Mass whose critical damping a dashpot is measured by, kg: that of the point, or of the boundary where the point is
/// a corner of an obstacle.
double mass_at(const Model& model, const BodyTouch& touch) {
  if (!model.is_obstacle_corner(touch.point)) return model.mass[model.contact_nodes[touch.point]];
  const Segment& s = model.segments[touch.segment];
  return (1 - touch.along) * model.mass[model.contact_nodes[s.a]] + touch.along * model.mass[model.contact_nodes[s.b]];
}

}  // namespace

double dashpot_of(const Model& model, const BodyTouch& touch) {
  return 2 * model.contact.damping * std::sqrt(touch.stiffness * mass_at(model, touch));
}

double friction_of(const Model& model, const BodyTouch& touch) {
  if (touch.lever == 0) return 0;
  if (model.is_obstacle_corner(touch.point)) return model.obstacle_of(touch.point).friction;
  return model.body_pair(touch.point, touch.body).friction;
}

/// A touch and its foot: that of the last step goes on from there, another one may begin. False where there is none.
template <class Touch>
bool TouchSearch::find(std::uint32_t point, std::uint32_t body, const std::uint32_t* near,
                       const std::uint32_t* near_end, const Touch* before, Touch& touch, Foot& foot) const {
  const Vec2 p = contact_.places[point];
  if (before != nullptr) {
    touch = *before;
    foot = follow_foot(model_.segments, before->segment, p, normal_of(point), place());
    return true;
  }
  const Foot nearest = nearest_foot(point, near, near_end);
  if (nearest.distance >= 0 || -nearest.distance > deepest_first_touch(point, nearest.segment)) return false;
  const TouchStiffness k = model_.touch_stiffness(point, nearest.segment, nearest.along);
  touch.point = point;
  touch.body = body;
  touch.stiffness = k.normal;
  touch.tangential_stiffness = k.tangential;
  foot = settle_tie(model_.segments, nearest, p, place());
  return true;
}

void TouchSearch::look(std::uint32_t point, std::uint32_t body, const std::uint32_t* near,
                       const std::uint32_t* near_end, const BodyTouch* before, std::vector<BodyTouch>& touches) {
  BodyTouch touch;
  Foot foot;
  if (!find(point, body, near, near_end, before, touch, foot) || !press(touch, foot, touch.stiffness)) return;
  enter(touch, 0.5 * touch.stiffness * touch.springs.penetration * touch.springs.penetration);
  touches.push_back(touch);
}

void TouchSearch::look(std::uint32_t point, std::uint32_t body, const std::uint32_t* near,
                       const std::uint32_t* near_end, const CornerTouch* before, std::vector<CornerTouch>& touches) {
  CornerTouch touch;
  Foot foot;
  if (!find(point, body, near, near_end, before, touch, foot)) return;
  touch.segment = foot.segment;
  touch.along = foot.along;
  const Gap end = deeper_end(touch, touch.relieved);
  const double beyond = std::max(0.0, -foot.distance - std::max(0.0, -end.distance));
  const double k = corner_weight(foot.along) * touch.stiffness;
  // So that stiffness times depth is the force.
  if (!press(touch, foot, foot.distance < 0 ? k * beyond / -foot.distance : 0)) return;
  touch.relieves = beyond > 0 && end.distance < 0 ? 1 : 0;
  touch.relief = touch.relieves != 0 ? (-k * beyond) * end.normal : Vec2{};
  if (touch.lever > 0) {
    const double slope = corner_weight_slope(touch.along) * touch.stiffness;
    const double drag = 0.5 * slope * beyond * beyond / touch.lever;
    touch.springs.friction_force -= drag * perpendicular(foot.normal);
  }
  enter(touch, 0.5 * k * beyond * beyond);
  touches.push_back(touch);
}

/// Of the ends of the segment that a corner digs into, the one that is deeper in its obstacle, and how deep.
Gap TouchSearch::deeper_end(const CornerTouch& touch, std::uint32_t& point) const {
  const Obstacle& obstacle = model_.obstacle_of(touch.point);
  const Vec2 moved = state_.clock.time.value() * obstacle.velocity;
  const Segment& s = model_.segments[touch.segment];
  const Gap a = gap(obstacle.prepared, contact_.places[s.a] - moved);
  const Gap b = gap(obstacle.prepared, contact_.places[s.b] - moved);
  point = a.distance <= b.distance ? s.a : s.b;
  return a.distance <= b.distance ? a : b;
}

/// Direction out of its own body or obstacle at a point.
Vec2 TouchSearch::normal_of(std::uint32_t point) const {
  if (model_.is_obstacle_corner(point)) return model_.corner_of(point).normal;
  const Segment& from = model_.segments[model_.segment_from[point]];
  return unit(normal_between(model_.segments[from.before], from, place()), {});
}

/// What penetrations are measured by, m: the stretch of boundary at the point, or at a corner of an obstacle the
/// segment.
double TouchSearch::size_at(std::uint32_t point, std::uint32_t segment) const {
  if (!model_.is_obstacle_corner(point)) return model_.contact_node_sizes[point];
  return model_.contact_node_sizes[model_.segments[segment].a];
}

/// A point that just came in is no deeper than it moved; deeper ones see the far side of their own wall, or a
/// boundary on which an end was taken for the inside. At the start bodies may rest on their springs.
double TouchSearch::deepest_first_touch(std::uint32_t point, std::uint32_t segment) const {
  constexpr double rounding = 1 + 1e-9;
  return state_.clock.step == 0 ? deepest_start * size_at(point, segment) : rounding * contact_.moved;
}

/// Of the segments that can push the point, and are near enough for a first touch. Its distance is infinite where
/// there is none.
Foot TouchSearch::nearest_foot(std::uint32_t point, const std::uint32_t* near, const std::uint32_t* near_end) const {
  const Vec2 p = contact_.places[point];
  Foot nearest{.distance = std::numeric_limits<double>::infinity()};
  Vec2 normal;
  bool known = false;
  for (; near != near_end; ++near) {
    const Segment& segment = model_.segments[*near];
    const Vec2 a = contact_.places[segment.a];
    if (is_far(a, contact_.places[segment.b], p, deepest_first_touch(point, *near))) continue;
    if (!known) normal = normal_of(point);
    known = true;
    if (!faces(segment, normal, place())) continue;
    const Foot foot = foot_on(model_.segments, *near, p, place());
    if (std::fabs(foot.distance) < std::fabs(nearest.distance)) nearest = foot;
  }
  return nearest;
}

Vec2 TouchSearch::moved(std::uint32_t point) const {
  if (model_.is_obstacle_corner(point)) return h_ * model_.obstacle_of(point).velocity;
  const NodeRecord& r = contact_.outer.nodes[point];
  return {h_ * r.vx, h_ * r.vy};
}

/// Motion of the point relative to the boundary in the step, conjugate to the forces of the touch, m. Sets the lever
/// of its couple.
Vec2 TouchSearch::slip_of(BodyTouch& touch, const Foot& foot) const {
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
  if (!(touch.lever > shortest_lever * model_.contact_node_sizes[shares.begin()->point])) touch.lever = 0;
  if (touch.lever > 0) move += (foot.distance / touch.lever * dot(foot.normal, turn)) * tangent;
  return move;
}

/// The springs of a touch with its foot where it is now, their normal one of `stiffness` (N/m). False where they are
/// apart.
bool TouchSearch::press(BodyTouch& touch, const Foot& foot, double stiffness) {
  const SpringState before = touch.springs;
  touch.segment = foot.segment;
  touch.along = foot.along;
  const Vec2 move = slip_of(touch, foot);
  // The stick spring goes along from segment to segment, but not round a corner. Let go, its energy is booked.
  constexpr double same_direction = 0.7;
  const bool bends = before.touches != 0 && dot(before.normal, foot.normal) < same_direction;
  const Gap gap{foot.distance, foot.normal, before.face + (bends || touch.lever == 0 ? 1U : 0U)};
  const ContactSprings springs{stiffness, touch.tangential_stiffness, friction_of(model_, touch),
                               dashpot_of(model_, touch)};
  touch.springs = spring_step(before, gap, move, h_, springs, sums_.losses);
  return touch.springs.touches != 0;
}

/// Enters a touch in the sums.
void TouchSearch::enter(const BodyTouch& touch, double normal_energy) {
  ++sums_.touching;
  sums_.normal_energy += normal_energy;
  sums_.tangential_energy += 0.5 * touch.tangential_stiffness * touch.springs.slip * touch.springs.slip;
  sums_.largest_penetration =
      std::max(sums_.largest_penetration, touch.springs.penetration / size_at(touch.point, touch.segment));
}

}  // namespace udar

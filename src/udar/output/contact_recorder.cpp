#include "udar/output/contact_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "udar/base/archive.hpp"

namespace udar {
namespace {

/// Gaps shorter than this part of the whole contact do not part episodes.
constexpr double shortest_gap = 0.02;

/// From the first touch until `part` of the final impulse has been given, s.
double time_of_part(const std::vector<double>& time, const std::vector<Vec2>& impulse, double part) {
  const double wanted = part * length(impulse.back());
  std::size_t k = impulse.size() - 1;
  while (k > 0 && length(impulse[k - 1]) >= wanted) --k;
  return time[k];
}

/// Of a force, in the coming half and the last half of a step, N s.
double impulse_of(Vec2 force, const Clock& clock) { return 0.5 * (clock.last_step + clock.next_step) * length(force); }

/// What presses a node, N s.
double normal_impulse(const SpringState& springs, const Clock& clock) {
  return impulse_of(springs.normal_force + springs.damping_force, clock);
}

}  // namespace

ContactRecorder::ContactRecorder(const Model& model) : model_(model), now_(model.bodies.size()) {
  for (const Obstacle& obstacle : model.obstacles) {
    obstacles_.push_back({.obstacle = &obstacle, .touches = {}, .curve = {}});
  }
  for (const Body& body : model.bodies) {
    BodyNow& start = last_.emplace_back();
    Vec2 position;
    for (Index i = body.node_begin; i < body.node_end; ++i) {
      const Vec2 momentum = model.mass[i] * model.start_velocity[i];
      position += model.mass[i] * model.rest[i];
      start.motion.momentum += momentum;
      start.motion.spin += cross(model.rest[i], momentum);
    }
    start.centre = (1 / body.mass) * position;
    start.motion.spin -= cross(start.centre, start.motion.momentum);
    double& inertia = inertia_.emplace_back();
    for (Index i = body.node_begin; i < body.node_end; ++i) {
      const Vec2 arm = model.rest[i] - start.centre;
      inertia += model.mass[i] * dot(arm, arm);
    }
  }
}

void ContactRecorder::look_at_bodies(const State& state) {
  for (std::size_t b = 0; b < now_.size(); ++b) {
    const Vec2 centre = (1 / model_.bodies[b].mass) * state.body_sums[b].position;
    const Vec2 momentum = state.body_momentum[b];
    now_[b] = {centre, {momentum, state.body_spin[b] - cross(centre, momentum)}};
  }
}

void ContactRecorder::record(const State& state) {
  look_at_bodies(state);
  for (std::size_t o = 0; o < obstacles_.size(); ++o) {
    follow(obstacles_[o], state.obstacles[o], state);
    if (state.obstacles[o].touching > 0) press_obstacle(o, state);
  }
  press_corners(state);
  auto partners = pairs_.begin();
  for (const PairBook& pair : state.pairs) {
    while (partners != pairs_.end() && bodies_of(*partners) < bodies_of(pair)) ++partners;
    if (partners == pairs_.end() || bodies_of(*partners) != bodies_of(pair)) {
      partners = pairs_.insert(partners, {.first = pair.first, .second = pair.second, .touches = {}, .curve = {}});
    }
    follow(*partners, pair.book, state);
  }
  press_bodies(state);
  std::swap(last_, now_);
}

void ContactRecorder::follow(Partners& partners, const ContactBook& book, const State& state) {
  const double time = state.clock.time.value();
  const bool lasts = !partners.touches.empty() && !partners.touches.back().over;
  if (!lasts && book.touching == 0) return;
  if (!lasts) begin_touch(partners, time);

  Touch& touch = partners.touches.back();
  touch.end = time;
  for (Toucher& t : touch.touchers) {
    if (t.touches) t.after = now_[t.body].motion;
    t.touches = false;
  }
  if (book.touching == 0) {
    touch.over = true;
    return;
  }
  touch.impulse_after = book.total.impulse();
  touch.normal_after = book.normal.impulse();
  touch.peak_force = std::max(touch.peak_force, length(book.total.force));
  draw(partners.curve, touch, state.clock.step);
}

/// Bodies that rattle touch very often. A gap that is short against what has passed is short against the whole: it is
/// closed at once, so that there are never more touches than gaps of 2 % have room for.
void ContactRecorder::begin_touch(Partners& partners, double time) {
  auto& touches = partners.touches;
  if (!touches.empty() && time - touches.back().end < shortest_gap * (time - touches.front().begin)) {
    touches.back().over = false;
    ++partners.merged_gaps;
    return;
  }
  touches.push_back({.begin = time,
                     .impulse_before = touches.empty() ? Vec2{} : touches.back().impulse_after,
                     .normal_before = touches.empty() ? Vec2{} : touches.back().normal_after,
                     .touchers = {}});
  if (partners.obstacle != nullptr) return;  // its touchers come one by one
  toucher(touches.back(), partners.first);
  toucher(touches.back(), partners.second);
}

ContactRecorder::Toucher& ContactRecorder::toucher(Touch& touch, Index body) const {
  auto& all = touch.touchers;
  const auto found =
      std::lower_bound(all.begin(), all.end(), body, [](const Toucher& t, Index wanted) { return t.body < wanted; });
  if (found != all.end() && found->body == body) return *found;
  const Motion before = last_[body].motion;
  return *all.insert(found, {.body = body, .before = before, .after = before});
}

void ContactRecorder::press(Touch& touch, Index body, Vec2 place, double impulse) {
  Toucher& t = toucher(touch, body);
  t.touches = true;
  t.after = now_[body].motion;
  t.pressed += impulse;
  t.arm += impulse * (place - now_[body].centre);
}

void ContactRecorder::press_obstacle(std::size_t obstacle, const State& state) {
  const SpringState* const springs = state.contacts.data() + obstacle * model_.contact_nodes.size();
  for (std::size_t c = 0; c < model_.contact_nodes.size(); ++c) {
    if (springs[c].touches == 0) continue;
    press(obstacles_[obstacle].touches.back(), model_.contact_bodies[c], place(state, model_.contact_nodes[c]),
          normal_impulse(springs[c], state.clock));
  }
}

/// A corner presses where it stands. The end of the segment that it relieves has a spring of its own, which is
/// entered whole: what is taken off again counts against it, in the place of that end.
void ContactRecorder::press_corners(const State& state) {
  for (const CornerTouch& corner : state.corner_touches) {
    const std::uint32_t number = model_.corner_of(corner.point).obstacle;
    Touch& touch = obstacles_[number].touches.back();
    const Vec2 where =
        model_.corner_of(corner.point).place + state.clock.time.value() * model_.obstacles[number].velocity;
    press(touch, corner.body, where, normal_impulse(corner.springs, state.clock));
    if (corner.relieves == 0) continue;
    const Vec2 end = place(state, model_.contact_nodes[corner.relieved]);
    press(touch, corner.body, end, -impulse_of(corner.relief, state.clock));
  }
}

void ContactRecorder::press_bodies(const State& state) {
  Partners* partners = nullptr;
  for (const BodyTouch& touch : state.touches) {
    const BodyNumbers bodies = in_order(model_.contact_bodies[touch.point], touch.body);
    if (partners == nullptr || bodies_of(*partners) != bodies) partners = entry_of(pairs_, bodies);
    const Vec2 where = place(state, model_.contact_nodes[touch.point]);
    const double impulse = normal_impulse(touch.springs, state.clock);
    press(partners->touches.back(), bodies.first, where, impulse);
    if (bodies.second != bodies.first) press(partners->touches.back(), bodies.second, where, impulse);
  }
}

/// A point of the curve, and half as many of all where they are too many: a thousand points of each of very many
/// partners would take more memory than the run.
void ContactRecorder::draw(Curve& curve, const Touch& touch, std::uint64_t step) const {
  constexpr std::size_t most = 1 << 16;
  constexpr std::size_t fewest = 1 << 9;
  constexpr std::size_t points_of_all = 1 << 20;
  const std::size_t room = std::clamp(points_of_all / (obstacles_.size() + pairs_.size()), fewest, most);
  if (step % curve.every != 0) return;
  curve.time.push_back(touch.end);
  curve.impulse.push_back(touch.impulse_after);
  if (curve.time.size() < room) return;
  for (std::size_t k = 0; 2 * k < curve.time.size(); ++k) {
    curve.time[k] = curve.time[2 * k];
    curve.impulse[k] = curve.impulse[2 * k];
  }
  curve.time.resize((curve.time.size() + 1) / 2);
  curve.impulse.resize((curve.impulse.size() + 1) / 2);
  curve.every *= 2;
}

/// Makes one touch of two that follow each other.
void ContactRecorder::join(Touch& touch, const Touch& next) {
  touch.end = next.end;
  touch.over = next.over;
  touch.impulse_after = next.impulse_after;
  touch.normal_after = next.normal_after;
  touch.peak_force = std::max(touch.peak_force, next.peak_force);
  std::vector<Toucher> all;
  auto one = touch.touchers.begin();
  for (const Toucher& other : next.touchers) {
    while (one != touch.touchers.end() && one->body < other.body) all.push_back(*one++);
    Toucher& both = all.emplace_back(other);
    if (one == touch.touchers.end() || one->body != other.body) continue;
    both.before = one->before;
    both.pressed += one->pressed;
    both.arm += one->arm;
    ++one;
  }
  all.insert(all.end(), one, touch.touchers.end());
  touch.touchers = std::move(all);
}

/// Of a rigid body with this momentum and spin, at the mean place of contact, m/s. The arm is a mean of arms, weighted
/// with the normal impulses, so that a body may go a long way while it touches.
Vec2 ContactRecorder::velocity_at_contact(const Toucher& toucher, const Motion& motion) const {
  const Vec2 arm = (1 / toucher.pressed) * toucher.arm;
  return (1 / model_.bodies[toucher.body].mass) * motion.momentum +
         (motion.spin / inertia_[toucher.body]) * perpendicular(arm);
}

/// Spins, and the velocity along the boundary where that of two partners exists: of one body against an obstacle or
/// another body.
void ContactRecorder::add_rotation(const Partners& partners, const Touch& touch, EpisodeSummary& e) const {
  for (const Toucher& t : touch.touchers) {
    e.spin_before[model_.bodies[t.body].name] = t.before.spin;
    e.spin_after[model_.bodies[t.body].name] = t.after.spin;
  }
  const Vec2 push = touch.normal_after - touch.normal_before;
  const Toucher& first = touch.touchers.front();
  const Toucher& second = touch.touchers.back();
  const bool one_body = touch.touchers.size() == 1;
  if (one_body != (partners.obstacle != nullptr) || !(first.pressed > 0) || !(length(push) > 0)) return;
  const auto relative = [&](bool after) {
    const Vec2 velocity = velocity_at_contact(first, after ? first.after : first.before);
    if (partners.obstacle != nullptr) return velocity - partners.obstacle->velocity;
    return velocity - velocity_at_contact(second, after ? second.after : second.before);
  };
  const Vec2 tangent = (1 / length(push)) * perpendicular(push);
  const Vec2 before = relative(false);
  e.slip_velocity_before = dot(before, tangent);
  e.slip_velocity_after = dot(relative(true), tangent);
  // Less than this of the whole is a head-on impact and what rounding and the mesh make of it.
  constexpr double nothing = 1e-6;
  if (touch.over && std::fabs(e.slip_velocity_before) > nothing * length(before)) {
    e.tangential_restitution = -e.slip_velocity_after / e.slip_velocity_before;
  }
}

EpisodeSummary ContactRecorder::episode(const Partners& partners, const Touch& touch) const {
  EpisodeSummary e{.first_touch = touch.begin,
                   .separation = touch.over ? touch.end : no_number,
                   .duration = touch.end - touch.begin,
                   .impulse = touch.impulse_after - touch.impulse_before,
                   .peak_force = touch.peak_force};
  Vec2 moving;
  if (partners.obstacle == nullptr) {
    const Toucher& first = touch.touchers.front();
    const Toucher& second = touch.touchers.back();
    const double a = 1 / model_.bodies[first.body].mass;
    const double b = 1 / model_.bodies[second.body].mass;
    e.velocity_before = a * first.before.momentum - b * second.before.momentum;
    e.velocity_after = a * first.after.momentum - b * second.after.momentum;
  } else {
    double mass = 0;
    Vec2 before;
    Vec2 after;
    for (const Toucher& t : touch.touchers) {
      mass += model_.bodies[t.body].mass;
      before += t.before.momentum;
      after += t.after.momentum;
    }
    e.velocity_before = (1 / mass) * before;
    e.velocity_after = (1 / mass) * after;
    moving = partners.obstacle->velocity;
  }
  // Along the impulse of the normal forces: the direction of the push.
  const Vec2 push = touch.normal_after - touch.normal_before;
  const double towards = -dot(e.velocity_before - moving, push);
  if (touch.over && towards > 0) e.restitution = dot(e.velocity_after - moving, push) / towards;
  add_rotation(partners, touch, e);
  return e;
}

ContactSummary ContactRecorder::summary_of(const Partners& partners) const {
  const auto& touches = partners.touches;
  ContactSummary s;
  if (touches.empty()) return s;
  s.first_touch = touches.front().begin;
  if (touches.back().over) s.last_separation = touches.back().end;
  s.duration = touches.back().end - s.first_touch;
  s.impulse = touches.back().impulse_after;
  s.merged_gaps = partners.merged_gaps;
  if (!partners.curve.time.empty()) {
    auto time = partners.curve.time;
    auto impulse = partners.curve.impulse;
    time.push_back(touches.back().end);
    impulse.push_back(s.impulse);
    s.duration_99 = time_of_part(time, impulse, 0.99) - s.first_touch;
  }
  for (std::size_t k = 0; k < touches.size();) {
    Touch whole = touches[k++];
    while (k < touches.size() && touches[k].begin - whole.end < shortest_gap * s.duration) {
      join(whole, touches[k++]);
      ++s.merged_gaps;
    }
    s.peak_force = s.episodes.empty() ? whole.peak_force : std::max(s.peak_force, whole.peak_force);
    s.episodes.push_back(episode(partners, whole));
  }
  return s;
}

template <class Archive>
void ContactRecorder::carry(Archive& archive) {
  for (Partners& partners : obstacles_) archive(partners);
  archive(pairs_);
  for (BodyNow& body : last_) archive(body);
  if constexpr (Archive::reads) {
    for (const Partners& partners : obstacles_) check(partners);
    for (const Partners& partners : pairs_) check(partners);
    const auto in_order = [](const Partners& a, const Partners& b) { return bodies_of(a) < bodies_of(b); };
    if (std::adjacent_find(pairs_.begin(), pairs_.end(), std::not_fn(in_order)) != pairs_.end()) {
      throw OutputError("its touches of bodies are out of order");
    }
  }
}
template void ContactRecorder::carry(BytesOut&);
template void ContactRecorder::carry(BytesIn&);

/// Refuses what came from a file and does not fit the model.
void ContactRecorder::check(const Partners& partners) const {
  const std::size_t bodies = model_.bodies.size();
  bool fits = partners.curve.every > 0 && partners.curve.time.size() == partners.curve.impulse.size();
  fits = fits && partners.first <= partners.second && partners.second < bodies;
  for (const Touch& touch : partners.touches) {
    const auto& all = touch.touchers;
    fits =
        fits && !all.empty() && std::all_of(all.begin(), all.end(), [=](const Toucher& t) { return t.body < bodies; });
  }
  if (!fits) throw OutputError("its touches do not fit the case");
}

std::map<std::string, ContactSummary> ContactRecorder::summary() const {
  std::map<std::string, ContactSummary> all;
  // Obstacles that nobody struck are named, bodies that did not meet are not: there are too many pairs.
  for (const Partners& partners : obstacles_) all[partners.obstacle->name] = summary_of(partners);
  for (const Partners& partners : pairs_) {
    if (partners.touches.empty()) continue;
    all[model_.bodies[partners.first].name + "/" + model_.bodies[partners.second].name] = summary_of(partners);
  }
  return all;
}

}  // namespace udar

#include "udar/output/contact_recorder.hpp"

#include <algorithm>

namespace udar {
namespace {

/// From the first touch until `part` of the final impulse has been given, s.
double time_of_part(const std::vector<double>& time, const std::vector<Vec2>& impulse, double part) {
  const double wanted = part * length(impulse.back());
  std::size_t k = impulse.size() - 1;
  while (k > 0 && length(impulse[k - 1]) >= wanted) --k;
  return time[k];
}

}  // namespace

ContactRecorder::ContactRecorder(const Model& model)
    : model_(model), touches_(model.obstacles.size()), curves_(model.obstacles.size()) {
  for (const Index node : model.contact_nodes) {
    body_of_contact_node_.push_back(static_cast<Index>(&model.body_of_node(node) - model.bodies.data()));
  }
  for (const Body& body : model.bodies) {
    Vec2& start = last_momentum_.emplace_back();
    for (Index i = body.node_begin; i < body.node_end; ++i) start += model.mass[i] * model.start_velocity[i];
  }
}

void ContactRecorder::record(const State& state) {
  for (std::size_t o = 0; o < model_.obstacles.size(); ++o) {
    auto& touches = touches_[o];
    const bool lasts = !touches.empty() && !touches.back().over;
    const double time = state.clock.time.value();
    if (state.obstacles[o].touching > 0) {
      if (!lasts) {
        touches.push_back({.begin = time,
                           .impulse_before = touches.empty() ? Vec2{} : touches.back().impulse_after,
                           .normal_before = touches.empty() ? Vec2{} : touches.back().normal_after,
                           .momentum_before = last_momentum_,
                           .touched = std::vector<bool>(model_.bodies.size())});
      }
      touch_step(o, state);
    } else if (lasts) {
      touches.back().end = time;
      touches.back().over = true;
      touches.back().momentum_after = state.body_momentum;
    }
  }
  last_momentum_ = state.body_momentum;
}

void ContactRecorder::touch_step(std::size_t obstacle, const State& state) {
  const ObstacleBook& book = state.obstacles[obstacle];
  Touch& touch = touches_[obstacle].back();
  touch.end = state.clock.time.value();
  touch.impulse_after = book.total.impulse();
  touch.normal_after = book.normal.impulse();
  touch.peak_force = std::max(touch.peak_force, length(book.total.force));
  touch.momentum_after = state.body_momentum;
  const std::size_t first = obstacle * model_.contact_nodes.size();
  for (std::size_t c = 0; c < model_.contact_nodes.size(); ++c) {
    if (state.contacts[first + c].touches != 0) touch.touched[body_of_contact_node_[c]] = true;
  }

  constexpr std::size_t most_points = 1 << 16;
  Curve& curve = curves_[obstacle];
  if (state.clock.step % curve.every != 0) return;
  curve.time.push_back(touch.end);
  curve.impulse.push_back(touch.impulse_after);
  if (curve.time.size() < most_points) return;
  for (std::size_t k = 0; 2 * k < curve.time.size(); ++k) {
    curve.time[k] = curve.time[2 * k];
    curve.impulse[k] = curve.impulse[2 * k];
  }
  curve.time.resize(curve.time.size() / 2);
  curve.impulse.resize(curve.impulse.size() / 2);
  curve.every *= 2;
}

EpisodeSummary ContactRecorder::episode(std::size_t obstacle, const Touch& first, const Touch& last, double peak,
                                        const std::vector<bool>& touched) const {
  EpisodeSummary e{.first_touch = first.begin,
                   .separation = last.over ? last.end : no_number,
                   .duration = last.end - first.begin,
                   .impulse = last.impulse_after - first.impulse_before,
                   .peak_force = peak};
  double mass = 0;
  Vec2 before;
  Vec2 after;
  for (std::size_t b = 0; b < touched.size(); ++b) {
    if (!touched[b]) continue;
    mass += model_.bodies[b].mass;
    before += first.momentum_before[b];
    after += last.momentum_after[b];
  }
  e.velocity_before = (1 / mass) * before;
  e.velocity_after = (1 / mass) * after;
  // Along the impulse of the normal forces: the direction in which the obstacle pushed.
  const Vec2 push = last.normal_after - first.normal_before;
  const Vec2 moving = model_.obstacles[obstacle].velocity;
  const double towards = -dot(e.velocity_before - moving, push);
  if (last.over && towards > 0) e.restitution = dot(e.velocity_after - moving, push) / towards;
  return e;
}

ContactSummary ContactRecorder::summary_of(std::size_t obstacle) const {
  const auto& touches = touches_[obstacle];
  ContactSummary s;
  if (touches.empty()) return s;
  s.first_touch = touches.front().begin;
  if (touches.back().over) s.last_separation = touches.back().end;
  s.duration = touches.back().end - s.first_touch;
  s.impulse = touches.back().impulse_after;
  if (!curves_[obstacle].time.empty()) {
    auto time = curves_[obstacle].time;
    auto impulse = curves_[obstacle].impulse;
    time.push_back(touches.back().end);
    impulse.push_back(s.impulse);
    s.duration_99 = time_of_part(time, impulse, 0.99) - s.first_touch;
  }
  const double shortest_gap = 0.02 * s.duration;
  for (std::size_t k = 0; k < touches.size();) {
    std::size_t last = k;
    double peak = touches[k].peak_force;
    std::vector<bool> touched = touches[k].touched;
    while (last + 1 < touches.size() && touches[last + 1].begin - touches[last].end < shortest_gap) {
      ++last;
      ++s.merged_gaps;
      peak = std::max(peak, touches[last].peak_force);
      for (std::size_t b = 0; b < touched.size(); ++b) touched[b] = touched[b] || touches[last].touched[b];
    }
    s.peak_force = k == 0 ? peak : std::max(s.peak_force, peak);
    s.episodes.push_back(episode(obstacle, touches[k], touches[last], peak, touched));
    k = last + 1;
  }
  return s;
}

std::map<std::string, ContactSummary> ContactRecorder::summary() const {
  std::map<std::string, ContactSummary> all;
  for (std::size_t o = 0; o < model_.obstacles.size(); ++o) all[model_.obstacles[o].name] = summary_of(o);
  return all;
}

}  // namespace udar

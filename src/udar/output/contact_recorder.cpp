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

ContactRecorder::ContactRecorder(const Model& model) : model_(model) {
  for (std::size_t o = 0; o < model.obstacles.size(); ++o) {
    partners_.push_back({.name = model.obstacles[o].name, .book = o, .touches = {}, .curve = {}});
  }
  for (std::size_t second = 0; second < model.bodies.size() && !model.segments.empty(); ++second) {
    for (std::size_t first = 0; first <= second; ++first) {
      partners_.push_back({.name = model.bodies[first].name + "/" + model.bodies[second].name,
                           .book = pair_number(first, second),
                           .two_bodies = true,
                           .first = first,
                           .second = second,
                           .touches = {},
                           .curve = {}});
    }
  }
  for (const Body& body : model.bodies) {
    Vec2& start = last_momentum_.emplace_back();
    for (Index i = body.node_begin; i < body.node_end; ++i) start += model.mass[i] * model.start_velocity[i];
  }
}

void ContactRecorder::record(const State& state) {
  const double time = state.clock.time.value();
  for (Partners& partners : partners_) {
    const ContactBook& book = (partners.two_bodies ? state.pairs : state.obstacles)[partners.book];
    auto& touches = partners.touches;
    const bool lasts = !touches.empty() && !touches.back().over;
    if (book.touching > 0) {
      if (!lasts) {
        touches.push_back({.begin = time,
                           .impulse_before = touches.empty() ? Vec2{} : touches.back().impulse_after,
                           .normal_before = touches.empty() ? Vec2{} : touches.back().normal_after,
                           .momentum_before = last_momentum_,
                           .touched = std::vector<bool>(model_.bodies.size())});
      }
      touch_step(partners, book, state);
    } else if (lasts) {
      touches.back().end = time;
      touches.back().over = true;
      touches.back().momentum_after = state.body_momentum;
    }
  }
  last_momentum_ = state.body_momentum;
}

void ContactRecorder::touch_step(Partners& partners, const ContactBook& book, const State& state) {
  Touch& touch = partners.touches.back();
  touch.end = state.clock.time.value();
  touch.impulse_after = book.total.impulse();
  touch.normal_after = book.normal.impulse();
  touch.peak_force = std::max(touch.peak_force, length(book.total.force));
  touch.momentum_after = state.body_momentum;
  if (partners.two_bodies) {
    touch.touched[partners.first] = touch.touched[partners.second] = true;
  } else {
    const std::size_t first = partners.book * model_.contact_nodes.size();
    for (std::size_t c = 0; c < model_.contact_nodes.size(); ++c) {
      if (state.contacts[first + c].touches != 0) touch.touched[model_.contact_bodies[c]] = true;
    }
  }

  constexpr std::size_t most_points = 1 << 16;
  Curve& curve = partners.curve;
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

EpisodeSummary ContactRecorder::episode(const Partners& partners, const Touch& first, const Touch& last, double peak,
                                        const std::vector<bool>& touched) const {
  EpisodeSummary e{.first_touch = first.begin,
                   .separation = last.over ? last.end : no_number,
                   .duration = last.end - first.begin,
                   .impulse = last.impulse_after - first.impulse_before,
                   .peak_force = peak};
  Vec2 moving;
  if (partners.two_bodies) {
    const auto relative = [&](const std::vector<Vec2>& momentum) {
      const auto velocity = [&](std::size_t body) { return (1 / model_.bodies[body].mass) * momentum[body]; };
      return velocity(partners.first) - velocity(partners.second);
    };
    e.velocity_before = relative(first.momentum_before);
    e.velocity_after = relative(last.momentum_after);
  } else {
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
    moving = model_.obstacles[partners.book].velocity;
  }
  // Along the impulse of the normal forces: the direction of the push.
  const Vec2 push = last.normal_after - first.normal_before;
  const double towards = -dot(e.velocity_before - moving, push);
  if (last.over && towards > 0) e.restitution = dot(e.velocity_after - moving, push) / towards;
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
  if (!partners.curve.time.empty()) {
    auto time = partners.curve.time;
    auto impulse = partners.curve.impulse;
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
    s.episodes.push_back(episode(partners, touches[k], touches[last], peak, touched));
    k = last + 1;
  }
  return s;
}

std::map<std::string, ContactSummary> ContactRecorder::summary() const {
  std::map<std::string, ContactSummary> all;
  for (const Partners& partners : partners_) {
    // Obstacles that nobody struck are named, bodies that did not meet are not: there are too many pairs.
    if (!partners.two_bodies || !partners.touches.empty()) all[partners.name] = summary_of(partners);
  }
  return all;
}

}  // namespace udar

#include "udar/model/check_state.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "udar/base/error.hpp"

namespace udar {
namespace {

void need(bool fits, const char* what) {
  if (!fits) throw OutputError(std::string("its ") + what + " does not fit the case");
}

void check_clock(const Model& model, const Clock& clock) {
  const double time = clock.time.value();
  need(std::isfinite(time) && time >= 0, "time");
  for (const double step : {clock.next_step, clock.following_step}) need(std::isfinite(step) && step > 0, "time step");
  for (const double step : {clock.last_step, clock.step_before, clock.second_step_before}) {
    need(std::isfinite(step) && step >= 0, "time step");
  }
  const std::size_t elements = model.corners.size();
  need(clock.limit.element < elements && clock.tightest.element < elements && clock.first_shortened_element < elements,
       "element with the smallest step");
}

/// Of a node with a body, or of an obstacle's corner with one.
template <class Touch>
bool fits(const Model& model, const Touch& t, std::size_t first, std::size_t end) {
  return t.point >= first && t.point < end && t.segment < model.segments.size() && t.body < model.bodies.size();
}

template <class Touch>
bool in_order_of_points(const std::vector<Touch>& touches) {
  const auto place = [](const Touch& t) { return std::tuple(t.point, t.body); };
  return std::adjacent_find(touches.begin(), touches.end(),
                            [&](const Touch& a, const Touch& b) { return !(place(a) < place(b)); }) == touches.end();
}

void check_touches(const Model& model, const State& state) {
  const std::size_t nodes = model.contact_nodes.size();
  for (const BodyTouch& t : state.touches) {
    need(fits(model, t, 0, nodes), "touch of bodies");
    need(book_of_pair(state, model.contact_bodies[t.point], t.body) != nullptr, "touch of bodies");
  }
  for (const CornerTouch& t : state.corner_touches) {
    need(fits(model, t, nodes, model.point_count()) && t.relieved < nodes, "touch of a corner");
  }
  need(in_order_of_points(state.touches) && in_order_of_points(state.corner_touches), "list of touches");
}

void check_pairs(const Model& model, const State& state) {
  for (std::size_t k = 0; k < state.pairs.size(); ++k) {
    const PairBook& pair = state.pairs[k];
    need(pair.first <= pair.second && pair.second < model.bodies.size(), "pair of bodies");
    need(k == 0 || bodies_of(state.pairs[k - 1]) < bodies_of(pair), "list of pairs");
  }
}

}  // namespace

void check_state(const Model& model, const State& state) {
  check_clock(model, state.clock);
  check_pairs(model, state);
  check_touches(model, state);
  for (const FrequencyBound& bound : state.frequency) need(bound.element < model.corners.size(), "stiffest element");
  for (const Sinking& sunk : state.sunk) need(sunk.node < model.node_count, "deepest node in an obstacle");
  if (state.largest_penetration == 0) return;
  const DeepestTouch& deepest = state.deepest;
  const std::size_t partners = deepest.into_body != 0 ? model.bodies.size() : model.obstacles.size();
  need(deepest.node < model.node_count && deepest.partner < partners, "deepest touch");
}

}  // namespace udar

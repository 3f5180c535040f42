#include <algorithm>

#include "udar/step/stages.hpp"

namespace udar {
namespace {

BodyNumbers bodies_of(const Model& model, const BodyTouch& touch) {
  return in_order(model.contact_bodies[touch.point], touch.body);
}

/// Position of a pair's book among the first `count`, or of the one that would follow it. Most touches are of the same
/// bodies as the touch before: `last` is looked at first.
std::size_t position_of(const std::vector<PairBook>& books, std::size_t count, BodyNumbers pair, std::size_t last) {
  if (last < count && bodies_of(books[last]) == pair) return last;
  const auto end = books.begin() + static_cast<std::ptrdiff_t>(count);
  return static_cast<std::size_t>(find_pair(books.begin(), end, pair) - books.begin());
}

/// Books for the pairs that touch for the first time. Identity alone puts them in order: not when they met, nor who
/// found out.
void open_pair_books(const Model& model, State& state) {
  std::vector<PairBook>& books = state.pairs;
  const std::size_t known = books.size();
  std::size_t at = 0;
  for (const BodyTouch& touch : state.touches) {
    const BodyNumbers pair = bodies_of(model, touch);
    at = position_of(books, known, pair, at);
    const bool has_book = at < known && bodies_of(books[at]) == pair;
    const bool same_again = books.size() > known && bodies_of(books.back()) == pair;
    if (!has_book && !same_again) books.push_back({.first = pair.first, .second = pair.second, .book = {}});
  }
  if (books.size() == known) return;
  const auto before = [](const PairBook& a, const PairBook& b) { return bodies_of(a) < bodies_of(b); };
  const auto same = [](const PairBook& a, const PairBook& b) { return bodies_of(a) == bodies_of(b); };
  std::sort(books.begin() + static_cast<std::ptrdiff_t>(known), books.end(), before);
  books.erase(std::unique(books.begin() + static_cast<std::ptrdiff_t>(known), books.end(), same), books.end());
  std::inplace_merge(books.begin(), books.begin() + static_cast<std::ptrdiff_t>(known), books.end(), before);
}

}  // namespace

void sum_pair_forces(const Model& model, State& state, BodyContact& contact) {
  open_pair_books(model, state);
  contact.pair_forces.resize(state.pairs.size());
  std::size_t at = 0;
  for (const BodyTouch& touch : state.touches) {
    at = position_of(state.pairs, state.pairs.size(), bodies_of(model, touch), at);
    PairForces& pair = contact.pair_forces[at];
    const double sign = model.contact_bodies[touch.point] <= touch.body ? 1 : -1;
    const Vec2 pressing = touch.springs.normal_force + touch.springs.damping_force;
    pair.pressing.force += sign * pressing;
    pair.total.force += sign * (pressing + touch.springs.friction_force);
    ++pair.touching;
  }
}

}  // namespace udar

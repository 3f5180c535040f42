#include "udar/output/summarise.hpp"

#include <fmt/core.h>

#include "udar/output/observer.hpp"

namespace udar {
namespace {

LedgerSummary ledger_of(const Model& model, const State& state) {
  const Ledger& l = state.ledger;
  LedgerSummary s{.start = l.start_energy,
                  .kinetic = l.kinetic_energy,
                  .elastic = l.elastic_energy(),
                  .plastic = l.plastic_work.value(),
                  .stored_elastic = stored_elastic_energy(model, state),
                  .contact = l.contact_energy + l.tangential_energy,
                  .friction = l.friction_work.value(),
                  .dropped = l.dropped_energy.value(),
                  .damping = l.damped_energy(),
                  .gravity = l.book(ForceKind::gravity).work_now,
                  .loads = l.book(ForceKind::load).work_now,
                  .supports = l.book(ForceKind::support).work_now,
                  .obstacles = l.obstacle_work_now};
  s.total = s.kinetic + s.elastic + s.plastic + s.contact + s.friction + s.dropped + s.damping;
  s.error = l.energy_balance();
  return s;
}

MomentumSummary momentum_of(const State& state) {
  const Ledger& l = state.ledger;
  MomentumSummary s{.start = l.start_momentum,
                    .end = l.momentum,
                    .gravity = l.book(ForceKind::gravity).impulse(),
                    .loads = l.book(ForceKind::load).impulse(),
                    .supports = l.book(ForceKind::support).impulse(),
                    .damping = l.book(ForceKind::damping).impulse()};
  for (const ObstacleBook& obstacle : state.obstacles) s.obstacles += obstacle.total.impulse();
  s.error = s.end - s.start - s.obstacles - s.gravity - s.loads - s.supports - s.damping;
  return s;
}

/// Scale of momentum for a relative error: of the start, or of what pushed where everything began at rest, N s.
double momentum_scale(const Ledger& ledger) {
  if (ledger.momentum_scale > 0) return ledger.momentum_scale;
  double pushed = 0;
  for (const ForceBook& book : ledger.books) pushed += length(book.impulse());
  return pushed;
}

}  // namespace

std::string element_name(const Model& model, Index element) {
  return fmt::format("{} element {}", model.body_of_element(element).name, model.element_numbers[element]);
}

Summary summarise(const Model& model, const State& state) {
  const Clock& clock = state.clock;
  Summary s;
  s.elements = model.element_count;
  s.nodes = model.node_count;
  s.steps = static_cast<long long>(clock.step);
  s.end_time = clock.time.value();
  s.energy_error = state.ledger.energy_error();
  const double scale = momentum_scale(state.ledger);
  s.momentum_error = scale > 0 ? state.ledger.momentum_gap / scale : 0;
  s.penetration_ratio = state.largest_penetration;
  for (const Body& body : model.bodies) s.masses[body.name] = body.mass;
  s.time_step = {.min = clock.smallest_step,
                 .max = clock.largest_step,
                 .time_of_min = clock.tightest_time,
                 .limited_by = element_name(model, clock.tightest.element),
                 .shortened_steps = static_cast<long long>(clock.shortened)};
  if (clock.shortened > 0) {
    s.time_step.first_shortened = clock.first_shortened;
    s.time_step.first_shortened_by = element_name(model, static_cast<Index>(clock.first_shortened_element));
  }
  s.ledger = ledger_of(model, state);
  s.momentum = momentum_of(state);
  return s;
}

void judge(const Model& model, const State& state, Summary& s) {
  enum Verdict { good, doubtful, bad };
  static constexpr const char* words[] = {"good", "doubtful", "bad"};
  Verdict verdict = s.reasons.empty() ? good : bad;
  const auto because = [&](Verdict at_least, std::string reason) {
    verdict = std::max(verdict, at_least);
    s.reasons.push_back(std::move(reason));
  };

  const Clock& clock = state.clock;
  if (!(s.energy_error <= 0.01)) {
    because(bad, fmt::format("the energy books are {:.3g} % apart (good: 0.1 %)", 100 * s.energy_error));
  } else if (s.energy_error > 0.001) {
    because(doubtful, fmt::format("the energy books are {:.3g} % apart (good: 0.1 %)", 100 * s.energy_error));
  }
  if (s.momentum_error > 1e-9) {
    because(bad, fmt::format("the momentum books are {:.3g} of the momentum apart", s.momentum_error));
  }
  if (s.penetration_ratio > 0.05) {
    because(doubtful, fmt::format("nodes sank into an obstacle by up to {:.3g} % of an element; make its `stiffness` "
                                  "larger or \"auto\"",
                                  100 * s.penetration_ratio));
  }
  if (clock.shortened > 0 && model.run.when_unstable == WhenUnstable::shorten) {
    because(good, fmt::format("the fixed step was above the stable limit and was shortened in {} steps, first at t = "
                              "{:.4g} s by {}",
                              clock.shortened, s.time_step.first_shortened, s.time_step.first_shortened_by));
  }
  if (clock.shortened > 0 && model.run.when_unstable == WhenUnstable::carry_on) {
    because(doubtful, fmt::format("the fixed step was above the stable limit in {} steps, up to {:.3g} times, first at "
                                  "t = {:.4g} s by {}",
                                  clock.shortened, clock.largest_excess, s.time_step.first_shortened,
                                  s.time_step.first_shortened_by));
  }
  if (clock.tightest.size < 0.25 * clock.start_limit) {
    because(good, fmt::format("{} was crushed: its stable step fell to {:.3g} % of the first one at t = {:.4g} s; "
                              "corners of obstacles are felt by nodes only",
                              element_name(model, clock.tightest.element),
                              100 * clock.tightest.size / clock.start_limit, clock.tightest_time));
  }
  s.verdict = words[verdict];
}

}  // namespace udar

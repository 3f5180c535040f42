#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "udar/base/error.hpp"
#include "udar/step/element_kernels.hpp"
#include "udar/step/failure.hpp"
#include "udar/step/integrators.hpp"
#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

/// Over the end time: with shorter steps a run would never end.
constexpr double shortest_step = 1e-12;

double frequency_squared(const Model& model, const State& state, Index element) {
  const auto& corners = model.corners[element];
  const NodeRecord& a = state.nodes[corners[0]];
  const NodeRecord& b = state.nodes[corners[1]];
  const NodeRecord& c = state.nodes[corners[2]];
  const Sides<double> sides{b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y};
  const Elasticity elasticity =
      std::visit([](const auto& law) { return law.elasticity(); }, model.body_of_element(element).law);
  return eigenfrequency_squared(sides, elasticity, model.area_density[element]);
}

/// Largest stable step with frequency^2 `w2` and a dashpot of `c` (1/s) whose force is half a step late: from
/// (h^2 w2 + 2 h c) = 4 for central difference, scaled for integrators with another limit on w h.
double stable_step(double w2, double c, double limit) { return 0.5 * limit * (std::sqrt(c * c + 4 * w2) - c) / w2; }

/// The element of a block that has the block's largest frequency.
Index stiffest_element(const Model& model, const State& state, const ElementBlock& block) {
  Index stiffest = block.begin;
  double largest = 0;
  for (Index e = block.begin; e < block.end; ++e) {
    const double w2 = frequency_squared(model, state, e);
    if (w2 > largest) {
      largest = w2;
      stiffest = e;
    }
  }
  return stiffest;
}

StepLimit stable_limit(const Model& model, const State& state, const Workspace& work) {
  // An integrator that is never stable is judged by the limit of central difference.
  const double rule_limit = rule_of(model.run.integrator).stable_limit;
  const double limit = rule_limit > 0 ? rule_limit : 2;
  const double damping = damping_rate(model, state);

  std::size_t stiffest = 0;
  for (std::size_t b = 1; b < work.element_sums.size(); ++b) {
    if (work.element_sums[b].frequency_squared > work.element_sums[stiffest].frequency_squared) stiffest = b;
  }
  StepLimit found{.size = stable_step(work.element_sums[stiffest].frequency_squared, damping, limit),
                  .element = std::numeric_limits<Index>::max()};
  for (const auto& contact : model.contact_elements) {
    const double w2 = frequency_squared(model, state, contact.element) + contact.spring;
    const double size = stable_step(w2, damping + contact.dashpot, limit);
    if (size < found.size) found = {.size = size, .element = contact.element, .by_contact = 1};
  }
  if (found.by_contact == 0) found.element = stiffest_element(model, state, model.element_blocks[stiffest]);
  return found;
}

/// What the case asks for: a fixed step, as far as it is stable or the case insists, or a part of the stable limit.
double wanted_step(const Model& model, Clock& clock) {
  const double safe_step = model.run.step_safety * clock.limit.size;
  if (!model.run.time_step) return safe_step;
  const double step = *model.run.time_step;
  if (step <= clock.limit.size || rule_of(model.run.integrator).stable_limit == 0) return step;
  if (model.run.when_unstable == WhenUnstable::stop) fail_unstable(model, clock);
  if (clock.shortened++ == 0) {
    clock.first_shortened = clock.time.value();
    clock.first_shortened_element = clock.limit.element;
  }
  clock.largest_excess = std::max(clock.largest_excess, step / clock.limit.size);
  return model.run.when_unstable == WhenUnstable::shorten ? safe_step : step;
}

/// A step that jitters costs energy: it shrinks at once but grows slowly.
double next_step(const Model& model, Clock& clock) {
  constexpr double largest_growth = 1.01;
  const double wanted = wanted_step(model, clock);
  clock.planned_step = clock.step == 0 ? wanted : std::min(wanted, largest_growth * clock.planned_step);
  return clock.planned_step;
}

/// The run ends on its end time. For the sake of the energy the last hundred automatic steps share out what is left; a
/// fixed step stays fixed, and its last one is cut. A remainder too small to be a step of its own is taken along.
double fitted_to_end(const Model& model, double step, double left) {
  constexpr double shared_out = 100;
  if (left <= 0) return step;
  if (left <= step * (1 + 1e-6)) return left;
  if (!model.run.time_step && left < shared_out * step) return left / std::ceil(left / step);
  return step;
}

/// A fixed step that is above the limit from the start, or absurdly below, is a mistake in the case.
void refuse_unusable_step(const Model& model, const State& state) {
  if (!model.run.time_step) return;
  if (*model.run.time_step < shortest_step * model.run.end_time) {
    throw UserError(ExitCode::bad_case,
                    fmt::format("time_step = {:.4g} s would take {:.3g} steps to the end", *model.run.time_step,
                                model.run.end_time / *model.run.time_step),
                    fmt::format("write time_step = \"{:.3g} s\", or \"auto\"", 0.9 * state.clock.limit.size));
  }
  if (rule_of(model.run.integrator).stable_limit == 0) return;
  const StepLimit& limit = state.clock.limit;
  if (*model.run.time_step <= limit.size) return;
  const Body& body = model.body_of_element(limit.element);
  throw UserError(ExitCode::bad_case,
                  fmt::format("time_step = {:.4g} s is above the stable limit {:.4g} s of `{}`, set by element {} of "
                              "body `{}`{}",
                              *model.run.time_step, limit.size, rule_of(model.run.integrator).keyword,
                              model.element_numbers[limit.element], body.name,
                              limit.by_contact != 0 ? " and its contact springs" : ""),
                  fmt::format("write time_step = \"{:.3g} s\" or less, or \"auto\"", 0.9 * limit.size));
}

}  // namespace

void choose_time_step(const Model& model, State& state, Workspace& work) {
  Clock& clock = state.clock;
  clock.limit = stable_limit(model, state, work);
  if (clock.step == 0) {
    refuse_unusable_step(model, state);
    clock.start_limit = clock.limit.size;
  }
  if (clock.step == 0 || clock.limit.size < clock.tightest.size) {
    clock.tightest = clock.limit;
    clock.tightest_time = clock.time.value();
  }
  const double left = model.run.end_time - clock.time.value();
  const double step = next_step(model, clock);
  if (step < shortest_step * model.run.end_time) fail_collapsing_step(model, state);
  clock.smallest_step = clock.step == 0 ? step : std::min(clock.smallest_step, step);
  clock.largest_step = std::max(clock.largest_step, step);
  clock.next_step = fitted_to_end(model, step, left);
  clock.next_is_last = clock.next_step == left ? 1 : 0;
}

}  // namespace udar

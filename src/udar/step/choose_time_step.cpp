#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "udar/base/error.hpp"
#include "udar/step/failure.hpp"
#include "udar/step/integrators.hpp"
#include "udar/step/motion.hpp"
#include "udar/step/stages.hpp"

namespace udar {
namespace {

/// Over the end time: with shorter steps a run would never end.
constexpr double shortest_step = 1e-12;

/// Largest stable step with frequency^2 `w2` and a dashpot of `c` (1/s) whose force is half a step late: from
/// (h^2 w2 + 2 h c) = 4 for central difference, scaled for integrators with another limit on w h.
double stable_step(double w2, double c, double limit) { return 0.5 * limit * (std::sqrt(c * c + 4 * w2) - c) / w2; }

StepLimit stable_limit(const Model& model, const State& state, const BodyContact& bodies) {
  // An integrator that is never stable is judged by the limit of central difference.
  const double rule_limit = rule_of(model.run.integrator).stable_limit;
  const double limit = rule_limit > 0 ? rule_limit : 2;
  const double damping = damping_rate(model, state);

  StepLimit found{.size = std::numeric_limits<double>::infinity()};
  double w2 = 0;
  double dashpot = 0;
  for (std::size_t b = 0; b < model.element_blocks.size(); ++b) {
    const FrequencyBound& bound = state.frequency[b];
    const double own_dashpot = model.element_blocks[b].dashpot;
    if (bound.squared <= w2 && own_dashpot <= dashpot) continue;
    const double size = stable_step(bound.squared + bodies.excess, damping + own_dashpot + bodies.dashpot, limit);
    if (!(size < found.size)) continue;
    w2 = bound.squared;
    dashpot = own_dashpot;
    found = {.size = size,
             .element = bound.element,
             .by_contact = model.contact_spring[bound.element] + bodies.excess > 0 ? 1U : 0U};
  }
  for (std::size_t k = 0; k < model.rigid_bodies.size(); ++k) {
    const RigidBody& rigid = model.rigid_bodies[k];
    const double size =
        stable_step(rigid.springs + bodies.rigid_excess[k], damping + rigid.dashpots + bodies.rigid_dashpot[k], limit);
    if (size < found.size) found = {size, model.bodies[rigid.body].element_begin, 1};
  }
  return found;
}

/// Blocks whose bound rises above this compute their frequency, so of a block that is not among the stiffest hardly
/// anything has to be computed. The limit is then at most half a percent below the exact one, or one percent where the
/// stiffest elements have relaxed since; more in single steps of violent motion, never larger.
double next_threshold(const State& state) {
  constexpr double slack = 1.01;
  double largest = 0;
  for (const FrequencyBound& bound : state.frequency) largest = std::max(largest, bound.computed);
  return slack * largest;
}

/// What the case asks for: a fixed step, as far as it is stable or the case insists, or a part of the stable limit.
double wanted_step(const Model& model, State& state) {
  Clock& clock = state.clock;
  // Where all bodies are rigid, touches are the only thing that happens: forty steps or more for each.
  constexpr double part_for_touches = 0.05;
  const double part = model.element_blocks.empty() ? part_for_touches : 1;
  const double safe_step = part * model.run.step_safety * clock.limit.size;
  if (!model.run.time_step) return safe_step;
  const double step = *model.run.time_step;
  if (step <= clock.limit.size || rule_of(model.run.integrator).stable_limit == 0) return step;
  if (model.run.when_unstable == WhenUnstable::stop) fail_unstable(model, state);
  if (clock.shortened++ == 0) {
    clock.first_shortened = clock.time.value();
    clock.first_shortened_element = clock.limit.element;
  }
  clock.largest_excess = std::max(clock.largest_excess, step / clock.limit.size);
  return model.run.when_unstable == WhenUnstable::shorten ? safe_step : step;
}

/// A step that jitters costs energy, so it shrinks at once but grows slowly. The limit does jitter: bounds rise a
/// little until they are computed anew. An automatic step lets a limit rise by a percent before it follows, and then
/// goes a hundredth of the way in each step; a fixed one comes back to what the case says.
double smoothed(const Model& model, double last, double wanted) {
  constexpr double largest_growth = 1.01;
  if (model.run.time_step || wanted <= last) return std::min(wanted, largest_growth * last);
  constexpr double jitter = 1.01;
  constexpr double part = 0.01;
  return std::min(last + part * std::max(0.0, wanted - jitter * last), largest_growth * last);
}

/// The velocities of the next step were computed before its limit was known. Where it fell below that step at once, the
/// step is cut short; its velocity is then a little late, which the one after it sets right.
void cut_next_step(Clock& clock, double wanted) {
  constexpr double rounding = 1 + 2e-6;  // the last step may be longer by a millionth
  if (clock.next_step <= rounding * clock.limit.size || clock.next_step <= wanted) return;
  clock.next_velocity_ahead = 0.5 * (clock.next_step - wanted);
  clock.next_step = wanted;
  clock.next_is_last = 0;
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

void choose_time_step(const Model& model, State& state, const Workspace& work) {
  Clock& clock = state.clock;
  clock.limit = stable_limit(model, state, work.bodies);
  clock.compute_above = next_threshold(state);
  if (clock.step == 0) {
    refuse_unusable_step(model, state);
    clock.start_limit = clock.limit.size;
  }
  if (clock.step == 0 || clock.limit.size < clock.tightest.size) {
    clock.tightest = clock.limit;
    clock.tightest_time = clock.time.value();
  }
  const double wanted = wanted_step(model, state);
  if (wanted < shortest_step * model.run.end_time) fail_collapsing_step(model, state);
  const double left = model.run.end_time - clock.time.value();
  if (clock.step == 0) {
    clock.planned_step = wanted;
    clock.next_step = fitted_to_end(model, wanted, left);
    clock.next_is_last = clock.next_step == left ? 1 : 0;
  } else {
    cut_next_step(clock, wanted);
    clock.planned_step = smoothed(model, clock.planned_step, wanted);
  }
  clock.smallest_step = clock.step == 0 ? clock.planned_step : std::min(clock.smallest_step, clock.planned_step);
  clock.largest_step = std::max(clock.largest_step, clock.planned_step);
  const double left_then = clock.next_is_last != 0 ? 0 : left - clock.next_step;
  clock.following_step = fitted_to_end(model, clock.planned_step, left_then);
  clock.following_is_last = clock.following_step == left_then ? 1 : 0;
}

}  // namespace udar

#include "udar/step/failure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "udar/base/error.hpp"
#include "udar/step/motion.hpp"

namespace udar {
namespace {

std::string when(const Clock& clock) {
  return fmt::format("at t = {:.6g} s (step {}, h = {:.4g} s)", clock.time.value(), clock.step, clock.last_step);
}

std::string element_text(const Model& model, const State& state, Index element) {
  const auto& corners = model.corners[element];
  const Vec2 centre = (1.0 / 3.0) * (place(state, corners[0]) + place(state, corners[1]) + place(state, corners[2]));
  return fmt::format("element {} of body `{}` (nodes {}, {}, {}) near ({:.5g}, {:.5g}) m",
                     model.element_numbers[element], model.body_of_element(element).name,
                     model.node_numbers[corners[0]], model.node_numbers[corners[1]], model.node_numbers[corners[2]],
                     centre.x, centre.y);
}

double smaller_area(const Model& model, const State& state, Index element) {
  const double half_step = 0.5 * state.clock.last_step;
  const auto& corners = model.corners[element];
  const auto middle = [&](Index i) { return place(state, i) - half_step * velocity_of_last_step(state, i); };
  const double at_end = twice_area(place(state, corners[0]), place(state, corners[1]), place(state, corners[2]));
  return std::min(at_end, twice_area(middle(corners[0]), middle(corners[1]), middle(corners[2])));
}

}  // namespace

void refuse_inverted(const Model& model, const State& state, const Workspace& work) {
  const auto flat = [](const ElementSums& sums) { return !(sums.smallest_area > 0); };
  const auto& sums = work.element_sums;
  const auto found = std::find_if(sums.begin(), sums.end(), flat);
  if (found == sums.end()) return;

  const ElementBlock& block = model.element_blocks[static_cast<std::size_t>(found - sums.begin())];
  Index worst = block.begin;
  double smallest = std::numeric_limits<double>::infinity();
  for (Index e = block.begin; e < std::min(block.end, model.bodies[block.body].element_end); ++e) {
    const double area = smaller_area(model, state, e);
    if (area < smallest) {
      smallest = area;
      worst = e;
    }
  }
  throw NumericalError(fmt::format(
      "{} turned inside out {}.\n"
      "  Likely cause: a corner of an obstacle or a load crushes single elements, or the step was above the stable "
      "limit.\n"
      "  Cure: a coarser mesh there or a rounder obstacle; softer contact springs; time_step = \"auto\".",
      element_text(model, state, worst), when(state.clock)));
}

void fail_not_finite(const Model& model, const State& state) {
  for (Index i = 0; i < model.node_count; ++i) {
    const NodeRecord& r = state.nodes[i];
    if (std::isfinite(r.x) && std::isfinite(r.y) && std::isfinite(r.vx) && std::isfinite(r.vy)) continue;
    throw NumericalError(fmt::format(
        "node {} of body `{}` (undeformed at ({:.5g}, {:.5g}) m) has a velocity that is not a number {}.\n"
        "  Likely cause: the step is above the stable limit and the motion grew without bound.\n"
        "  Cure: time_step = \"auto\", or a smaller one.",
        model.node_numbers[i], model.body_of_node(i).name, model.rest[i].x, model.rest[i].y, when(state.clock)));
  }
  throw NumericalError(fmt::format("the energy is not a number any more {}", when(state.clock)));
}

void fail_unstable(const Model& model, const Clock& clock) {
  throw NumericalError(fmt::format(
      "the stable limit fell to {:.4g} s, below the fixed step {:.4g} s, at t = {:.6g} s (step {}): element {} of body "
      "`{}`.\n"
      "  Likely cause: the element is being crushed.\n"
      "  Cure: time_step = \"auto\", or when_unstable = \"shorten\".",
      clock.limit.size, *model.run.time_step, clock.time.value(), clock.step,
      model.element_numbers[clock.limit.element], model.body_of_element(clock.limit.element).name));
}

void fail_collapsing_step(const Model& model, const State& state) {
  throw NumericalError(
      fmt::format("the stable limit collapsed to {:.3g} s {}: {}.\n"
                  "  Likely cause: the element is crushed flat.\n"
                  "  Cure: a coarser mesh there, or a rounder obstacle.",
                  state.clock.limit.size, when(state.clock), element_text(model, state, state.clock.limit.element)));
}

void fail_energy(const Model& model, const State& state) {
  const Ledger& ledger = state.ledger;
  throw NumericalError(
      fmt::format("the energy books are {:.3g} % apart {}; the case allows {:.3g} %.\n"
                  "  Kinetic {:.6g} J, elastic {:.6g} J, plastic {:.6g} J, contact {:.6g} J, friction {:.6g} J; "
                  "started with {:.6g} "
                  "J, work from outside {:.6g} J.\n"
                  "  Likely cause: the step is too large for {} elements or for the contact springs.\n"
                  "  Cure: time_step = \"auto\" with a smaller step_safety, or softer contact springs.",
                  100 * ledger.energy_error(), when(state.clock), 100 * model.run.stop_at_energy_error,
                  ledger.kinetic_energy, ledger.elastic_energy(), ledger.plastic_work.value(), ledger.contact_energy,
                  ledger.friction_work.value(), ledger.start_energy, ledger.external_work(), "crushed"));
}

}  // namespace udar

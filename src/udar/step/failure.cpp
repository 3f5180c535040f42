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

std::string node_text(const Model& model, Index node) {
  return fmt::format("node {} of body `{}` (undeformed at ({:.5g}, {:.5g}) m)", model.node_numbers[node],
                     model.body_of_node(node).name, model.rest[node].x, model.rest[node].y);
}

bool is_finite(Vec2 v) { return std::isfinite(v.x) && std::isfinite(v.y); }

Culprit element_of(Index number) { return {Culprit::element, number}; }
Culprit node_of(Index number) { return {Culprit::node, number}; }

/// Throws with what is most likely and what helps. A step that the case keeps above the stable limit is to blame for
/// whatever happens.
[[noreturn]] void fail(const Model& model, const State& state, Culprit culprit, const std::string& what,
                       std::string cause, std::string cure) {
  const double excess = state.clock.largest_excess;
  if (model.run.time_step && model.run.when_unstable == WhenUnstable::carry_on && excess > 1) {
    cause = fmt::format(
        "the fixed step was up to {:.3g} times the stable limit, which when_unstable = \"continue\" lets it", excess);
    cure = "time_step = \"auto\", or when_unstable = \"shorten\"";
  }
  throw NumericalError(fmt::format("{}.\n  Likely cause: {}.\n  Cure: {}.", what, cause, cure), culprit);
}

/// Throws where one of `begin` .. `end` - 1 is bad; `describe` says what is wrong with it.
template <class Bad, class Describe>
void refuse_any(const Model& model, const State& state, Culprit::Kind kind, Index begin, Index end, Bad&& bad,
                Describe&& describe) {
  for (Index i = begin; i < end; ++i) {
    if (!bad(i)) continue;
    fail(model, state, {kind, i}, fmt::format("{} {}", describe(i), when(state.clock)),
         "the motion grew without bound, since the step is above the stable limit or a value of the case is far out "
         "(its unit?)",
         "time_step = \"auto\" with a smaller step_safety, 0.5; udar check shows the case in other words");
  }
}

/// Throws where anything is not a number. In the order of cause and effect: within a step what is none in the velocity
/// of a node spreads to its place, then to the stress of its elements, and from a stress to the plastic strain there
/// and to the velocities of the nodes.
void refuse_not_finite(const Model& model, const State& state) {
  const auto rigid_text = [&](Index k, const char* what) {
    return fmt::format("body `{}`, which moves as one piece, has a {} that is not a number",
                       model.bodies[model.rigid_bodies[k].body].name, what);
  };
  const auto rigid_count = static_cast<Index>(state.rigid.size());
  const auto refuse = [&](Culprit::Kind kind, Index begin, Index end, auto bad, auto describe) {
    refuse_any(model, state, kind, begin, end, bad, describe);
  };
  refuse(
      Culprit::unknown, 0, rigid_count,
      [&](Index k) { return !is_finite(state.rigid[k].place) || !std::isfinite(state.rigid[k].angle); },
      [&](Index k) { return rigid_text(k, "place"); });
  refuse(
      Culprit::node, 0, model.node_count, [&](Index i) { return !is_finite(place(state, i)); },
      [&](Index i) { return node_text(model, i) + " has a place or velocity that is not a number"; });
  for (const Body& body : model.bodies) {
    refuse(
        Culprit::element, body.element_begin, body.element_end,
        [&](Index e) {
          return !std::isfinite(state.stress_xx[e]) || !std::isfinite(state.stress_yy[e]) ||
                 !std::isfinite(state.stress_xy[e]) || !std::isfinite(state.stress_zz[e]);
        },
        [&](Index e) { return element_text(model, state, e) + " has a stress that is not a number"; });
    refuse(
        Culprit::element, body.element_begin, body.element_end,
        [&](Index e) { return !std::isfinite(state.plastic_strain[e]); },
        [&](Index e) { return element_text(model, state, e) + " has a plastic strain that is not a number"; });
  }
  refuse(
      Culprit::node, 0, model.node_count,
      [&](Index i) {
        return !is_finite({state.nodes[i].vx, state.nodes[i].vy});
      },
      [&](Index i) { return node_text(model, i) + " has a velocity that is not a number"; });
  refuse(
      Culprit::unknown, 0, rigid_count,
      [&](Index k) {
        return !is_finite(state.rigid[k].velocity.linear) || !std::isfinite(state.rigid[k].velocity.angular);
      },
      [&](Index k) { return rigid_text(k, "velocity"); });
}

/// An element and twice its smallest area in the middle of the step and at its end, m2.
struct FlatElement {
  Index element = 0;
  double twice_area = std::numeric_limits<double>::infinity();
};

/// The flattest one of those in blocks where one may have turned over.
FlatElement flattest_element(const Model& model, const State& state, const Workspace& work) {
  FlatElement found;
  for (std::size_t b = 0; b < model.element_blocks.size(); ++b) {
    if (work.element_sums[b].smallest_area > 0) continue;
    const ElementBlock& block = model.element_blocks[b];
    for (Index e = block.begin; e < std::min(block.end, model.bodies[block.body].element_end); ++e) {
      const double area = smaller_area(model, state, e);
      if (area < found.twice_area) found = {e, area};
    }
  }
  return found;
}

}  // namespace

void refuse_inverted(const Model& model, const State& state, const Workspace& work) {
  const auto& sums = work.element_sums;
  const bool none = std::all_of(sums.begin(), sums.end(), [](const ElementSums& s) { return s.smallest_area > 0; });
  if (none) return;
  // The area of an element with a place that is not a number is none, either. An element that turned over may well have
  // a stress that is none.
  const FlatElement flattest = flattest_element(model, state, work);
  if (!std::isfinite(flattest.twice_area) || flattest.twice_area > 0) refuse_not_finite(model, state);
  fail(model, state, element_of(flattest.element),
       fmt::format("{} turned inside out {}", element_text(model, state, flattest.element), when(state.clock)),
       "a corner of an obstacle or a load crushes single elements, or the step was above the stable limit",
       "a coarser mesh there or a rounder obstacle; softer contact springs; time_step = \"auto\" with a smaller "
       "step_safety, 0.5");
}

void fail_not_finite(const Model& model, const State& state) {
  refuse_not_finite(model, state);
  Index fastest = 0;
  const auto speed = [&](Index i) { return std::hypot(state.nodes[i].vx, state.nodes[i].vy); };
  for (Index i = 1; i < model.node_count; ++i) {
    if (speed(i) > speed(fastest)) fastest = i;
  }
  fail(model, state, node_of(fastest),
       fmt::format("the energy is not a number any more {}; {} moves at {:.3g} m/s", when(state.clock),
                   node_text(model, fastest), speed(fastest)),
       "a velocity, load or stiffness of the case is far out (its unit?)", "udar check shows the case in other words");
}

void fail_unstable(const Model& model, const State& state) {
  const Clock& clock = state.clock;
  fail(model, state, element_of(clock.limit.element),
       fmt::format("the stable limit fell to {:.4g} s, below the fixed step {:.4g} s, {}: {}", clock.limit.size,
                   *model.run.time_step, when(clock), element_text(model, state, clock.limit.element)),
       "the element is being crushed", "time_step = \"auto\", or when_unstable = \"shorten\"");
}

void fail_collapsing_step(const Model& model, const State& state) {
  refuse_not_finite(model, state);
  const StepLimit& limit = state.clock.limit;
  fail(model, state, element_of(limit.element),
       fmt::format("the stable limit collapsed to {:.3g} s {}: {}", limit.size, when(state.clock),
                   element_text(model, state, limit.element)),
       "the element is crushed flat", "a coarser mesh there, or a rounder obstacle; softer contact springs");
}

void fail_energy(const Model& model, const State& state) {
  const Ledger& ledger = state.ledger;
  const Index element = state.clock.limit.element;
  fail(model, state, element_of(element),
       fmt::format("the energy books are {:.3g} % apart {}; the case allows {:.3g} %.\n"
                   "  Kinetic {:.6g} J, elastic {:.6g} J, plastic {:.6g} J, contact {:.6g} J, friction {:.6g} J; "
                   "started with {:.6g} J, work from outside {:.6g} J. The step is set by {}",
                   100 * ledger.energy_error(), when(state.clock), 100 * model.run.stop_at_energy_error,
                   ledger.kinetic_energy, ledger.elastic_energy(), ledger.plastic_work.value(), ledger.contact_energy,
                   ledger.friction_work.value(), ledger.start_energy, ledger.external_work(),
                   element_text(model, state, element)),
       "the step is too large for crushed elements or for the contact springs",
       "time_step = \"auto\" with a smaller step_safety, 0.5, or softer contact springs");
}

}  // namespace udar

// Numbers that are spoiled in mid-run, wherever and in whatever way: found within the same step, with the place where
// that began, and the state before comes back.

#include <doctest/doctest.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "tests/results/scratch.hpp"
#include "tests/simulation/example.hpp"
#include "tests/simulation/golden_cases.hpp"
#include "udar/simulation/last_good.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

enum class Fault { stress, velocity, place, plastic_strain, turned_over };
constexpr int fault_kinds = 5;

/// What was planted where, as the message must name it.
struct Planted {
  std::string kind;
  std::string culprit;     ///< "element 5 of body `ring`"
  std::string of_element;  ///< node that the named element must have, where any of several may be named
};

class Saboteur {
 public:
  Saboteur(const Model& model, unsigned seed) : model_(model), random_(seed) {
    for (Index b = 0; b < model.bodies.size(); ++b) (model.bodies[b].rigid ? rigid_ : soft_).push_back(b);
  }

  /// Spoils one number of the state: in a body that deforms; velocities and places now and then in a rigid one.
  Planted plant(Fault fault, State& state) {
    const double none = pick(2) == 0 ? std::nan("") : pick(2) == 0 ? HUGE_VAL : -HUGE_VAL;
    const bool of_node = fault == Fault::velocity || fault == Fault::place;
    const bool in_rigid = of_node && !rigid_.empty() && pick(2) == 0;
    const std::vector<Index>& bodies = in_rigid ? rigid_ : soft_;
    const Body& body = model_.bodies[bodies[pick(bodies.size())]];
    const Index node = body.node_begin + pick(body.node_end - body.node_begin);
    const Index element = body.element_begin + pick(body.element_end - body.element_begin);
    if (of_node) {
      NodeRecord& r = state.nodes[node];
      double& number = fault == Fault::velocity ? (pick(2) == 0 ? r.vx : r.vy) : (pick(2) == 0 ? r.x : r.y);
      number = none;
      return {"place or velocity that is not a number",
              fmt::format("node {} of body `{}`", model_.node_numbers[node], body.name), ""};
    }
    const std::string name = fmt::format("element {} of body `{}`", model_.element_numbers[element], body.name);
    if (fault == Fault::plastic_strain) {
      state.plastic_strain[element] = none;
      return {"plastic strain that is not a number", name, ""};
    }
    if (fault == Fault::stress) {
      Array<double>* const components[] = {&state.stress_xx, &state.stress_yy, &state.stress_xy, &state.stress_zz};
      (*components[pick(4)])[element] = none;
      return {"stress that is not a number", name, ""};
    }
    const auto& corners = model_.corners[element];
    const Index corner = corners[pick(3)];
    Vec2 mirrored = -1.0 * place(state, corner);
    for (const Index other : corners) mirrored += other != corner ? place(state, other) : Vec2{};
    state.nodes[corner].x = mirrored.x;
    state.nodes[corner].y = mirrored.y;
    return {"turned inside out", fmt::format("of body `{}`", body.name),
            fmt::format("{}", model_.node_numbers[corner])};
  }

  Index pick(std::size_t count) { return static_cast<Index>(random_() % count); }

 private:
  const Model& model_;
  std::mt19937 random_;
  std::vector<Index> soft_, rigid_;
};

/// Does the element that a message names, "(nodes 1, 2, 3)", have this one?
bool names_node(const std::string& message, const std::string& node) {
  const std::size_t from = message.find("(nodes ") + 7;
  const std::string nodes = ", " + message.substr(from, message.find(')', from) - from) + ",";
  return contains(nodes, ", " + node + ",");
}

bool tells_all(const std::string& message, const Planted& planted, const State& state) {
  const std::string when = fmt::format("at t = {:.6g} s (step {}, h = {:.4g} s)", state.clock.time.value(),
                                       state.clock.step, state.clock.last_step);
  bool all = contains(message, when);
  for (const std::string& part :
       {planted.kind, planted.culprit, std::string(") m"), std::string("Likely cause: "), std::string("Cure: ")}) {
    all = all && contains(message, part);
  }
  return all && (planted.of_element.empty() || names_node(message, planted.of_element));
}

struct Score {
  int planted = 0, found = 0, named = 0, restored = 0;
};

/// Runs a case and plants faults in copies of its state, after random numbers of steps.
void sabotage(const GoldenCase& golden, int faults, Score& score) {
  const Model model = build_model(golden.input());
  Workspace work(model, 1);
  Saboteur saboteur(model, static_cast<unsigned>(score.planted + 1));
  State state = start(model, work);
  LastGood last_good(model);
  last_good.keep(state);
  for (int k = 0; k < faults; ++k) {
    for (Index steps = 1 + saboteur.pick(15); steps > 0; --steps) {
      step(model, state, work);
      last_good.keep(state);
    }
    const std::uint64_t hash = hash_of(state);
    State spoiled = state;
    const Planted planted = saboteur.plant(static_cast<Fault>(k % fault_kinds), spoiled);
    CAPTURE(planted.kind);
    CAPTURE(planted.culprit);
    // As in mid-run, or by a process that took up the state from elsewhere.
    Workspace other(model, 2);
    const std::string message = message_of<NumericalError>([&] { step(model, spoiled, k % 2 == 0 ? work : other); });
    CAPTURE(message);
    ++score.planted;
    const bool found = !message.empty() && spoiled.clock.step == state.clock.step + 1;
    const bool named = found && tells_all(message, planted, spoiled);
    const bool restored = hash_of(last_good.before(spoiled.clock.step, work)) == hash;
    CHECK(found);
    CHECK(named);
    CHECK(restored);
    score.found += found ? 1 : 0;
    score.named += named ? 1 : 0;
    score.restored += restored ? 1 : 0;
  }
}

}  // namespace

TEST_CASE("planted faults: each is found within its step and named, and the last good state comes back") {
  const std::vector<std::string> chosen{
      "two-plates",  "stack",      "hammer",     "wedge",         "crowd",
      "tied-blocks", "on-a-wedge", "pulled-bar", "spinning-ring", "tied-to-a-rigid-body"};
  Score score;
  for (const GoldenCase& golden : golden_cases()) {
    if (std::find(chosen.begin(), chosen.end(), golden.name) == chosen.end()) continue;
    CAPTURE(golden.name);
    sabotage(golden, 20, score);
  }
  CHECK(score.planted == 200);
  std::cout << fmt::format("reliability: planted faults {} found {} named {} restored {}\n", score.planted, score.found,
                           score.named, score.restored);
}

}  // namespace udar

// The step limit comes from a bound on the frequency that is computed now and then; here it is compared, step by step,
// with the limit computed from all elements on the geometry at rest between two steps.

#include <doctest/doctest.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/simulation/example.hpp"
#include "udar/base/error.hpp"
#include "udar/case/build_model.hpp"
#include "udar/step/element_kernels.hpp"
#include "udar/step/integrators.hpp"
#include "udar/step/motion.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

const Elastic elastic{.young_modulus = 196e9, .poisson_ratio = 0.25};
const Tresca plastic{.young_modulus = 196e9, .poisson_ratio = 0.25, .yield_stress = 235e6};
constexpr double rounding = 1e-12;
/// A block computes its frequency when its bound has grown by 1 %; its frequency may then have fallen by as much, and
/// the step goes with the root of both.
constexpr double slack = 1.01;

/// Square of the frequency of an element, 1/s2.
double frequency_squared(const Model& model, const State& state, Index e) {
  const auto place = [&](int k) { return place_after(state.nodes[model.corners[e][k]], 0); };
  const Vec2 one = place(1) - place(0);
  const Vec2 two = place(2) - place(0);
  const Elasticity elasticity =
      std::visit([](const auto& law) { return law.elasticity(); }, model.body_of_element(e).law);
  return eigenfrequency_squared(Sides<double>{one.x, one.y, two.x, two.y}, elasticity, model.area_density[e]) +
         model.contact_spring[e];
}

/// The largest stable step of all elements, one by one, s.
double exact_limit(const Model& model, const State& state) {
  const double rule_limit = rule_of(model.run.integrator).stable_limit;
  double smallest = std::numeric_limits<double>::infinity();
  for (const ElementBlock& block : model.element_blocks) {
    const double c = damping_rate(model, state) + block.dashpot;
    for (Index e = block.begin; e < std::min(block.end, model.bodies[block.body].element_end); ++e) {
      const double w2 = frequency_squared(model, state, e);
      smallest = std::min(smallest, 0.5 * rule_limit * (std::sqrt(c * c + 4 * w2) - c) / w2);
    }
  }
  return smallest;
}

/// What is seen of a run, step by step.
struct Watch {
  int steps = 0;
  int too_large = 0;          ///< the limit was above the exact one
  int too_small = 0;          ///< or further below than one percent
  int too_long = 0;           ///< the step was longer than the exact limit, or planned longer than its safe part
  int cut = 0;                ///< the step was cut short after its velocity was computed
  double smallest_ratio = 1;  ///< of limit and exact limit
  double computed = 0;        ///< blocks that computed their frequency
  double blocks = 0;

  void look(const Model& model, const State& before, const State& state) {
    ++steps;
    const Clock& clock = state.clock;
    const double exact = exact_limit(model, state);
    too_large += clock.limit.size > exact * (1 + rounding) ? 1 : 0;
    too_small += clock.limit.size < exact / slack * (1 - rounding) ? 1 : 0;
    // The last step may be longer by a millionth, to end on the end time.
    const double longest = clock.next_is_last != 0 ? 1 + 2e-6 : 1 + rounding;
    cut += clock.next_velocity_ahead > 0 ? 1 : 0;
    too_long += clock.next_step > longest * exact ? 1 : 0;
    const double longest_planned = clock.following_is_last != 0 ? 1 + 2e-6 : 1 + rounding;
    if (!model.run.time_step) {
      too_long += clock.following_step > longest_planned * model.run.step_safety * exact ? 1 : 0;
    }
    smallest_ratio = std::min(smallest_ratio, clock.limit.size / exact);
    for (std::size_t b = 0; b < state.frequency.size(); ++b) {
      const FrequencyBound& now = state.frequency[b];
      const bool same = now.squared == before.frequency[b].squared && now.computed == before.frequency[b].computed;
      computed += !same && now.squared == now.computed ? 1 : 0;
      blocks += 1;
    }
  }
  /// Shown where a check fails.
  [[nodiscard]] std::string text() const {
    return fmt::format("{} steps, limit at least {:.4f} of the exact one, {:.2g} % of the frequencies computed", steps,
                       smallest_ratio, 100 * computed / blocks);
  }
};

/// Height of a triangle over its longest side, m.
double height(Vec2 a, Vec2 b, Vec2 c) {
  return twice_area(a, b, c) / std::max({length(b - a), length(c - b), length(a - c)});
}

/// The height of the most crushed element over its undeformed one.
double most_crushed(const Model& model, const State& state) {
  double smallest = 1;
  for (Index e = 0; e < model.bodies[0].element_end; ++e) {
    const auto& [a, b, c] = model.corners[e];
    const auto at = [&](Index i) { return Vec2{state.nodes[i].x, state.nodes[i].y}; };
    smallest = std::min(smallest, height(at(a), at(b), at(c)) / height(model.rest[a], model.rest[b], model.rest[c]));
  }
  return smallest;
}

Watch watched(const Model& model, double& crushed) {
  Workspace work(model, 1);
  State state = start(model, work);
  Watch watch;
  crushed = 1;
  while (!finished(model, state)) {
    const State before = state;
    step(model, state, work);
    watch.look(model, before, state);
    crushed = std::min(crushed, most_crushed(model, state));
  }
  return watch;
}

/// A block of 4 x 2 cm whose top comes down to a tenth of its height, between walls, in 200 us.
Case press(const Law& law) {
  constexpr double way = 0.018;
  const auto held = [](const char* side, std::optional<TimeTable> x, std::optional<TimeTable> y) {
    return SupportCase{.name = side, .nodes = {.body = "block", .side = side}, .move_x = x, .move_y = y};
  };
  const TimeTable still = TimeTable::constant(0);
  return {.run = {.end_time = 220e-6, .stop_at_energy_error = 1e9},
          .materials = {{.name = "steel", .density = 7850, .law = law}},
          .bodies = {{.name = "block",
                      .material = "steel",
                      .thickness = 0.01,
                      .mesh = RectangleMesh{.size = {0.04, 0.02}, .element_size = 0.00125}}},
          .supports = {held("bottom", {}, still), held("left", still, {}), held("right", still, {}),
                       held("top", {},
                            TimeTable{.times = {0, 200e-6}, .values = {0, -way}, .shape = TimeTable::Shape::smooth})}};
}

/// The same of one row, all nodes held, elastic: a rate law is not stable where principal stresses differ by more than
/// 2 G. `height` is what is left of it at `times`.
Case press_row(std::vector<double> times, const std::vector<double>& heights) {
  constexpr double size = 0.00125;
  Case input = press(elastic);
  std::get<RectangleMesh>(input.bodies[0].mesh).size = {0.4, size};
  TimeTable& way = *input.supports[3].move_y;
  way = {.times = std::move(times), .values = {}, .shape = TimeTable::Shape::smooth};
  for (const double height : heights) way.values.push_back((height - 1) * size);
  input.supports[0].move_x = input.supports[3].move_x = TimeTable::constant(0);
  return input;
}

}  // namespace

TEST_CASE("elements pressed to a tenth of their size: the limit is safe and close") {
  const Case cases[] = {press(plastic), press_row({0, 200e-6}, {1, 0.1}), press_row({0, 1e-4, 2e-4}, {1, 0.1, 1})};
  for (const Case& input : cases) {
    double crushed = 1;
    const Watch watch = watched(build_model(input), crushed);
    INFO(watch.text());
    CHECK(crushed < 0.1 * std::sqrt(2.0) + 1e-3);  // a height over the long side, which was turned
    CHECK(watch.too_large == 0);
    CHECK(watch.too_small == 0);
    CHECK(watch.too_long == 0);
  }
}

TEST_CASE("a block pressed against an obstacle with friction and dashpots, and let go") {
  for (const Integrator integrator : {Integrator::central_difference, Integrator::adams}) {
    Case input = press(plastic);
    input.run.integrator = integrator;
    input.run.damping = {.rate = 2000};
    input.contact.damping = 0.3;
    input.supports.erase(input.supports.begin(), input.supports.begin() + 3);
    input.supports[0].move_y = TimeTable{.times = {0, 150e-6, 220e-6}, .values = {0, -0.012, 0.002}};
    input.obstacles = {{.name = "stop", .shape = HalfPlane{}, .friction = 0.3}};
    double crushed = 1;
    const Watch watch = watched(build_model(input), crushed);
    INFO(watch.text());
    CHECK(crushed < 0.5);
    CHECK(watch.too_large == 0);
    CHECK(watch.too_small == 0);
    CHECK(watch.too_long == 0);
  }
}

TEST_CASE("a jump of a support: strains of 15 % in one step are not bounded but computed") {
  std::vector<double> times{0}, heights{1};
  for (int k = 0; k < 8; ++k) {
    const double before = heights.back();
    times.insert(times.end(), {1e-5 * (k + 1), 1e-5 * (k + 1) + 1e-10});
    heights.insert(heights.end(), {before, k < 6 ? 0.85 * before : 1.3 * before});
  }
  Case input = press_row(times, heights);
  input.run.end_time = 1e-4;
  double crushed = 1;
  const Watch watch = watched(build_model(input), crushed);
  INFO(watch.text());
  CHECK(crushed < 0.55);
  CHECK(watch.too_large == 0);
  CHECK(watch.too_long == 0);
}

TEST_CASE("a soft body far from limiting the step is crushed, or turned over, in a single one") {
  const auto beside_stiffer = [](double ratio, double height) {
    Case input = press_row({0, 1e-5, 1e-5 + 1e-10}, {1, 1, height});
    input.run.end_time = 2e-5;
    input.materials.push_back({.name = "stiff", .density = 7850, .law = elastic});
    std::get<Elastic>(input.materials.back().law).young_modulus *= ratio;
    input.bodies.push_back({.name = "stiff",
                            .material = "stiff",
                            .mesh = RectangleMesh{.size = {0.05, 0.00125}, .at = {0, 1}, .element_size = 0.00125}});
    input.contact_pairs = {{.body = "block", .other = "stiff", .touch = ContactPairCase::Touch::no}};
    return build_model(input);
  };
  double crushed = 1;
  const Watch watch = watched(beside_stiffer(5, 0.1), crushed);
  INFO(watch.text());
  CHECK(crushed < 0.15);
  CHECK(watch.too_large == 0);
  CHECK(watch.too_long == 0);
  CHECK(watch.cut > 0);
  // In the middle of the step all areas are still above 0.
  CHECK_THROWS_AS(watched(beside_stiffer(50, -0.5), crushed), NumericalError);
  CHECK(crushed > 0);  // in that very step, not in the next one
}

TEST_CASE("violent random motion: the limit stays safe") {
  Case input = falling_block(0.00125);
  input.run.when_unstable = WhenUnstable::carry_on;  // the books are of no interest here
  input.run.end_time = 1;
  const Model model = build_model(input);
  Workspace work(model, 1);
  State state = start(model, work);
  std::mt19937 random(5);
  const auto number = [&] { return 0x1p-31 * static_cast<double>(random()) - 1; };
  Watch watch;
  for (int i = 0; i < 500; ++i) {
    // Nodes are sent to random places up to 0.05 of a side from where they began: strains up to 0.2 in a step, here
    // more, there less.
    double reach = 0;
    for (Index n = 0; n < model.node_count; ++n) {
      if (n % 100 == 0) reach = 0.05 * 0.00125 / static_cast<double>(1 << random() % 9);
      NodeRecord& r = state.nodes[n];
      r.vx = (model.rest[n].x + reach * number() - r.x) / state.clock.next_step;
      r.vy = (model.rest[n].y + reach * number() - r.y) / state.clock.next_step;
    }
    const State before = state;
    step(model, state, work);
    watch.look(model, before, state);
  }
  INFO(watch.text());
  CHECK(watch.too_large == 0);
  CHECK(watch.too_long == 0);
  CHECK(watch.computed > 0);
  CHECK(watch.computed < watch.blocks);
}

TEST_CASE("a fixed step is shortened, or stops the run, when and only when the limit falls below it") {
  Case input = press_row({0, 200e-6}, {1, 0.1});
  Model model = build_model(input);
  Workspace work(model, 1);
  const double fixed = 0.7 * start(model, work).clock.limit.size;
  model.run.time_step = fixed;

  State state = start(model, work);
  while (!finished(model, state)) {
    step(model, state, work);
    const double exact = exact_limit(model, state);
    CHECK(state.clock.next_step <= exact * (1 + 1e-6));
    if (fixed > exact) CHECK(state.clock.following_step <= model.run.step_safety * exact * (1 + 1e-6));
    if (state.clock.shortened == 0 && state.clock.next_is_last == 0) CHECK(state.clock.next_step == fixed);
    if (fixed <= exact / slack) CHECK(state.clock.shortened == 0);
  }
  CHECK(state.clock.shortened > 0);

  model.run.when_unstable = WhenUnstable::stop;
  state = start(model, work);
  const auto run = [&] {
    while (!finished(model, state)) {
      step(model, state, work);
      CHECK(exact_limit(model, state) >= fixed);
    }
  };
  CHECK_THROWS_AS(run(), NumericalError);
  CHECK(exact_limit(model, state) < slack * fixed);
}

TEST_CASE("hardly any frequency is computed where elements are strained by a few percent") {
  double crushed = 1;
  const Watch watch = watched(build_model(falling_block(0.00125)), crushed);
  INFO(watch.text());
  CHECK(watch.too_large == 0);
  CHECK(watch.too_small == 0);
  CHECK(watch.computed < 0.1 * watch.blocks);
}

}  // namespace udar

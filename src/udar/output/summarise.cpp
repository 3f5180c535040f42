#include "udar/output/summarise.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "udar/output/observer.hpp"
#include "udar/output/thin_obstacles.hpp"

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
                  .ties = l.tie_energy,
                  .friction = l.friction_work.value(),
                  .dropped = l.dropped_energy.value(),
                  .damping = l.damped_energy(),
                  .gravity = l.book(ForceKind::gravity).work_now,
                  .loads = l.book(ForceKind::load).work_now,
                  .supports = l.book(ForceKind::support).work_now,
                  .obstacles = l.obstacle_work_now};
  s.total = l.total_energy();
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
  for (const ContactBook& obstacle : state.obstacles) s.obstacles += obstacle.total.impulse();
  s.error = s.end - s.start - s.obstacles - s.gravity - s.loads - s.supports - s.damping;
  return s;
}

SpinSummary spin_of(const State& state) {
  const Ledger& l = state.ledger;
  return {.start = l.start_spin,
          .end = l.spin,
          .obstacles = l.spin_book(SpinKind::obstacle).impulse.value(),
          .gravity = l.spin_book(SpinKind::gravity).impulse.value(),
          .loads = l.spin_book(SpinKind::load).impulse.value(),
          .supports = l.spin_book(SpinKind::support).impulse.value(),
          .damping = l.spin_book(SpinKind::damping).impulse.value(),
          .error = l.spin_balance()};
}

PenetrationSummary deepest_of(const Model& model, const State& state) {
  if (state.largest_penetration == 0) return {};
  const DeepestTouch& d = state.deepest;
  return {.depth = d.depth,
          .time = d.time,
          .place = d.place,
          .body = model.body_of_node(d.node).name,
          .into = d.into_body != 0 ? model.bodies[d.partner].name : model.obstacles[d.partner].name,
          .stiffness = d.stiffness};
}

void name_parts(const Model& model, Summary& s) {
  for (const Body& body : model.bodies) {
    s.masses[body.name] = body.mass;
    s.bodies.push_back({.name = body.name,
                        .rigid = body.rigid,
                        .elements = body.element_end - body.element_begin,
                        .nodes = body.node_end - body.node_begin});
  }
  for (const Obstacle& obstacle : model.obstacles) s.obstacles.push_back(obstacle.name);
}

/// By the names of their histories, which make_observers gives: energy, momentum, nodes, elements.
void tell_observed(const Model& model, Summary& s) {
  const std::vector<Observer> observers = make_observers(model);
  std::size_t next = 2;
  for (const NodeObserver& o : model.observed_nodes) {
    s.observed[observers[next++].name] = {
        .on = "node", .body = model.body_of_node(o.node).name, .number = model.node_numbers[o.node]};
  }
  for (const ElementObserver& o : model.observed_elements) {
    s.observed[observers[next++].name] = {
        .on = "element", .body = model.body_of_element(o.element).name, .number = model.element_numbers[o.element]};
  }
}

/// What a gap in the momentum books is compared with where the momentum of the start says nothing, kg m/s: the largest
/// sum of m |v| that the energy of the run allows (all pushes may balance) and the impulses (all may be held).
double momentum_at_stake(const Model& model, const State& state) {
  double mass = 0;
  for (const Body& body : model.bodies) mass += body.mass;
  double pushed = 0;
  for (const ForceBook& book : state.ledger.books) pushed += length(book.impulse());
  return std::sqrt(2 * mass * state.ledger.energy_scale()) + pushed;
}

/// The same for spin momentum about the origin, kg m2/s: all of the above at the arm of the farthest node.
double spin_at_stake(const Model& model, const State& state) {
  double arm = 0;
  for (Index i = 0; i < model.node_count; ++i) arm = std::max({arm, length(model.rest[i]), length(place(state, i))});
  return arm * momentum_at_stake(model, state);
}

/// The worst verdict so far and the reasons for it.
struct Judgement {
  enum Verdict { good, doubtful, bad };
  Verdict verdict = good;
  std::vector<std::string> reasons;

  void at_most(Verdict limit) { verdict = std::max(verdict, limit); }
  template <class... Values>
  void because(Verdict limit, fmt::format_string<Values...> reason, Values&&... values) {
    at_most(limit);
    reasons.push_back(fmt::format(reason, std::forward<Values>(values)...));
  }
  [[nodiscard]] const char* word() const {
    constexpr const char* words[] = {"good", "doubtful", "bad"};
    return words[verdict];
  }
};

void judge_stop(const Summary& s, Judgement& judgement) {
  if (s.stop_reason == "numerical" || s.stop_reason == "disk") judgement.at_most(Judgement::bad);
  if (s.stop_reason == "interrupted") judgement.at_most(Judgement::doubtful);
}

// Comparisons so that a number that is none is bad.
void judge_books(const Model& model, const State& state, const Summary& s, Judgement& judgement) {
  if (!(s.energy_error <= 0.001)) {
    judgement.because(
        s.energy_error <= 0.01 ? Judgement::doubtful : Judgement::bad,
        "the energy books are {:.3g} % apart (good: 0.1 %); a smaller `step_safety`, 0.5, or softer contact "
        "springs close them",
        100 * s.energy_error);
  }
  constexpr double rounding = 1e-9;
  if (!(state.ledger.momentum_gap <= rounding * momentum_at_stake(model, state))) {
    judgement.because(Judgement::bad, "the momentum books are {:.3g} of the momentum apart", s.momentum_error);
  }
  if (model.run.integrator != Integrator::central_difference) return;
  if (!(state.ledger.spin_gap <= rounding * spin_at_stake(model, state))) {
    judgement.because(Judgement::bad, "the books of the spin momentum are {:.3g} of it apart", s.spin_error);
  }
  if (!(s.identity_error <= rounding)) {
    judgement.because(Judgement::bad, "work on the nodes and their kinetic energy are {:.3g} of the energy apart",
                      s.identity_error);
  }
}

/// What a node sank into, in words, and the table of the case file with the stiffness of the springs between them.
struct Partner {
  std::string name;
  std::string key;
};

Partner partner_of(const Model& model, const State& state, const PenetrationSummary& deepest) {
  const std::string& body = deepest.body;
  const std::string& into = deepest.into;
  if (state.deepest.into_body == 0) return {fmt::format("obstacle `{}`", into), fmt::format("[obstacles.{}]", into)};
  std::string key = "[contact]";
  if (model.bodies.size() > 1) key = fmt::format("a [[contact.pairs]] of `{}` and `{}`", body, into);
  return {into == body ? "that body itself" : fmt::format("body `{}`", into), key};
}

/// Deep penetration does not open the books, so it is warned of but leaves the verdict as it is. A node that its own
/// mass carries into a spring k sinks by v sqrt(m / k), one that is pressed by what is behind it by f / k: the square
/// of what is wanted less is stiff enough for both. The size of elements hardly matters: f is a pressure times an edge,
/// and with automatic springs k = wave modulus x thickness.
void warn_of_penetration(const Model& model, const State& state, Summary& s) {
  s.warnings.clear();
  constexpr double too_deep = 0.05;
  // What failed has a message of its own, and another cure.
  if (s.penetration_ratio <= too_deep || s.stop_reason == "numerical") return;
  const double excess = s.penetration_ratio / too_deep;
  const PenetrationSummary& deepest = s.deepest_penetration;
  const Partner partner = partner_of(model, state, deepest);
  s.warnings.push_back(fmt::format(
      "a node of body `{}` sank into {} by {:.3g} % of an element ({:.3g} m) at ({:.4g}, {:.4g}) m, t = {:.4g} s: "
      "contact springs of {:.3g} N/m soften the impact; give {} a larger `stiffness`, up to {:.2g} N/m, and a smaller "
      "`step_safety` if the energy books then open",
      deepest.body, partner.name, 100 * s.penetration_ratio, deepest.depth, deepest.place.x, deepest.place.y,
      deepest.time, deepest.stiffness, partner.key, deepest.stiffness * excess * excess));
}

bool has_corners(const Model& model) {
  return std::any_of(model.obstacles.begin(), model.obstacles.end(),
                     [](const Obstacle& o) { return std::holds_alternative<PreparedPolygon>(o.prepared); });
}

void judge_steps(const Model& model, const State& state, const Summary& s, Judgement& judgement) {
  const Clock& clock = state.clock;
  if (clock.shortened > 0 && model.run.when_unstable == WhenUnstable::shorten) {
    judgement.because(Judgement::good,
                      "the fixed step was above the stable limit and was shortened in {} steps, first at t = {:.4g} s "
                      "by {}",
                      clock.shortened, s.time_step.first_shortened, s.time_step.first_shortened_by);
  }
  const bool continues = model.run.time_step && model.run.when_unstable == WhenUnstable::carry_on;
  if (continues && clock.shortened == 0) {
    judgement.because(Judgement::doubtful, "when_unstable = \"continue\" lets the step be above the stable limit");
  }
  if (continues && clock.shortened > 0) {
    judgement.because(Judgement::doubtful,
                      "the fixed step was above the stable limit in {} steps, up to {:.3g} times, first at t = {:.4g} "
                      "s by {}",
                      clock.shortened, clock.largest_excess, s.time_step.first_shortened,
                      s.time_step.first_shortened_by);
  }
  constexpr double crushed = 0.25;
  if (clock.tightest.size < crushed * clock.start_limit) {
    judgement.because(Judgement::good,
                      "{} was crushed: its stable step fell to {:.3g} % of the first one at t = {:.4g} s{}",
                      element_name(model, clock.tightest.element), 100 * clock.tightest.size / clock.start_limit,
                      clock.tightest_time, has_corners(model) ? "; corners of obstacles are felt by nodes only" : "");
  }
}

void judge_obstacles(const Model& model, const State& state, Judgement& judgement) {
  for (std::string& reason : obstacles_sunk_through(model, state)) {
    judgement.at_most(Judgement::doubtful);
    judgement.reasons.push_back(std::move(reason));
  }
}

}  // namespace

std::string element_name(const Model& model, Index element) {
  return fmt::format("{} element {}", model.body_of_element(element).name, model.element_numbers[element]);
}

std::string node_name(const Model& model, Index node) {
  return fmt::format("{} node {}", model.body_of_node(node).name, model.node_numbers[node]);
}

Summary summarise(const Model& model, const State& state) {
  const Clock& clock = state.clock;
  Summary s;
  s.elements = model.element_count;
  s.nodes = model.node_count;
  s.steps = static_cast<long long>(clock.step);
  s.end_time = clock.time.value();
  s.energy_error = state.ledger.energy_error();
  s.identity_error = state.ledger.identity_error();
  const double scale = state.ledger.momentum_scale > 0 ? state.ledger.momentum_scale : momentum_at_stake(model, state);
  s.momentum_error = scale > 0 ? state.ledger.momentum_gap / scale : 0;
  const double spin_scale = state.ledger.spin_scale > 0 ? state.ledger.spin_scale : spin_at_stake(model, state);
  s.spin_error = spin_scale > 0 ? state.ledger.spin_gap / spin_scale : 0;
  s.penetration_ratio = state.largest_penetration;
  s.deepest_penetration = deepest_of(model, state);
  name_parts(model, s);
  tell_observed(model, s);
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
  s.spin = spin_of(state);
  return s;
}

void judge(const Model& model, const State& state, Summary& s) {
  Judgement judgement{.reasons = std::move(s.reasons)};
  judge_stop(s, judgement);
  judge_books(model, state, s, judgement);
  warn_of_penetration(model, state, s);
  judge_obstacles(model, state, judgement);
  judge_steps(model, state, s, judgement);
  s.verdict = judgement.word();
  s.reasons = std::move(judgement.reasons);
}

}  // namespace udar

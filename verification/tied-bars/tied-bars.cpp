// tied-bars: a wave through a tie between meshes that do not match, and an even pull across it. See README.md.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

constexpr double push = 1e-6;              // Pa
constexpr double rise = 2;                 // s, or m: the wave speed is 1 m/s
constexpr double to_tie = 10;              // m, from the pushed end
constexpr double gauge = 2.5;              // m, on both sides of the tie
constexpr double steepest = 1.875 / rise;  // 1/s, of the rise 10 s^3 - 15 s^4 + 6 s^5

struct Passage {
  Record before;  // stress at the left gauge over the push, -1 when all has arrived
  Record after;   // at the right one
  double momentum = 0;
  double energy = 0;
  double identity = 0;
};

/// The elements in the columns about a gauge.
std::vector<Index> elements_at(const Model& model, const Body& body, double x, double half_width) {
  std::vector<Index> found;
  for (Index e = body.element_begin; e < body.element_end; ++e) {
    if (std::fabs(rest_centroid(model, e).x - x) < half_width) found.push_back(e);
  }
  return found;
}

/// Their mean stress along the bar over the push.
double stress_at(const State& state, const std::vector<Index>& elements) {
  double sum = 0;
  for (const Index e : elements) sum += state.stress_xx[e];
  return sum / (push * static_cast<double>(elements.size()));
}

/// Cells of the left and of the right bar; impedance of the right one, that of the left is 1 kg/(m2 s).
Passage pass(double left, double right, double impedance = 1) {
  Case input = load("tied-bars/tied-bars.toml");
  std::get<RectangleMesh>(input.bodies[0].mesh).element_size = left;
  std::get<RectangleMesh>(input.bodies[1].mesh).element_size = right;
  input.materials[1].density = impedance;
  std::get<Elastic>(input.materials[1].law).young_modulus = impedance;
  Run run(input);
  const auto before = elements_at(run.model, run.model.bodies[0], -gauge, left);
  const auto after = elements_at(run.model, run.model.bodies[1], gauge, right);
  Passage p;
  run.run([&](const Run& now) {
    p.before.add(now.time(), stress_at(now.state, before));
    p.after.add(now.time(), stress_at(now.state, after));
  });
  p.momentum = momentum_error(run);
  p.energy = run.state.ledger.energy_error();
  p.identity = run.state.ledger.identity_error();
  return p;
}

/// What the mesh smears of the rise r: to first order l^3 r''' / 3 with Airy's length l, and |r'''| <= 60 / rise^3.
double smeared(double element_size, double way) {
  const double l = airy_length(element_size, way);
  return 20 * l * l * l / (rise * rise * rise);
}

/// Largest stress that comes back from a layer of springs with the delay `tau` = Z / (2 k): -tau s' - s_r = tau s_r',
/// s the stress that arrives.
double largest_reflection(double tau) {
  const auto slope = [](double t) {
    const double s = t / rise;
    return s > 0 && s < 1 ? 30 * s * s * (1 - s) * (1 - s) / rise : 0.0;
  };
  double largest = 0;
  double now = 0;
  const double h = 1e-3 * tau;
  for (double t = 0; t < 2 * rise; t += h) {
    now += h * (slope(t + 0.5 * h) - now / tau);
    largest = std::max(largest, now);
  }
  return largest;
}

/// How much less the left gauge shows while the front comes back from the tie.
double reflected(const Passage& p) {
  double most = 0;
  for (std::size_t k = 0; k < p.before.times.size(); ++k) {
    const double t = p.before.times[k];
    if (t < to_tie + gauge || t > to_tie + gauge + 2 * rise) continue;
    most = std::max(most, 1 + p.before.values[k]);
  }
  return most;
}

void check_books(Checks& checks, const Passage& p) {
  checks.at_most("momentum", p.momentum, 1e-12);
  checks.at_most("identity", p.identity, 1e-11);
  checks.at_most("energy error", p.energy, 1e-3);
}

/// Time at which half of what goes through passes the right gauge, s.
double arrival(const Passage& p) { return p.after.passes(-0.5); }

/// What dispersion may make of an arrival, s: as in `waves`.
double late(double left, double right) {
  const auto part = [](double h) { return std::pow(std::numbers::pi * h / rise, 2) / 8; };
  return to_tie * part(left) + gauge * part(right);
}

/// The push as it passes a place without a tie.
CheckLine arriving(const char* name, double way, const std::vector<double>& times) {
  CheckLine line{.name = name, .exact = true, .x = times, .y = {}};
  for (const double t : times) {
    const double part = std::clamp((t - way) / rise, 0.0, 1.0);
    line.y.push_back(-part * part * part * (10 - 15 * part + 6 * part * part));
  }
  return line;
}

void check_equal(Checks& checks) {
  const double h = 0.05;
  const Passage p = pass(h, h);
  const double tau = 0.5 * h;
  checks.within("stress behind the tie, over the push", p.after.mean(15.5, 18), -1, smeared(h, to_tie + gauge));
  const double wave = 2 * std::numbers::pi / rise;  // 1/m, of the pulse that comes back
  const double bound = std::pow(wave * h, 2) * (wave * (to_tie + gauge) / 24 + 1.0 / 8);
  checks.within("largest stress sent back, over the push", reflected(p), largest_reflection(tau), bound);
  const double delay = arrival(p) - (to_tie + gauge + 0.5 * rise);
  checks.between("delay", delay, tau - late(h, h), tau + late(h, h), "s");
  check_books(checks, p);
  checks.curve({.title = "Stress at the gauges, 2.5 m before and behind the tie",
                .y_label = "stress over the push",
                .lines = {{.name = "before", .x = p.before.times, .y = p.before.values},
                          {.name = "behind", .x = p.after.times, .y = p.after.values},
                          arriving("exact before, without what comes back", to_tie - gauge, p.before.times),
                          arriving("exact behind, without the delay", to_tie + gauge, p.after.times)}});
}

void check_unequal(Checks& checks) {
  for (const auto& cells : {std::pair{0.05, 0.02}, {0.02, 0.05}, {0.05, 0.03}}) {
    const double left = cells.first;
    const double right = cells.second;
    checks.setting(fmt::format("{} m, {} m", left, right));
    const Passage p = pass(left, right);
    const double h = std::max(left, right);
    // Between all springs, which share the load evenly at the least compliance, and half of them.
    const double tau = 0.5 * h;
    checks.within("stress behind the tie, over the push", p.after.mean(15.5, 18), -1, smeared(h, to_tie + gauge));
    const double back = reflected(p);
    checks.at_most("largest stress sent back, over the push", back, 2 * tau * steepest);
    const double delay = arrival(p) - (to_tie + gauge + 0.5 * rise);
    checks.between("delay", delay, tau - late(left, right), 2 * tau + late(left, right), "s");
    check_books(checks, p);
  }
}

void check_order(Checks& checks) {
  ErrorSeries back{.what = "largest stress sent back"};
  for (const double h : {0.2, 0.1, 0.05}) back.add(h, reflected(pass(h, 0.4 * h)));
  checks.order(back, {.expected = 1, .least = 0.9});
}

void check_materials(Checks& checks) {
  for (const double impedance : {0.25, 4.0}) {
    checks.setting(fmt::format("Z2 / Z1 = {}", impedance));
    const double through = 2 * impedance / (1 + impedance);
    const Passage p = pass(0.05, 0.02, impedance);
    const double bound = smeared(0.05, to_tie + gauge) * std::max(1.0, 1 / through);
    checks.within("stress behind the tie, over the push", p.after.mean(15.5, 18), -through, bound);
    checks.within("stress before the tie, over the push", p.before.mean(15.5, 18), -through, bound);
    check_books(checks, p);
  }
}

void check_pull(Checks& checks) {
  constexpr double away = 0.3;  // m
  ErrorSeries all{.what = "stress error, L2"};
  ErrorSeries far{.what = "stress error 0.3 m away"};
  for (const double h : {0.1, 0.05, 0.025}) {
    Case input = load("tied-bars/patch.toml");
    std::get<RectangleMesh>(input.bodies[0].mesh).element_size = h;
    std::get<RectangleMesh>(input.bodies[1].mesh).element_size = 0.4 * h;
    Run run(input);
    run.run();
    const double pull = 1e-6;
    all.add(h, stress_error(run, [&](Vec2) { return SymTensor<double>{0, pull, 0, 0}; }).relative());
    double worst = 0;
    double worst_of_all = 0;
    for (const Body& body : run.model.bodies) {
      for (Index e = body.element_begin; e < body.element_end; ++e) {
        const SymTensor<double> s = stress_of(run.state, e);
        const double error = std::max({std::fabs(s.xx), std::fabs(s.yy - pull), std::fabs(s.xy)});
        worst_of_all = std::max(worst_of_all, error);
        if (std::fabs(rest_centroid(run.model, e).y) >= away) worst = std::max(worst, error);
      }
    }
    checks.setting(fmt::format("{} m", h));
    // A node has between nothing and twice its even part of the pull.
    checks.at_most("stress off at the tie, over the pull", worst_of_all / pull, 1);
    // Wrong are forces of up to pull h / 2 at nodes, h apart: couples, whose stress falls as 1 / d^2.
    checks.at_most("stress off 0.3 m away, over the pull", worst / pull, h * h / (away * away));
    far.add(h, worst / pull, h * h / (away * away));
  }
  checks.order(all, {.expected = 0.5, .least = 0.45});
  checks.order(far, {.expected = 2, .least = 1.8});
}

}  // namespace

Problem tied_bars() {
  return {.topic = Topic::waves,
          .parts = {{"equal meshes, node on node", check_equal},
                    {"coarse to fine and fine to coarse", check_unequal},
                    {"what a tie sends back falls with the mesh", check_order},
                    {"two materials", check_materials},
                    {"an even pull across a tie", check_pull}}};
}

}  // namespace udar::verification

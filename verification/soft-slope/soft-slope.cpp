// soft-slope: a block slides on a slope that is a body as well, against Coulomb's law. See README.md.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "run.hpp"
#include "udar/step/motion.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

constexpr double g = 9.81;  // m/s2
constexpr double degree = std::numbers::pi / 180;
constexpr double density = 7850;  // kg/m3

/// A block on a slope of the same soft material.
struct SoftSlope {
  double angle = 30 * degree;
  double friction = 0.2;
  double young = 1e6;          // Pa
  double element_size = 0.02;  // m, of the slope
  double step_safety = 0.9;

  static constexpr double depth = 0.04;  // m, of the slope
  static constexpr double block_length = 0.1;
  static constexpr double height = 0.02;        // m, of the block
  static constexpr double cell = 0.01;          // m, of the block
  static constexpr double before_block = 0.15;  // m of slope behind the block

  [[nodiscard]] Elasticity elasticity() const { return elasticity_of(young, 0.3); }
  [[nodiscard]] double shear_speed() const { return std::sqrt(elasticity().shear_modulus / density); }
  [[nodiscard]] double pressure_speed() const { return std::sqrt(elasticity().wave_modulus() / density); }
  [[nodiscard]] double acceleration() const { return g * (std::sin(angle) - friction * std::cos(angle)); }
  [[nodiscard]] Vec2 down() const { return {std::cos(angle), -std::sin(angle)}; }
  [[nodiscard]] double pressed() const { return g * std::cos(angle); }  // m/s2
  /// Strain of the slope under the block.
  [[nodiscard]] double strain() const { return density * pressed() * height / elasticity().wave_modulus(); }
  [[nodiscard]] double slope_cell() const { return depth / std::round(depth / element_size); }

  [[nodiscard]] Case to_case() const {
    Case c = load("soft-slope/soft-slope.toml");
    c.run.step_safety = step_safety;
    c.run.damping.rate *= std::sqrt(young / 1e6);
    c.contact.friction = friction;
    std::get<Elastic>(c.materials[0].law).young_modulus = young;
    auto& block = std::get<RectangleMesh>(c.bodies[0].mesh);
    // The softer elements, half each from both sides, carry the weight.
    block.at = -strain() * std::max(cell, slope_cell()) * perpendicular(down());
    auto& slope = std::get<RectangleMesh>(c.bodies[1].mesh);
    slope.at = -depth * perpendicular(down()) - before_block * down();
    slope.element_size = element_size;
    block.turn = slope.turn = -angle;
    return c;
  }
};

/// Impulses on the block, added up over its touches, N s.
struct Pushes {
  Vec2 normal{};
  Vec2 friction{};
  Vec2 missed{};    ///< normal forces in steps in which a touch begins: friction begins with the next one
  double time = 0;  ///< s, from the middle of a step to the middle of a later one
};

void note_touches(const Run& run, Pushes& p) {
  p.time += velocity_span(run.state.clock);
  for (const BodyTouch& touch : run.state.touches) {
    const double sign = run.model.contact_bodies[touch.point] == 0 ? 1 : -1;
    const double span = sign * velocity_span(run.state.clock);
    p.normal += span * touch.springs.normal_force;
    p.friction += span * touch.springs.friction_force;
    if (touch.springs.friction_force == Vec2{}) p.missed += span * touch.springs.normal_force;
  }
}

/// Velocity of the block that its impulses belong to, m/s.
Vec2 block_velocity(const Run& run) { return (1 / run.model.bodies[0].mass) * run.state.body_momentum[0]; }

double block_way(const Run& run, Vec2 down) {
  Vec2 sum;
  const Body& block = run.model.bodies[0];
  for (Index i = block.node_begin; i < block.node_end; ++i) sum += run.model.mass[i] * run.displacement(i);
  return dot(sum, down) / block.mass;
}

/// How far from constant the acceleration of the block may be over a window, m/s2.
struct Allowance {
  /// The slope, pressed together by `strain`, falls by strain x depth on a way of a depth or more before and behind the
  /// block, more by 1 / (1 - (v / c_R)^2) under a moving one: normal forces lean by so much at most, which only waves
  /// and damping keep from being the same on both sides.
  double lean = 0;
  /// Nodes of the slope come and go under the block, each carries slope_cell / 2 of the block's length (the block's
  /// nodes carry the other half): depth changes by this part, and Coulomb's force by mu m dv_n / window.
  double hop = 0;
};

Allowance allowance(const SoftSlope& s, double speed, double window) {
  const double rayleigh = 0.927 * s.shear_speed();
  const double part = 0.5 * s.slope_cell() / SoftSlope::block_length;
  const double sinks =
      s.strain() * (std::max(SoftSlope::cell, s.slope_cell()) + SoftSlope::depth + 0.5 * SoftSlope::height);
  return {.lean = s.strain() * s.pressed() / (1 - speed * speed / (rayleigh * rayleigh)),
          .hop = 2 * s.friction * part * std::sqrt(s.pressed() * sinks) / window};
}

void check_soft_slide(Checks& checks, const SoftSlope& s, const std::string& setting) {
  checks.setting(setting);
  constexpr double half = 0.5;     // s
  constexpr double window = 0.05;  // s
  Run run(s.to_case());
  const Vec2 down = s.down();
  const double exact = s.acceleration();
  const double mass = run.model.bodies[0].mass;
  Pushes late;
  double last_time = 0, least = 1e9, most = -1e9, largest_step = 0;
  Vec2 half_velocity, last_velocity;
  std::size_t fewest = 1000;
  CheckLine speeds{.name = "computed", .x = {}, .y = {}};
  while (!run.done()) {
    run.step();
    speeds.x.push_back(run.time());
    speeds.y.push_back(dot(block_velocity(run), down));
    if (run.time() < half) continue;
    if (last_time == 0) {
      last_time = run.time();
      half_velocity = last_velocity = block_velocity(run);
      continue;
    }
    note_touches(run, late);
    fewest = std::min(fewest, run.state.touches.size());
    largest_step = std::max(largest_step, run.state.clock.last_step);
    if (run.time() < last_time + window) continue;
    const double a = dot(block_velocity(run) - last_velocity, down) / (run.time() - last_time);
    least = std::min(least, a);
    most = std::max(most, a);
    last_time = run.time();
    last_velocity = block_velocity(run);
  }
  const double time = late.time;
  const Vec2 change = block_velocity(run) - half_velocity;
  const double acceleration = dot(change, down) / time;
  const double speed = dot(block_velocity(run), down);
  const double missed = s.friction * length(late.missed) / (mass * time);
  // The way with the friction missing until the column of slope and block has swung down, and until the block is
  // faster than the slope can swing.
  const double swing = (SoftSlope::depth + SoftSlope::height) / s.shear_speed();
  const double build_up = swing * std::max(1.0, g * std::sin(s.angle) / exact);
  // A node of the slope meets the front of the block at a depth of twice the static one at most.
  const double mean_speed = 0.5 * (speed + dot(half_velocity, down));
  const double begun = s.friction * s.pressed() * mean_speed * largest_step / SoftSlope::block_length;
  const Allowance whole = allowance(s, speed, time);
  const Allowance part = allowance(s, speed, window);
  const double lag = s.friction * s.pressed() * build_up + begun * time;
  const double way = block_way(run, down);
  // To rounding: impulses, and friction mu times the normal force in every touch.
  const Vec2 weight = mass * time * run.model.run.gravity;
  const Vec2 coulomb = s.friction * perpendicular(late.normal - late.missed);
  checks.at_most("momentum less weight and impulses, over the weight",
                 length(mass * change - weight - late.normal - late.friction) / length(weight), 1e-12);
  checks.at_most("friction impulse less mu times normal impulse, but where a touch begins, over the weight",
                 length(late.friction - coulomb) / length(weight), 1e-12);
  // The slope's bends and hops of the block, and what friction misses.
  checks.at_most("acceleration by friction that has not begun", missed, begun, "m/s^2");
  checks.near("the rest of the acceleration", acceleration - missed, exact, whole.lean + whole.hop, "m/s^2");
  checks.at_least("least acceleration over 0.05 s", least, exact - part.lean - part.hop, "m/s^2");
  checks.at_most("largest acceleration over 0.05 s", most, exact + part.lean + part.hop + 2 * begun, "m/s^2");
  checks.between("way in 1 s", way, 0.5 * exact - 0.5 * whole.lean, 0.5 * exact + lag + 0.5 * whole.lean, "m");
  // Nothing is shut out, and the run calls its books good.
  checks.at_least("touches at any time", static_cast<double>(fewest), 11);
  checks.at_most("energy error", run.state.ledger.energy_error(), 1e-3);
  checks.at_most("identity of work", run.state.ledger.identity_error(), 1e-11);
  if (s.element_size != 0.02 || s.young != 1e6 || s.step_safety != 0.9) return;
  const double end = speeds.x.back();
  checks.curve({.title = "Velocity of the block, " + setting,
                .y_label = "velocity",
                .y_unit = "m/s",
                .lines = {speeds, {.name = "exact", .exact = true, .x = {0, end}, .y = {0, exact * end}}}});
}

void check_slides(Checks& checks) {
  check_soft_slide(checks, {}, "30 deg, mu = 0.2");
  check_soft_slide(checks, {.angle = 20 * degree, .friction = 0.3}, "20 deg, mu = 0.3");
}

void check_sticking(Checks& checks) {
  const SoftSlope slope{.friction = 0.6};
  Run run(slope.to_case());
  const Vec2 down = slope.down();
  double half_way = -1, lowest = 1, highest = -1;
  std::uint64_t late_slides = 0;
  Pushes late;
  while (!run.done()) {
    run.step();
    if (run.time() < 0.5) continue;
    const double now = block_way(run, down);
    if (half_way < 0) {
      half_way = now;
      continue;
    }
    note_touches(run, late);
    lowest = std::min(lowest, now);
    highest = std::max(highest, now);
    for (const BodyTouch& touch : run.state.touches) late_slides += touch.springs.slides;
  }
  const double weight = run.model.bodies[0].mass * g;
  const double along = -dot(late.normal + late.friction, down) / late.time;
  // Friction is missing until the column of slope and block has swung down, and what the normal force lacks until it
  // has sunk; the speed gained is lost at mu g cos - g sin, which is little.
  const double column = SoftSlope::depth + SoftSlope::height;
  const double swing = column / slope.shear_speed();
  const double sink = column / slope.pressure_speed();
  const double gained = g * std::sin(slope.angle) * swing + slope.friction * slope.pressed() * sink;
  const double bound = gained * swing + 0.5 * gained * gained / -slope.acceleration();
  checks.equal("touch-steps of sliding after 0.5 s", static_cast<double>(late_slides), 0);
  checks.above("way in the first 0.5 s", half_way, 0, "m");
  checks.below("the same, against what the start costs", half_way, bound, "m");
  checks.at_most("way after 0.5 s, over the height", (highest - lowest) / SoftSlope::height, 1e-9);
  checks.within("force of the slope along it, over the weight", along / weight, std::sin(slope.angle), 1e-6);
}

void check_meshes(Checks& checks) {
  for (const double size : {0.04, 0.013, 0.01, 0.005}) {
    check_soft_slide(checks, {.element_size = size}, fmt::format("elements of {} cm", 100 * size));
  }
}

void check_others(Checks& checks) {
  check_soft_slide(checks, {.young = 4e6}, "E = 4 MPa");
  check_soft_slide(checks, {.step_safety = 0.45}, "half the step");
  check_soft_slide(checks, {.angle = 20 * degree, .friction = 0.3, .element_size = 0.005},
                   "20 deg, mu = 0.3, elements of 0.5 cm");
}

}  // namespace

Problem soft_slope() {
  return {.topic = Topic::friction,
          .parts = {{"sliding at 30 and 20 degrees", check_slides},
                    {"sticking", check_sticking},
                    {"meshed coarser, finer and as the block", check_meshes},
                    {"stiffer, in shorter steps, on a flatter slope", check_others}}};
}

}  // namespace udar::verification

#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "tools.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {

constexpr double shear_limit = 200e6;                                    // Pa, k
constexpr double limit_pressure = (2 + std::numbers::pi) * shear_limit;  // Pa (Prandtl 1920, Hill 1950)
constexpr double geometry_gain = 4 / (2 + std::numbers::pi);             // per depth over half-width: see README.md
constexpr double at_rest = 0.002;                                        // of the force: damping and waves

/// The case file with changes.
struct Punch {
  double cell = 1e-3;  ///< m, finest ones
  RectangleMesh::Diagonals diagonals = RectangleMesh::Diagonals::crossed;
  double past = 0.05;   ///< cells from the last node under the punch to its end
  double stiffer = 1;   ///< Young's modulus and density by this factor, depth and velocity by 1 / it
  double friction = 1;  ///< of the punch
  bool corners = true;  ///< its corner pushes the boundary between nodes
  bool graded = true;
  bool elastic = false;
  bool both_halves = false;  ///< not the right one only
  double larger = 1;         ///< block, and time and depth with it

  [[nodiscard]] double half_width() const { return 0.01 + past * cell; }                    ///< m
  [[nodiscard]] double height() const { return 0.096 * larger; }                            ///< m, of the block
  [[nodiscard]] double width() const { return 0.08 * larger; }                              ///< m, of its half
  [[nodiscard]] double time() const { return 1.34e-3 * larger; }                            ///< s
  [[nodiscard]] double velocity() const { return 0.5 / stiffer * (larger > 1 ? 0.7 : 1); }  ///< m/s
  [[nodiscard]] double depth() const { return velocity() * time(); }                        ///< m, at the end
  /// Depth to which a pressure presses a smooth punch into the elastic block, m. The block with held sides and a smooth
  /// bottom is a layer with a row of punches 2 W apart: each cosine of the pressure, k = n pi / W, presses it in by
  /// 2 / (E' k) F(k H), F(x) = (cosh 2x - 1) / (sinh 2x + 2x), its mean by H / (lambda + 2 G). With the pressure under
  /// a punch on a half-plane, P / (pi sqrt(b^2 - x^2)), whose cosines are J0(k b); that it is not quite so counts in
  /// second order.
  [[nodiscard]] double elastic_depth(double pressure, double wider = 0) const {
    const double young = 200e9 * stiffer;
    const double b = half_width() + wider;
    double sum = height() / wave_modulus();
    for (int n = 1; n < 20000; ++n) {
      const double k = n * std::numbers::pi / width();
      const double x = std::min(k * height(), 20.0);
      const double layer = (std::cosh(2 * x) - 1) / (std::sinh(2 * x) + 2 * x);
      const double share = std::cyl_bessel_j(0, k * b);
      sum += 4 * (1 - 0.3 * 0.3) / (young * k) * layer * share * share;
    }
    // The same force, whatever the width that takes it.
    return pressure * half_width() / width() * sum;
  }

  /// How much deeper the springs of contact let the punch go under such a pressure, m. Each holds the force of that
  /// pressure on its part l of the surface; crossed cells have springs of 2 (lambda + 2 G) l/h.
  [[nodiscard]] double spring_depth(double pressure) const {
    const double b = half_width();
    const double quarter = 0.5 * std::numbers::pi;
    double sum = 0;
    for (double x = 0; x < b; x += cell) {
      const double from = std::max(0.0, x - 0.5 * cell);
      const double to = x + 0.5 * cell;
      const double end = x + cell > b ? b : to;  // of what this node takes
      const double share = (std::asin(end / b) - std::asin(from / b)) / quarter;
      sum += share * share / (to - from);
    }
    return pressure * b * sum * cell / (2 * wave_modulus());
  }
  [[nodiscard]] double wave_modulus() const {  ///< Pa, lambda + 2 G
    return 200e9 * stiffer * (1 - 0.3) / ((1 + 0.3) * (1 - 2 * 0.3));
  }

  [[nodiscard]] Case input() const {
    Case out = load("prandtl/prandtl.toml");
    out.run.end_time = time();
    auto& mesh = std::get<RectangleMesh>(out.bodies[0].mesh);
    mesh.diagonals = diagonals;
    mesh.finest_size = cell;
    mesh.size = {width(), height()};
    mesh.at = {0, -height()};
    if (!graded) {
      mesh.element_size = cell;
      mesh.finest_size.reset();
      mesh.finest_at.reset();
      mesh.finest_within = 0;
    }
    auto& law = std::get<Tresca>(out.materials[0].law);
    law.young_modulus *= stiffer;
    out.materials[0].density *= stiffer;
    if (elastic) out.materials[0].law = Elastic{law.young_modulus, law.poisson_ratio};
    ObstacleCase& punch = out.obstacles[0];
    punch.friction = friction;
    punch.velocity.y = -velocity();
    punch.corners = corners;
    auto& shape = std::get<Rectangle>(punch.shape);
    shape.size.x = half_width() - shape.at.x;
    if (both_halves) {
      mesh.size.x *= 2;
      mesh.at.x = -width();
      shape.at.x = -half_width();
      shape.size.x = 2 * half_width();
      out.supports[1].name = "left";
    }
    return out;
  }
};

struct Pressed {
  double pressure = 0;      ///< Pa, mean over the last twentieth of the way
  double rise = 0;          ///< of the pressure over the last tenth of the way, against that of the elastic block
  double unbalanced = 0;    ///< force of the punch less that of the bottom, over the first
  double kinetic = 0;       ///< over internal energy, the largest from half the limit pressure on
  double energy_error = 0;  ///< as in the summary
  double mirror_error = 0;  ///< of the velocities, of both halves
};

inline double force_of_bottom(const Run& run) {
  double force = 0;
  for (std::size_t i = 0; i < run.model.supports[0].nodes.size(); ++i) force += run.state.support_forces[i].y;
  return force;
}

inline Pressed press(const Punch& punch) {
  const Case input = punch.input();
  Run run(input);
  const double area = punch.half_width() * (punch.both_halves ? 2 : 1);
  Record pressure, bottom;
  Pressed out;
  run.run([&](const Run& now) {
    pressure.add(now.time(), -now.state.obstacles[0].total.force.y / area);
    bottom.add(now.time(), force_of_bottom(now) / area);
    const Ledger& ledger = now.state.ledger;
    if (pressure.values.back() < 0.5 * limit_pressure) return;
    out.kinetic = std::max(out.kinetic, ledger.kinetic_energy / ledger.stress_work.value());
  });
  const double end = input.run.end_time;
  out.pressure = pressure.mean(0.95 * end, end);
  const double before = pressure.mean(0.85 * end, 0.9 * end);
  out.rise = (out.pressure - before) / (0.1 * punch.depth() / punch.elastic_depth(1));
  out.unbalanced = std::fabs(out.pressure - bottom.mean(0.95 * end, end)) / out.pressure;
  out.energy_error = run.state.ledger.energy_error();
  if (punch.both_halves) out.mirror_error = mirror_error(run, true, 0, punch.width());
  return out;
}

struct Loaded {
  double depth = 0;     ///< m, at the end, or where it passed twice that of the punch
  double velocity = 0;  ///< m/s, downwards
  double pressure = 0;  ///< Pa, force between the bodies over the width
  double tilt = 0;      ///< rad
  double time = 0;      ///< s
};

/// A rigid body of steel, half as high as wide, in place of the punch. A pressure on its top grows smoothly to `part`
/// of the limit in 0.8 ms and stays.
inline Loaded load_body(const Punch& punch, double part) {
  Case input = punch.input();
  const double b = punch.half_width();
  input.contact.friction = input.obstacles[0].friction;
  input.obstacles.clear();
  input.bodies.push_back({.name = "punch",
                          .material = "steel",
                          .rigid = true,
                          .mesh = RectangleMesh{.size = {2 * b, b}, .at = {-b, 0}, .element_size = punch.cell}});
  LoadCase load{.name = "press", .kind = LoadCase::Kind::pressure, .pressure = part * limit_pressure};
  load.where.body = "punch";
  load.where.side = "top";
  load.factor = {{0, 0.8e-3}, {0, 1}, TimeTable::Shape::smooth};
  input.loads.push_back(load);
  Run run(input);
  Loaded out;
  while (!run.done() && out.depth < 2 * punch.depth()) {
    run.step();
    out.depth = 0.5 * b - run.state.rigid[0].place.y;
  }
  out.velocity = -run.state.rigid[0].velocity.linear.y;
  out.tilt = run.state.rigid[0].angle;
  out.time = run.time();
  for (const PairBook& pair : run.state.pairs) {
    if (pair.first != pair.second) out.pressure = std::fabs(pair.book.total.force.y) / (2 * b);
  }
  return out;
}

}  // namespace udar::verification

// free-turn: bodies that turn rigidly keep their stress; a beam thrown with spin. See README.md.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "run.hpp"
#include "udar/step/stages.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

constexpr double young = 200e9;  // Pa
constexpr double two_pi = 2 * std::numbers::pi;

Case turning(double angle_per_step, int steps) {
  Case c = load("free-turn/free-turn.toml");
  const double h = *c.run.time_step;
  c.run.end_time = h * steps;
  for (SupportCase& s : c.supports) {
    s.turn->times = {0, 2 * c.run.end_time};
    s.turn->values = {0, 2 * angle_per_step * steps};
  }
  return c;
}

struct Turned {
  double stressed = 0;  // largest difference from R s0 R^T, over E
  double free = 0;      // largest stress of the free square, over E
  double area = 0;      // largest relative change of an area
  double place = 0;     // m, largest distance of a node from where the turn carries it
};

Turned turn_squares(double angle_per_step, int steps) {
  Run run(turning(angle_per_step, steps));
  // A stress of the order of E, so that 1e-12 of it stands above the rounding of strains, 1e-16 E.
  const SymTensor<double> s0{60e9, -30e9, 20e9, 10e9};
  const Body& stressed = run.model.bodies[0];
  run.state = rest_state(run.model);
  for (Index e = stressed.element_begin; e < stressed.element_end; ++e) {
    run.state.stress_xx[e] = s0.xx;
    run.state.stress_yy[e] = s0.yy;
    run.state.stress_xy[e] = s0.xy;
    run.state.stress_zz[e] = s0.zz;
  }
  prepare(run.model, run.state, run.work);

  Turned out;
  for (int n = 1; n <= steps; ++n) {
    run.step();
    const Turn turn = turn_by(angle_per_step * n);
    const State& s = run.state;
    for (const Body& body : run.model.bodies) {
      const bool is_stressed = &body == &stressed;
      const SymTensor<double> exact = is_stressed ? turned(s0, turn) : SymTensor<double>{};
      for (Index e = body.element_begin; e < body.element_end; ++e) {
        const double off = std::max({std::fabs(s.stress_xx[e] - exact.xx), std::fabs(s.stress_yy[e] - exact.yy),
                                     std::fabs(s.stress_xy[e] - exact.xy), std::fabs(s.stress_zz[e] - exact.zz)});
        double& worst = is_stressed ? out.stressed : out.free;
        worst = std::max(worst, off / young);
        const auto place = [&](int corner) {
          const NodeRecord& r = s.nodes[run.model.corners[e][corner]];
          return Vec2{r.x, r.y};
        };
        out.area = std::max(out.area, std::fabs(twice_area(place(0), place(1), place(2)) - 1));  // m2: half a square
      }
      for (Index i = body.node_begin; i < body.node_end; ++i) {
        out.place = std::max(out.place, length(Vec2{s.nodes[i].x, s.nodes[i].y} - turn * run.model.rest[i]));
      }
    }
  }
  return out;
}

void check_squares(Checks& checks) {
  for (const double angle : {1e-3, 0.01, 0.1, 1.0, 2.5, -0.7}) {
    const int steps = std::max(200, static_cast<int>(3 * two_pi / std::fabs(angle)));
    const Turned t = turn_squares(angle, steps);
    checks.setting(fmt::format("{} steps of {} rad", steps, angle));
    // Exact in real numbers for any angle below pi. In rounded ones the same turn errs the same way in every step: up
    // to 4.4e-16 in c^2 + s^2, so of the largest principal stress, 0.32 E. That passes 1e-12 E after 7000 steps.
    checks.at_most("stress off R s0 R^T, over E", t.stressed, std::max(1e-12, 4.4e-16 * 0.32 * steps));
    checks.at_most("stress of the free square, over E", t.free, 1e-12);
    checks.at_most("relative change of area", t.area, 1e-12);
    checks.at_most("nodes off their circle", t.place, 1e-12, "m");
  }
}

void check_thrown(Checks& checks) {
  Run run(load("free-turn/thrown-beam.toml"));
  const Body& body = run.model.bodies[0];
  const double end = run.model.run.end_time;
  const Vec2 momentum = run.state.ledger.momentum;
  const double spin = run.state.ledger.spin;
  double spin_drift = 0, momentum_drift = 0;

  /// Means over a quarter of the flight: of the volume's trace of stress, its virial exact value, and the largest
  /// shear.
  struct Quarter {
    double time = 0, trace = 0, twice_kinetic = 0, shear = 0, twice_spin_energy = 0;
  };
  Quarter quarters[4];
  struct Moment {
    double time = 0, value = 0;
  };
  Moment first, last;  // sum of m x . v about the centre of mass, at the ends of the window of the virial
  double flight_trace = 0, flight_kinetic = 0;
  const auto virial_moment = [&](const Run& r) {
    Vec2 centre, mean;
    for (Index i = 0; i < r.model.node_count; ++i) {
      centre += r.model.mass[i] * Vec2{r.state.nodes[i].x, r.state.nodes[i].y};
      mean += r.model.mass[i] * udar::velocity(r.state, i);
    }
    centre *= 1 / body.mass;
    mean *= 1 / body.mass;
    double sum = 0;
    for (Index i = 0; i < r.model.node_count; ++i) {
      const Vec2 x = Vec2{r.state.nodes[i].x, r.state.nodes[i].y} - centre;
      sum += r.model.mass[i] * dot(x, udar::velocity(r.state, i) - mean);
    }
    return sum;
  };
  first = {0, virial_moment(run)};
  run.run([&](const Run& r) {
    const State& s = r.state;
    const double weight = 0.5 * (s.clock.last_step + (r.done() ? 0 : s.clock.next_step));
    double trace = 0, shear = 0, volume = 0;
    for (Index e = 0; e < body.element_end; ++e) {
      const auto place = [&](int corner) {
        const NodeRecord& n = s.nodes[r.model.corners[e][corner]];
        return Vec2{n.x, n.y};
      };
      const double v = 0.5 * twice_area(place(0), place(1), place(2)) * body.thickness;
      volume += v;
      trace += v * (s.stress_xx[e] + s.stress_yy[e]);
      shear += v * std::hypot(0.5 * (s.stress_xx[e] - s.stress_yy[e]), s.stress_xy[e]);
    }
    double kinetic = 0;
    const Vec2 mean = (1 / body.mass) * momentum;
    for (Index i = 0; i < r.model.node_count; ++i) {
      const Vec2 v = udar::velocity(s, i) - mean;
      kinetic += r.model.mass[i] * dot(v, v);
    }
    Quarter& q = quarters[std::min(3, static_cast<int>(4 * r.time() / end))];
    q.time += weight;
    q.trace += weight * trace / volume;
    q.shear += weight * shear / volume;
    flight_trace += weight * trace;
    flight_kinetic += weight * kinetic;
    spin_drift = std::max(spin_drift, std::fabs(s.ledger.spin / spin - 1));
    momentum_drift = std::max(momentum_drift, length(s.ledger.momentum - momentum) / length(momentum));
  });
  last = {run.time(), virial_moment(run)};

  for (Quarter& q : quarters) {
    q.trace /= q.time;
    q.shear /= q.time;
  }
  checks.note(fmt::format("{} steps, {:.1f} turns.", run.state.clock.step, 200 * end / two_pi));
  checks.at_most("spin momentum off", spin_drift, 1e-12);
  checks.at_most("momentum off", momentum_drift, 1e-12);
  checks.at_most("energy error", run.state.ledger.energy_error(), 1e-4);
  checks.within("mean of s_x + s_y, last quarter against the second", quarters[3].trace, quarters[1].trace, 0.01, "Pa");
  checks.within("mean of the largest shear, last quarter against the second", quarters[3].shear, quarters[1].shear,
                0.01, "Pa");

  // Clausius's virial theorem: the integral over time of the volume's trace of stress is that of twice the kinetic
  // energy, but for the change of sum m x . v. Exact for the nodes too, since the corner forces on the current geometry
  // have the virial -trace x volume; trapezoids over time remain.
  const double expected = flight_kinetic - (last.value - first.value);
  checks.within("integral of the volume's trace of stress, against that of the virial", flight_trace, expected, 1e-3,
                "J s");
}

}  // namespace

Problem free_turn() {
  return {
      .topic = Topic::rotation,
      .parts = {{"nodes turned rigidly, whatever the step", check_squares}, {"a beam thrown with spin", check_thrown}}};
}

}  // namespace udar::verification

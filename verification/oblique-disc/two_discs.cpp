// Two discs that meet at an angle: momentum, spin, Coulomb's law between bodies. See README.md.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "discs.hpp"

namespace udar::verification::oblique {
namespace {

/// What two discs did to each other.
struct Meeting {
  Vec2 normal{};    // N s, impulse of the normal forces on the first disc
  Vec2 friction{};  // N s
  Vec2 missed{};    // N s, normal impulse of steps in which a touch begins
  Rubbing rubbing;
  double momentum_drift = 0;  // largest change of the sum over both, over the sum of m |v|
  double spin_drift = 0;      // largest change of the sum over both, over the sum of m |x| |v|
  double asymmetry = 0;       // m/s, of the two discs, every 100 steps
  double deepest = 0;         // m
  Motion before[2];
  Motion after[2];
};

Meeting meet(Checks& checks, const Case& input) {
  Run run(input);
  Meeting m;
  const double friction = input.contact.friction;
  const auto look_at = [&](const BodyTouch& touch) {
    note(run, friction, touch.springs, m.rubbing);
    m.deepest = std::max(m.deepest, touch.springs.penetration);
    // Springs push their point; the body under it gets the opposite.
    const double sign = run.model.contact_bodies[touch.point] == 0 ? 1 : -1;
    const double span = sign * velocity_span(run.state.clock);
    m.normal += span * touch.springs.normal_force;
    m.friction += span * touch.springs.friction_force;
    if (touch.springs.friction_force == Vec2{}) m.missed += span * touch.springs.normal_force;
  };
  const Vec2 momentum = run.state.body_momentum[0] + run.state.body_momentum[1];
  const double spin = run.state.body_spin[0] + run.state.body_spin[1];
  double momentum_scale = 0;
  double spin_scale = 0;
  for (Index i = 0; i < run.model.node_count; ++i) {
    const double size = run.model.mass[i] * length(velocity(run.state, i));
    momentum_scale += size;
    spin_scale += length(place(run.state, i)) * size;
  }
  for (std::size_t b : {0, 1}) m.before[b] = motion_of(run, b);
  run.run([&](const Run& now) {
    for (const BodyTouch& touch : now.state.touches) look_at(touch);
    const State& s = now.state;
    m.momentum_drift =
        std::max(m.momentum_drift, length(s.body_momentum[0] + s.body_momentum[1] - momentum) / momentum_scale);
    m.spin_drift = std::max(m.spin_drift, std::fabs(s.body_spin[0] + s.body_spin[1] - spin) / spin_scale);
    if (s.clock.step % 100 != 0) return;
    const Motion one = motion_of(now, 0);
    const Motion other = motion_of(now, 1);
    m.asymmetry =
        std::max({m.asymmetry, length(one.velocity + other.velocity), radius * std::fabs(one.spin - other.spin)});
  });
  checks.holds("they part", run.state.touches.empty());
  checks.above("touches that begin", static_cast<double>(m.rubbing.touches), 0);
  for (std::size_t b : {0, 1}) m.after[b] = motion_of(run, b);
  checks.at_most("momentum of both", m.momentum_drift, 1e-12);
  checks.at_most("spin of both", m.spin_drift, 1e-12);
  checks.at_most("identity of work", run.state.ledger.identity_error(), 1e-11);
  // Each is pushed as the other, by what its touches say.
  for (std::size_t b : {0, 1}) {
    const Vec2 change = m.before[b].mass * (m.after[b].velocity - m.before[b].velocity);
    const Vec2 impulse = (b == 0 ? 1.0 : -1.0) * (m.normal + m.friction);
    checks.at_most(
        b == 0 ? "momentum of the upper disc less its impulse" : "momentum of the lower disc less its impulse",
        length(change - impulse) / length(impulse), 1e-12);
  }
  return m;
}

/// Every touch slides: friction is at right angles to the normal force and mu times as large, and so are their sums,
/// whichever way the line of centres has turned.
void check_gross_slip(Checks& checks, const Meeting& m, double friction) {
  checks.equal("touch-steps that stick", static_cast<double>(m.rubbing.sticking), 0);
  checks.above("touch-steps that slide", static_cast<double>(m.rubbing.sliding), 1000);
  checks.at_most("friction over mu N, less 1, of every touch", m.rubbing.off_cone, 1e-14);
  const Vec2 slid = m.normal - m.missed;
  const Vec2 coulomb = (cross(slid, m.friction) > 0 ? friction : -friction) * perpendicular(slid);
  checks.at_most("friction impulse less mu times normal impulse, but where a touch begins",
                 length(m.friction - coulomb) / length(m.normal), 1e-12);
}

}  // namespace

void check_two_in_gross_slip(Checks& checks) {
  const Case input = load("oblique-disc/two-discs.toml");
  const double friction = input.contact.friction;
  const Meeting m = meet(checks, input);
  check_gross_slip(checks, m, friction);
  // One is the image of the other, turned half round, and every operation on it but for signs the same; rounding grows
  // with what is carried over, 1e-16 of the speed a step.
  checks.at_most("one disc less the image of the other", m.asymmetry, 1e-11, "m/s");

  // A rigid disc: spin = friction impulse x R over I. The lever is R less half the depth. Sides of the rims are flat:
  // their normals are at most half a side, b / 2, off the line of centres, and mu R is the lever of friction.
  const Motion& after = m.after[0];
  const double b = 2 * pi / 6 * 0.0025;
  const double half_width = std::sqrt(radius * m.deepest);  // two rims
  const double softness = 2 * stiffness * 2 * half_width / b * disc_compliance(200e9, 0.0025);
  // The upper disc is touched from below, at -R along the normal impulse.
  const double rigid = -cross(m.normal, m.friction) / length(m.normal) * radius / after.inertia;
  checks.within("spin", after.spin, rigid, m.deepest / (2 * radius) + 0.5 * b / (friction * radius) + softness,
                "rad/s");
}

void check_two_that_stick(Checks& checks) {
  Case input = load("oblique-disc/two-discs.toml");
  input.contact.friction = 0.5;
  input.bodies[0].velocity = {0.75, -1.5};
  input.bodies[1].velocity = {-0.75, 1.5};
  const Meeting m = meet(checks, input);
  checks.above("touch-steps that stick", static_cast<double>(m.rubbing.sticking), 1000);
  checks.above("touch-steps that slide", static_cast<double>(m.rubbing.sliding), 0);
  checks.at_most("one disc less the image of the other", m.asymmetry, 1e-11, "m/s");
}

void check_small_struck_by_large(Checks& checks) {
  Case input = load("oblique-disc/two-discs.toml");
  input.bodies[1].velocity = {};
  input.bodies[1].mesh = DiscMesh{.radius = 0.03, .at = {0.005, -0.03}, .turn = 0.3, .element_size = 0.003};
  input.bodies[0].velocity = {15, -3};
  checks.setting("15 m/s along");
  check_gross_slip(checks, meet(checks, input), input.contact.friction);
  input.bodies[0].velocity = {1, -3};
  checks.setting("1 m/s along");
  checks.above("touch-steps that stick", static_cast<double>(meet(checks, input).rubbing.sticking), 0);
}

}  // namespace udar::verification::oblique

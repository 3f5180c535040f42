// oblique-disc: impact of discs with friction, against Coulomb's law and a rigid polygon on springs. See README.md.

#include <doctest/doctest.h>
#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include "rigid_polygon.hpp"
#include "udar/step/motion.hpp"
#include "wave_tools.hpp"

namespace udar::verification {
namespace {

constexpr double radius = 0.05;      // m
constexpr double stiffness = 300e3;  // N/m, of the plane's spring at each node
constexpr double thickness = 0.01;   // m
constexpr double pi = std::numbers::pi;

/// How a body moves as a whole.
struct Motion {
  double mass = 0;     ///< kg
  double inertia = 0;  ///< kg m2 about the centre of mass, from the masses of the nodes, undeformed
  Vec2 centre{};       ///< m
  Vec2 velocity{};     ///< m/s
  double spin = 0;     ///< rad/s: spin momentum about the centre of mass over inertia
};

Motion motion_of(const Model& model, const State& state, const Body& body) {
  Motion m;
  Vec2 rest;
  for (Index i = body.node_begin; i < body.node_end; ++i) {
    m.mass += model.mass[i];
    rest += model.mass[i] * model.rest[i];
    m.centre += model.mass[i] * place(state, i);
    m.velocity += model.mass[i] * velocity(state, i);
  }
  rest *= 1 / m.mass;
  m.centre *= 1 / m.mass;
  m.velocity *= 1 / m.mass;
  double momentum = 0;
  for (Index i = body.node_begin; i < body.node_end; ++i) {
    const Vec2 arm = model.rest[i] - rest;
    m.inertia += model.mass[i] * dot(arm, arm);
    momentum += model.mass[i] * cross(place(state, i) - m.centre, velocity(state, i) - m.velocity);
  }
  m.spin = momentum / m.inertia;
  return m;
}

Motion motion_of(const Run& run, std::size_t body = 0) {
  return motion_of(run.model, run.state, run.model.bodies[body]);
}

struct Impact {
  Vec2 velocity{7.5, -1.5};  ///< m/s
  double friction = 0.2;
  double spin = 0;               ///< rad/s, before
  double tangential_ratio = 1;   ///< k_t / k
  double young = 200e9;          ///< Pa
  double element_size = 0.0025;  ///< m

  [[nodiscard]] Case to_case() const {
    Case c = load("oblique-disc.toml");
    auto& mesh = std::get<DiscMesh>(c.bodies[0].mesh);
    mesh.element_size = element_size;
    std::get<Elastic>(c.materials[0].law).young_modulus = young;
    c.bodies[0].velocity = velocity;
    c.bodies[0].spin = spin;
    c.obstacles[0].friction = friction;
    c.obstacles[0].tangential_stiffness = tangential_ratio * stiffness;
    return c;
  }
};

/// The rigid polygon with the nodes and masses of the disc as it starts.
RigidPolygon polygon_of(const Run& run) {
  const Motion start = motion_of(run);
  RigidPolygon p{.mass = start.mass,
                 .inertia = start.inertia,
                 .centre = start.centre,
                 .velocity = start.velocity,
                 .spin = start.spin};
  for (const Index node : run.model.contact_nodes) p.rim.push_back(run.model.rest[node] - start.centre);
  return p;
}

/// Compliance of the disc between the touching nodes and its centre, m/N (Johnson, Contact Mechanics, 1985, 5.57: half
/// of what a cylinder gives between two strips of half-width a), with half the spacing of the nodes for a: the smallest
/// footprint that the mesh resolves, so nothing gives more.
double disc_compliance(const Impact& impact) {
  const double modulus = impact.young / (1 - 0.3 * 0.3);
  const double half_width = 0.5 * 2 * pi / 6 * impact.element_size;
  return 2 / (pi * modulus * thickness) * (std::log(4 * radius / half_width) - 0.5);
}

/// The disc's compliance over that of the springs it stands on, n at most: stiffnesses are off by this part. Times of
/// the normal and of the tangential swing are off by half of it, the phase of the latter, whose frequency is at most
/// sqrt(3 k_t / k) that of the former and which lasts half a period of it, by sqrt(3 k_t / k) pi / 2 times it.
double velocity_bound(const Impact& impact, std::size_t touching) {
  const double softness = stiffness * static_cast<double>(touching) * disc_compliance(impact);
  // What takes part in the exchange along the plane: the slip before the impact, or what friction can undo on both
  // sides of a reversal.
  const double normal = std::fabs(impact.velocity.y);
  const double slip = std::fabs(impact.velocity.x + impact.spin * radius);
  const double exchanged = normal + std::min(slip, 6 * impact.friction * normal);
  return std::sqrt(3 * std::max(1.0, impact.tangential_ratio)) * 0.5 * pi * softness * exchanged;
}

/// What the nodes of the rim did.
struct Rubbing {
  std::uint64_t sliding = 0;   // node-steps
  std::uint64_t sticking = 0;  // node-steps, with force in the tangential spring
  std::uint64_t touches = 0;   // begun
  double missed = 0;           // N s, normal impulse of steps in which a touch begins: friction starts with the next
  double off_cone = 0;         // largest |T| / (mu N) - 1 of nodes that slide
};

void note(const Run& run, double friction, const SpringState& s, Rubbing& all) {
  if (s.touches == 0) return;
  const double pressing = length(s.normal_force);
  const double rubbing = length(s.friction_force);
  if (s.slides != 0) {
    ++all.sliding;
    all.off_cone = std::max(all.off_cone, std::fabs(rubbing / (friction * pressing) - 1));
  } else if (rubbing > 0) {
    ++all.sticking;
  } else {
    ++all.touches;
    all.missed += velocity_span(run.state.clock) * pressing;
  }
}

/// Distance of two motions: the largest of the differences in velocity and speed of the rim, m/s.
double apart(const Motion& disc, const RigidPolygon& polygon) {
  return std::max(length(disc.velocity - polygon.velocity), radius * std::fabs(disc.spin - polygon.spin));
}

struct Compared {
  double apart = 0;  // m/s
  double bound = 0;  // m/s
  bool sticks = false;
  bool slides = false;
};

/// The disc, and the rigid polygon beside it.
Compared compare(const Impact& impact) {
  Run run(impact.to_case());
  RigidPolygon polygon = polygon_of(run);
  Rubbing rubbing;
  run.run([&](const Run& now) {
    for (const SpringState& s : now.state.contacts) note(now, impact.friction, s, rubbing);
  });
  REQUIRE(run.state.obstacles[0].touching == 0);
  REQUIRE(rubbing.touches > 0);
  polygon.fly(run.time(), 100000, {stiffness, impact.tangential_ratio * stiffness, impact.friction});
  const Motion after = motion_of(run);
  const Compared c{.apart = apart(after, polygon),
                   .bound = velocity_bound(impact, polygon.most),
                   .sticks = rubbing.sticking > 0,
                   .slides = rubbing.sliding > 0};
  MESSAGE(fmt::format(
      "{:.3g} m/s along, {:.3g} against the plane, spin {:.3g}, mu {:.2g}, k_t/k {:.2g}, E {:.3g}: after "
      "({:.6f}, {:.6f}) m/s, rim {:.6f}; rigid ({:.6f}, {:.6f}), {:.6f}; apart {:.2g} m/s, bound {:.2g}; "
      "{} node-steps sticking, {} sliding, {} nodes at once",
      impact.velocity.x, -impact.velocity.y, impact.spin, impact.friction, impact.tangential_ratio, impact.young,
      after.velocity.x, after.velocity.y, radius * after.spin, polygon.velocity.x, polygon.velocity.y,
      radius * polygon.spin, c.apart, c.bound, rubbing.sticking, rubbing.sliding, polygon.most));
  CHECK(c.apart <= c.bound);
  CHECK(polygon.sticks == c.sticks);
  CHECK(polygon.most >= 3);
  CHECK(below("momentum", momentum_error(run), 1e-12));
  CHECK(below("identity of work", run.state.ledger.identity_error(), 1e-11));
  return c;
}

}  // namespace

TEST_CASE("oblique-disc: inertia of the mesh") {
  // Straight sides cut off, masses in the corners of triangles: both of order 2. Exact: m R^2 / 2 of a round disc.
  std::vector<double> errors;
  for (const double size : {0.005, 0.0025, 0.00125}) {
    const Run run(Impact{.element_size = size}.to_case());
    const Motion m = motion_of(run);
    errors.push_back(m.inertia / (0.5 * m.mass * radius * radius) - 1);
  }
  CHECK(order_of("inertia over m R^2 / 2, less 1", errors) == doctest::Approx(2).epsilon(0.05));
}

TEST_CASE("oblique-disc: in gross slip friction is mu times the normal impulse, and spins the disc") {
  const Impact impact;
  Run run(impact.to_case());
  const Motion before = motion_of(run);
  Rubbing rubbing;
  double deepest = 0;
  run.run([&](const Run& now) {
    for (const SpringState& s : now.state.contacts) {
      note(now, impact.friction, s, rubbing);
      deepest = std::max(deepest, s.penetration);
    }
  });
  REQUIRE(run.state.obstacles[0].touching == 0);
  const Motion after = motion_of(run);
  const ContactBook& book = run.state.obstacles[0];
  const double normal = book.normal.impulse().y;
  const double friction = -(book.total.impulse().x - book.normal.impulse().x);
  CHECK(rubbing.sticking == 0);
  CHECK(rubbing.sliding > 1000);
  CHECK(below("friction over mu N, less 1, of every node that slides", rubbing.off_cone, 1e-14));
  CHECK(below("friction impulse less mu times normal impulse, but where a touch begins",
              std::fabs(friction - impact.friction * (normal - rubbing.missed)) / normal, 1e-12));
  CHECK(below("momentum less impulses",
              length(before.mass * (after.velocity - before.velocity) - book.total.impulse()) / normal, 1e-12));

  // In the step in which a touch begins N <= k v h acts, without friction: n k v h h of (1 + e) m v.
  const double v = -impact.velocity.y;
  const double restitution = after.velocity.y / v;
  const double h = run.state.clock.largest_step;
  const double begun = static_cast<double>(rubbing.touches) * stiffness * h * h / ((1 + restitution) * before.mass);
  MESSAGE(fmt::format("restitution {:.8f}, {} touches begun, {} node-steps, deepest {:.3g} mm, {} steps", restitution,
                      rubbing.touches, rubbing.sliding, 1e3 * deepest, run.state.clock.step));
  CHECK(within("velocity along the plane lost (m/s)", impact.velocity.x - after.velocity.x,
               impact.friction * (1 + restitution) * v, begun));

  // The friction of a node at depth d acts between R - deepest and R below the centre. Its normal forces k d at nodes b
  // apart have their centre at most b^2 / (4 a) beside it, 2 a wide (Euler and Maclaurin's b^2 / 12 times the jump of
  // slope in either end, over the area under the parabola); a goes as the root of the depth, N as its cube, depth
  // nearly as a sine: 1.144 of that of the greatest depth in the mean. The disc's own give adds its part.
  const double b = 2 * pi / 6 * impact.element_size;
  const double half_width = std::sqrt(2 * radius * deepest);
  const double aside = 1.144 * b * b / (4 * half_width) / (impact.friction * radius);
  const double softness = stiffness * 2 * half_width / b * disc_compliance(impact);
  // Clockwise, for a disc that moves to the right.
  const double rolling = -2 * impact.friction * (1 + restitution) * v / radius;
  const double inertia = before.inertia / (0.5 * before.mass * radius * radius);
  const double bound = deepest / radius + aside + softness;
  MESSAGE(fmt::format("2 a {:.3g} b; lever short by at most {:.3g}, normal forces aside {:.3g}, give {:.3g}",
                      2 * half_width / b, deepest / radius, aside, softness));
  CHECK(within("spin with the inertia of the mesh (rad/s)", after.spin, rolling / inertia, bound));
  CHECK(within("spin of a round disc (rad/s)", after.spin, rolling, bound + std::fabs(inertia - 1)));
  CHECK(compare(impact).sticks == false);
}

TEST_CASE("oblique-disc: sticking, as a rigid polygon on the same springs") {
  // From sticking at the touch, over sliding first and last, to sliding nearly all the time.
  for (const double slope : {0.3, 1.0, 2.0}) {
    const Compared c = compare({.velocity = {slope * 1.5, -1.5}, .friction = 0.5});
    CHECK(c.sticks);
    CHECK(c.slides);
  }
  const Compared c = compare({.velocity = {1.0, -1.5}, .friction = 0.4, .spin = 20, .tangential_ratio = 2.0 / 3});
  CHECK(c.sticks);
}

TEST_CASE("oblique-disc: the stiffer the disc, the more it moves as the rigid polygon") {
  std::vector<double> errors;
  for (const double young : {25e9, 50e9, 100e9}) {
    errors.push_back(compare({.velocity = {1.5, -1.5}, .friction = 0.5, .young = young}).apart);
  }
  CHECK(order_of("distance to the rigid polygon (m/s), E doubled", errors) == doctest::Approx(1).epsilon(0.2));
}

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

Meeting meet(const Case& input) {
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
  REQUIRE(run.state.touches.empty());
  REQUIRE(m.rubbing.touches > 0);
  for (std::size_t b : {0, 1}) m.after[b] = motion_of(run, b);
  MESSAGE(fmt::format("{} node-steps sliding, {} sticking, {} touches begun, deepest {:.3g} mm, {} steps",
                      m.rubbing.sliding, m.rubbing.sticking, m.rubbing.touches, 1e3 * m.deepest, run.state.clock.step));
  CHECK(below("momentum of both", m.momentum_drift, 1e-12));
  CHECK(below("spin of both", m.spin_drift, 1e-12));
  CHECK(below("identity of work", run.state.ledger.identity_error(), 1e-11));
  // Each is pushed as the other, by what its touches say.
  for (std::size_t b : {0, 1}) {
    const Vec2 change = m.before[b].mass * (m.after[b].velocity - m.before[b].velocity);
    const Vec2 impulse = (b == 0 ? 1.0 : -1.0) * (m.normal + m.friction);
    CHECK(below("momentum of one less its impulse", length(change - impulse) / length(impulse), 1e-12));
  }
  return m;
}

/// Every touch slides: friction is at right angles to the normal force and mu times as large, and so are their sums,
/// whichever way the line of centres has turned.
void check_gross_slip(const Meeting& m, double friction) {
  CHECK(m.rubbing.sticking == 0);
  CHECK(m.rubbing.sliding > 1000);
  CHECK(below("friction over mu N, less 1, of every touch", m.rubbing.off_cone, 1e-14));
  const Vec2 slid = m.normal - m.missed;
  const Vec2 coulomb = (cross(slid, m.friction) > 0 ? friction : -friction) * perpendicular(slid);
  CHECK(below("friction impulse less mu times normal impulse, but where a touch begins",
              length(m.friction - coulomb) / length(m.normal), 1e-12));
}

}  // namespace

TEST_CASE("oblique-disc: two equal discs in gross slip") {
  const Case input = load("two-discs.toml");
  const double friction = input.contact.friction;
  const Meeting m = meet(input);
  check_gross_slip(m, friction);
  // One is the image of the other, turned half round, and every operation on it but for signs the same; rounding grows
  // with what is carried over, 1e-16 of the speed a step.
  CHECK(below("one disc less the image of the other (m/s)", m.asymmetry, 1e-11));

  // A rigid disc: spin = friction impulse x R over I. The lever is R less half the depth. Sides of the rims are flat:
  // their normals are at most half a side, b / 2, off the line of centres, and mu R is the lever of friction.
  const Motion& after = m.after[0];
  const double b = 2 * pi / 6 * 0.0025;
  const double half_width = std::sqrt(radius * m.deepest);  // two rims
  const double softness = 2 * stiffness * 2 * half_width / b * disc_compliance({});
  // The upper disc is touched from below, at -R along the normal impulse.
  const double rigid = -cross(m.normal, m.friction) / length(m.normal) * radius / after.inertia;
  CHECK(within("spin (rad/s)", after.spin, rigid, m.deepest / (2 * radius) + 0.5 * b / (friction * radius) + softness));
}

TEST_CASE("oblique-disc: two equal discs that stick at first") {
  Case input = load("two-discs.toml");
  input.contact.friction = 0.5;
  input.bodies[0].velocity = {0.75, -1.5};
  input.bodies[1].velocity = {-0.75, 1.5};
  const Meeting m = meet(input);
  CHECK(m.rubbing.sticking > 1000);
  CHECK(m.rubbing.sliding > 0);
  CHECK(below("one disc less the image of the other (m/s)", m.asymmetry, 1e-11));
}

TEST_CASE("oblique-disc: a small coarse disc at rest is struck by a large one") {
  Case input = load("two-discs.toml");
  input.bodies[1].velocity = {};
  input.bodies[1].mesh = DiscMesh{.radius = 0.03, .at = {0.005, -0.03}, .turn = 0.3, .element_size = 0.003};
  input.bodies[0].velocity = {15, -3};
  check_gross_slip(meet(input), input.contact.friction);
  input.bodies[0].velocity = {1, -3};
  CHECK(meet(input).rubbing.sticking > 0);
}

TEST_CASE("oblique-disc: every angle from 5 to 85 degrees against the rigid polygon (long)") {
  for (const double friction : {0.1, 0.3, 0.6}) {
    for (const double ratio : {1.0, 2.0 / 3}) {
      bool stuck = false;
      bool only_slid = false;
      for (int angle = 5; angle <= 85; angle += 10) {
        const double slope = std::tan(angle * pi / 180);
        const Compared c = compare({.velocity = {slope * 1.5, -1.5}, .friction = friction, .tangential_ratio = ratio});
        stuck = stuck || c.sticks;
        only_slid = only_slid || !c.sticks;
      }
      CHECK(stuck);
      CHECK(only_slid);
    }
  }
}

}  // namespace udar::verification

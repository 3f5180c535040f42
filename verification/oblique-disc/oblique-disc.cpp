// oblique-disc: impact of discs with friction, against Coulomb's law and a rigid polygon on springs. See README.md.

#include <fmt/core.h>

#include <cmath>

#include "discs.hpp"
#include "rigid_polygon.hpp"

namespace udar::verification {
namespace {

using namespace oblique;

struct Impact {
  Vec2 velocity{7.5, -1.5};  ///< m/s
  double friction = 0.2;
  double spin = 0;               ///< rad/s, before
  double tangential_ratio = 1;   ///< k_t / k
  double young = 200e9;          ///< Pa
  double element_size = 0.0025;  ///< m

  [[nodiscard]] Case to_case() const {
    Case c = load("oblique-disc/oblique-disc.toml");
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

/// The disc's compliance over that of the springs it stands on, n at most: stiffnesses are off by this part. Times of
/// the normal and of the tangential swing are off by half of it, the phase of the latter, whose frequency is at most
/// sqrt(3 k_t / k) that of the former and which lasts half a period of it, by sqrt(3 k_t / k) pi / 2 times it.
double velocity_bound(const Impact& impact, std::size_t touching) {
  const double softness =
      stiffness * static_cast<double>(touching) * disc_compliance(impact.young, impact.element_size);
  // What takes part in the exchange along the plane: the slip before the impact, or what friction can undo on both
  // sides of a reversal.
  const double normal = std::fabs(impact.velocity.y);
  const double slip = std::fabs(impact.velocity.x + impact.spin * radius);
  const double exchanged = normal + std::min(slip, 6 * impact.friction * normal);
  return std::sqrt(3 * std::max(1.0, impact.tangential_ratio)) * 0.5 * pi * softness * exchanged;
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
  double lost = 0;        // m/s, velocity along the plane
  double rigid_lost = 0;  // m/s, that of the rigid polygon
};

/// The disc, and the rigid polygon beside it.
Compared compare(Checks& checks, const Impact& impact) {
  Run run(impact.to_case());
  RigidPolygon polygon = polygon_of(run);
  Rubbing rubbing;
  run.run([&](const Run& now) {
    for (const SpringState& s : now.state.contacts) note(now, impact.friction, s, rubbing);
  });
  checks.holds("they part", run.state.obstacles[0].touching == 0);
  checks.above("touches that begin", static_cast<double>(rubbing.touches), 0);
  polygon.fly(run.time(), 100000, {stiffness, impact.tangential_ratio * stiffness, impact.friction});
  const Motion after = motion_of(run);
  const Compared c{.apart = apart(after, polygon),
                   .bound = velocity_bound(impact, polygon.most),
                   .sticks = rubbing.sticking > 0,
                   .slides = rubbing.sliding > 0,
                   .lost = impact.velocity.x - after.velocity.x,
                   .rigid_lost = impact.velocity.x - polygon.velocity.x};
  checks.at_most("velocity and rim speed apart from the rigid polygon's", c.apart, c.bound, "m/s");
  checks.holds("both stick, or neither", polygon.sticks == c.sticks);
  checks.at_least("nodes that touch at once", static_cast<double>(polygon.most), 3);
  checks.at_most("momentum", momentum_error(run), 1e-12);
  checks.at_most("identity of work", run.state.ledger.identity_error(), 1e-11);
  return c;
}

/// Straight sides cut off, masses in the corners of triangles: both of order 2. Exact: m R^2 / 2 of a round disc.
void check_inertia(Checks& checks) {
  ErrorSeries errors{.what = "inertia over m R^2 / 2, less 1"};
  for (const double size : {0.005, 0.0025, 0.00125}) {
    const Run run(Impact{.element_size = size}.to_case());
    const Motion m = motion_of(run);
    errors.add(size, m.inertia / (0.5 * m.mass * radius * radius) - 1);
  }
  checks.order(errors, {.expected = 2, .least = 1.85, .most = 2.15});
}

void check_gross_slip(Checks& checks) {
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
  checks.holds("they part", run.state.obstacles[0].touching == 0);
  const Motion after = motion_of(run);
  const ContactBook& book = run.state.obstacles[0];
  const double normal = book.normal.impulse().y;
  const double friction = -(book.total.impulse().x - book.normal.impulse().x);
  checks.equal("node-steps that stick", static_cast<double>(rubbing.sticking), 0);
  checks.above("node-steps that slide", static_cast<double>(rubbing.sliding), 1000);
  checks.at_most("friction over mu N, less 1, of every node that slides", rubbing.off_cone, 1e-14);
  checks.at_most("friction impulse less mu times normal impulse, but where a touch begins",
                 std::fabs(friction - impact.friction * (normal - rubbing.missed)) / normal, 1e-12);
  checks.at_most("momentum less impulses",
                 length(before.mass * (after.velocity - before.velocity) - book.total.impulse()) / normal, 1e-12);

  // In the step in which a touch begins N <= k v h acts, without friction: n k v h h of (1 + e) m v.
  const double v = -impact.velocity.y;
  const double restitution = after.velocity.y / v;
  const double h = run.state.clock.largest_step;
  const double begun = static_cast<double>(rubbing.touches) * stiffness * h * h / ((1 + restitution) * before.mass);
  checks.note(fmt::format("Restitution {:.8f}; {} touches begun; deepest {:.3g} mm; {} steps.", restitution,
                          rubbing.touches, 1e3 * deepest, run.state.clock.step));
  checks.within("velocity along the plane lost", impact.velocity.x - after.velocity.x,
                impact.friction * (1 + restitution) * v, begun, "m/s");

  // The friction of a node at depth d acts between R - deepest and R below the centre. Its normal forces k d at nodes b
  // apart have their centre at most b^2 / (4 a) beside it, 2 a wide (Euler and Maclaurin's b^2 / 12 times the jump of
  // slope in either end, over the area under the parabola); a goes as the root of the depth, N as its cube, depth
  // nearly as a sine: 1.144 of that of the greatest depth in the mean. The disc's own give adds its part.
  const double b = 2 * pi / 6 * impact.element_size;
  const double half_width = std::sqrt(2 * radius * deepest);
  const double aside = 1.144 * b * b / (4 * half_width) / (impact.friction * radius);
  const double softness = stiffness * 2 * half_width / b * disc_compliance(impact.young, impact.element_size);
  // Clockwise, for a disc that moves to the right.
  const double rolling = -2 * impact.friction * (1 + restitution) * v / radius;
  const double inertia = before.inertia / (0.5 * before.mass * radius * radius);
  const double bound = deepest / radius + aside + softness;
  checks.within("spin with the inertia of the mesh", after.spin, rolling / inertia, bound, "rad/s");
  checks.within("spin of a round disc", after.spin, rolling, bound + std::fabs(inertia - 1), "rad/s");
  checks.setting("beside the rigid polygon");
  checks.holds("nothing sticks", !compare(checks, impact).sticks);
}

/// From sticking at the touch, over sliding first and last, to sliding nearly all the time.
void check_sticking(Checks& checks) {
  for (const double slope : {0.3, 1.0, 2.0}) {
    checks.setting(fmt::format("{:.3g} m/s along, mu = 0.5", slope * 1.5));
    const Compared c = compare(checks, {.velocity = {slope * 1.5, -1.5}, .friction = 0.5});
    checks.holds("it sticks", c.sticks);
    checks.holds("it slides", c.slides);
  }
  checks.setting("1 m/s, 20 rad/s, mu = 0.4, k_t = 2/3 k");
  const Compared c =
      compare(checks, {.velocity = {1.0, -1.5}, .friction = 0.4, .spin = 20, .tangential_ratio = 2.0 / 3});
  checks.holds("it sticks", c.sticks);
}

/// The stiffer the disc, the more it moves as the rigid polygon.
void check_stiffer(Checks& checks) {
  ErrorSeries errors{.what = "distance to the rigid polygon, m/s", .size = "compliance 1/E", .size_unit = "1/Pa"};
  for (const double young : {25e9, 50e9, 100e9}) {
    checks.setting(fmt::format("E = {} GPa", 1e-9 * young));
    errors.add(1 / young, compare(checks, {.velocity = {1.5, -1.5}, .friction = 0.5, .young = young}).apart);
  }
  checks.order(errors, {.expected = 1, .least = 0.8, .most = 1.2});
}

void check_all_angles(Checks& checks) {
  for (const double friction : {0.1, 0.3, 0.6}) {
    for (const double ratio : {1.0, 2.0 / 3}) {
      bool stuck = false;
      bool only_slid = false;
      CheckLine disc{.name = "disc", .x = {}, .y = {}};
      CheckLine rigid{.name = "rigid polygon", .exact = true, .x = {}, .y = {}};
      for (int angle = 5; angle <= 85; angle += 10) {
        const double slope = std::tan(angle * pi / 180);
        checks.setting(fmt::format("mu = {}, k_t/k = {:.2g}, {} deg", friction, ratio, angle));
        const Compared c =
            compare(checks, {.velocity = {slope * 1.5, -1.5}, .friction = friction, .tangential_ratio = ratio});
        stuck = stuck || c.sticks;
        only_slid = only_slid || !c.sticks;
        for (CheckLine* line : {&disc, &rigid}) line->x.push_back(angle);
        disc.y.push_back(c.lost);
        rigid.y.push_back(c.rigid_lost);
      }
      checks.curve({.title = fmt::format("Velocity along the plane that friction takes, mu = {}, k_t/k = {:.2g}",
                                         friction, ratio),
                    .x_label = "angle from the normal, degrees",
                    .x_unit = "",
                    .y_label = "velocity lost",
                    .y_unit = "m/s",
                    .lines = {disc, rigid}});
      checks.setting(fmt::format("mu = {}, k_t/k = {:.2g}", friction, ratio));
      checks.holds("at some angles it sticks", stuck);
      checks.holds("at others it only slides", only_slid);
    }
  }
}

}  // namespace

Problem oblique_disc() {
  return {.topic = Topic::friction,
          .parts = {{"inertia of the mesh", check_inertia},
                    {"gross slip", check_gross_slip},
                    {"sticking, as a rigid polygon on the same springs", check_sticking},
                    {"the stiffer the disc, the more it moves as the rigid polygon", check_stiffer},
                    {"two equal discs in gross slip", check_two_in_gross_slip},
                    {"two equal discs that stick at first", check_two_that_stick},
                    {"a small coarse disc at rest is struck by a large one", check_small_struck_by_large},
                    {.name = "every angle from 5 to 85 degrees", .check = check_all_angles, .is_long = true}}};
}

}  // namespace udar::verification

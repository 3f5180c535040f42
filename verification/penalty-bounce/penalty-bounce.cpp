// penalty-bounce: masses that bounce on contact springs, against oscillators in closed form. See README.md.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "run.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double omega = 100;  // 1/s, sqrt(k / m) at every corner
constexpr double speed = 1;    // m/s
constexpr double total_mass = 6000;
constexpr double total_stiffness = 6e7;

Case bounce_case(double h) {
  Case c = load("penalty-bounce/penalty-bounce.toml");
  c.run.time_step = h;
  return c;
}

/// The corner that obstacle `o` waits for.
Vec2 corner_of(std::size_t o) {
  constexpr Vec2 corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  return corners[o];
}

Vec2 coming_velocity(const Run& run, Index node) { return {run.state.nodes[node].vx, run.state.nodes[node].vy}; }

/// Largest difference of two corners' motion, m: 0 while the square stays rigid.
double distortion(const Run& run) {
  double largest = 0;
  for (Index i = 1; i < run.model.node_count; ++i) {
    largest = std::max(largest, length(run.displacement(i) - run.displacement(0)));
  }
  return largest;
}

struct Bounce {
  double duration = 0;  // s, to the crossing of the surface, between two steps on a straight line
  double depth = 0;     // m, of the parabola through the three deepest places
  double force = 0;     // N, on all anvils, likewise
  double restitution = 0;
  double impulse = 0;  // N s
  double energy_error = 0;
  double distortion = 0;                         // m
  CheckLine path{.name = "", .x = {}, .y = {}};  // place over time
};

double parabola_peak(double a, double b, double c) {
  const double curve = a - 2 * b + c;
  return curve == 0 ? b : b - (c - a) * (c - a) / (8 * curve);
}

Bounce bounce(const Case& input) {
  Run run(input);
  Bounce out;
  std::vector<double> depth, force;
  double last_time = 0;
  double last_y = 0;
  run.run([&](const Run& r) {
    const double y = r.displacement(0).y;
    if (out.duration == 0 && last_y < 0 && y >= 0) {
      out.duration = last_time + (r.time() - last_time) * last_y / (last_y - y);
    }
    last_time = r.time();
    last_y = y;
    depth.push_back(-y);
    out.path.x.push_back(r.time());
    out.path.y.push_back(y);
    double sum = 0;
    for (const ContactBook& book : r.state.obstacles) sum += book.total.force.y;
    force.push_back(sum);
    out.distortion = std::max(out.distortion, distortion(r));
  });
  for (std::size_t i = 1; i + 1 < depth.size(); ++i) {
    if (depth[i] < depth[i - 1] || depth[i] <= depth[i + 1]) continue;
    out.depth = parabola_peak(depth[i - 1], depth[i], depth[i + 1]);
    out.force = parabola_peak(force[i - 1], force[i], force[i + 1]);
  }
  out.restitution = coming_velocity(run, 0).y / speed;
  for (const ContactBook& book : run.state.obstacles) out.impulse += book.total.impulse().y;
  out.energy_error = run.state.ledger.energy_error();
  return out;
}

ErrorSeries over_step(const std::string& what) { return {.what = what, .size = "time step", .size_unit = "s"}; }

std::string step_of(double h) { return fmt::format("{:.4g} ms", 1e3 * h); }

void check_half_cycle(Checks& checks) {
  const double duration = pi / omega;
  const double depth = speed / omega;
  const double force = speed * std::sqrt(total_mass * total_stiffness);
  CheckCurve path{.title = "Place of the mass", .y_label = "place", .y_unit = "m"};
  ErrorSeries durations = over_step("duration");
  ErrorSeries depths = over_step("depth");
  ErrorSeries forces = over_step("force");
  for (const double h : {2e-3, 1e-3, 0.5e-3, 0.25e-3, 0.125e-3}) {
    const double z = omega * h;
    const Bounce b = bounce(bounce_case(h));
    checks.setting(step_of(h));
    // Central difference on the oscillator: frequency higher by z^2/24, envelope by z^2/8; the parabola through three
    // samples and the straight line at the surface are exact to higher order.
    const double for_time = 1.1 * z * z / 24 + 0.2 * z * z * z;
    const double for_size = 1.1 * z * z / 8 + 0.2 * z * z * z;
    checks.within("duration", b.duration, duration, for_time, "s");
    checks.within("depth", b.depth, depth, for_size, "m");
    checks.within("force", b.force, force, for_size, "N");
    durations.add(h, std::fabs(b.duration / duration - 1), for_time);
    depths.add(h, std::fabs(b.depth / depth - 1), for_size);
    forces.add(h, std::fabs(b.force / force - 1), for_size);
    // The step on which it leaves falls anywhere: speed after / before in 1 .. 1 / cos(theta / 2) = 1 + z^2/8.
    checks.between("restitution", b.restitution, 1 - 1e-12, 1 + 1.1 * z * z / 8);
    // What the ledger calls its error is that very gain: in energy twice as much.
    checks.at_most("energy error", b.energy_error, 1.1 * z * z / 4);
    // Impulse = change of momentum, and no corner ahead of another: rounding of 320 steps.
    checks.within("impulse", b.impulse, total_mass * speed * (1 + b.restitution), 1e-12, "N s");
    checks.at_most("one corner ahead of another", b.distortion, 1e-14, "m");
    if (h == 2e-3 || h == 0.5e-3)
      path.lines.push_back({.name = "steps of " + step_of(h), .x = b.path.x, .y = b.path.y});
  }
  CheckLine exact{.name = "exact", .exact = true, .x = {}, .y = {}};
  for (int i = 0; i <= 200; ++i) {
    const double t = i * path.lines[0].x.back() / 200;
    exact.x.push_back(t);
    exact.y.push_back(t < duration ? -depth * std::sin(omega * t) : speed * (t - duration));
  }
  path.lines.push_back(exact);
  checks.curve(path);
  for (const ErrorSeries& errors : {durations, depths, forces}) {
    checks.order(errors, {.expected = 2, .least = 1.85, .most = 2.15, .from = OrderFrom::ends});
  }
}

void check_discrete(Checks& checks) {
  // x_n = v h sin(n theta) / sin(theta), sin(theta / 2) = z / 2: what central difference does to a mass on a spring.
  const double h = 1e-3;
  const double theta = 2 * std::asin(omega * h / 2);
  Run run(bounce_case(h));
  double largest = 0;
  int n = 0;
  while (run.displacement(0).y <= 0 && !run.done()) {
    largest = std::max(largest, std::fabs(run.displacement(0).y + speed * h * std::sin(n * theta) / std::sin(theta)));
    run.step();
    ++n;
  }
  checks.equal("steps in contact", n, 32);
  checks.at_most("largest distance from the formula", largest, 1e-16 * n, "m");
}

void check_moving_anvil(Checks& checks) {
  Run body_moves(bounce_case(0.5e-3));
  Case other = bounce_case(0.5e-3);
  other.bodies[0].velocity = {};
  for (ObstacleCase& o : other.obstacles) o.velocity = {0, speed};
  Run obstacle_moves(other);
  double largest = 0;
  while (!body_moves.done()) {
    body_moves.step();
    obstacle_moves.step();
    const Vec2 frame{0, speed * body_moves.time()};
    largest = std::max(largest, length(obstacle_moves.displacement(0) - frame - body_moves.displacement(0)));
  }
  // Rounding: coordinates up to 1 m carry 1e-16 m a step, and the spring turns errors of place into as much again.
  checks.at_most("largest difference of place", largest, 1e-14, "m");
  // The anvils did all the work: from rest to 2 v.
  const Ledger& ledger = obstacle_moves.state.ledger;
  const double kinetic = 0.5 * total_mass * 4 * speed * speed;
  const double z = omega * 0.5e-3;
  checks.within("kinetic energy gained", ledger.kinetic_energy, kinetic, z * z / 4, "J");
  checks.within("work of the anvils", ledger.obstacle_work_now, kinetic, z * z / 4, "J");
  checks.at_most("energy error", ledger.energy_error(), 1.1 * z * z / 4);
}

/// The flight of one mass past a circle with a linear spring inside, by Runge and Kutta's fourth-order rule with tiny
/// steps: the reference for a glancing blow. Places relative to the centre.
void fly_past_circle(double radius, Vec2& x, Vec2& v, double time, int steps) {
  const auto pull = [&](Vec2 p) {
    const double r = length(p);
    return r < radius ? (omega * omega * (radius - r) / r) * p : Vec2{};
  };
  const double h = time / steps;
  for (int i = 0; i < steps; ++i) {
    const Vec2 k1 = v, l1 = pull(x);
    const Vec2 k2 = v + 0.5 * h * l1, l2 = pull(x + 0.5 * h * k1);
    const Vec2 k3 = v + 0.5 * h * l2, l3 = pull(x + 0.5 * h * k2);
    const Vec2 k4 = v + h * l3, l4 = pull(x + h * k3);
    x += (h / 6) * (k1 + 2 * k2 + 2 * k3 + k4);
    v += (h / 6) * (l1 + 2 * l2 + 2 * l3 + l4);
  }
}

constexpr double radius = 0.1;                     // m
const Vec2 glancing{0.05, std::sqrt(0.75) * 0.1};  // m, from the centre to the first touch: 30 degrees off

Case circle_case(double h) {
  Case c = bounce_case(h);
  for (std::size_t o = 0; o < c.obstacles.size(); ++o) {
    c.obstacles[o].shape = Circle{.centre = corner_of(o) - glancing, .radius = radius};
  }
  return c;
}

void check_glancing(Checks& checks) {
  Vec2 place = glancing;
  Vec2 exact{0, -speed};
  fly_past_circle(radius, place, exact, 0.04, 400000);
  checks.within("speed after, of the reference", length(exact), speed, 1e-9, "m/s");
  ErrorSeries errors = over_step("velocity after");
  for (const double h : {2e-3, 1e-3, 0.5e-3, 0.25e-3, 0.125e-3}) {
    const double z = omega * h;
    Run run(circle_case(h));
    const auto spin = [&] {  // about the centre of its own circle
      const Vec2 x = Vec2{run.state.nodes[0].x, run.state.nodes[0].y} - (run.model.rest[0] - glancing);
      return cross(x, coming_velocity(run, 0));
    };
    const double spin_before = spin();
    double spin_drift = 0;
    double bent = 0;
    while (!run.done()) {
      run.step();
      spin_drift = std::max(spin_drift, std::fabs(spin() - spin_before));
      bent = std::max(bent, distortion(run));
    }
    const double error = length(coming_velocity(run, 0) - exact) / speed;
    checks.setting(step_of(h));
    // Phase and envelope errors of z^2/24 and z^2/8 over a half cycle (pi), and the step of release: below z^2/2.
    checks.at_most("velocity after, off the reference, over the speed", error, 0.5 * z * z);
    // A central force has no moment: the spin momentum is kept exactly, by central difference too.
    checks.at_most("change of spin about the centre", spin_drift / std::fabs(spin_before), 1e-12);
    checks.at_most("one corner ahead of another", bent, 1e-13, "m");
    errors.add(h, error, 0.5 * z * z);
  }
  checks.order(errors, {.expected = 2, .least = 1.8, .from = OrderFrom::ends});
}

void check_corner(Checks& checks) {
  // In through the top, out through the side: the potential k d^2/2 with d to the nearest face is continuous, only the
  // direction of the force jumps. A trapezoid over the step with the jump is wrong by at most half of jump x way.
  const double to_corner = 0.015;  // m, from the first touch to the corner of the anvil
  ErrorSeries worst = over_step("energy, worst phase");
  double depth_there = 0;
  for (const double h : {0.4e-3, 0.2e-3, 0.1e-3, 0.05e-3}) {
    double largest = 0;
    double mean = 0;
    int crossings = 0;
    double left_over = 0;       // J, in the springs after the bounce
    constexpr int phases = 16;  // of the jump within a step
    for (int phase = 0; phase < phases; ++phase) {
      const double reach = to_corner + speed * h * phase / phases;
      Case c = bounce_case(h);
      c.bodies[0].velocity = {speed, -speed};
      for (std::size_t o = 0; o < 4; ++o) {
        c.obstacles[o].shape = Rectangle{.at = corner_of(o) + Vec2{reach - 0.4, -0.3}, .size = {0.4, 0.3}};
      }
      Run run(c);
      std::uint32_t face = 99;
      int changes = 0;
      while (!run.done()) {
        run.step();
        for (const SpringState& s : run.state.contacts) {
          if (s.touches == 0) continue;
          if (face != 99 && s.face != face) {
            ++changes;
            depth_there = s.penetration;
          }
          face = s.face;
          break;
        }
      }
      if (changes == 1) ++crossings;
      left_over = std::max(left_over, std::fabs(run.state.ledger.contact_energy));
      const double energy = dot(coming_velocity(run, 0), coming_velocity(run, 0)) / (2 * speed * speed);
      largest = std::max(largest, std::fabs(energy - 1));
      mean += (energy - 1) / phases;
    }
    // jump k d (1, 1), way h v; against m (v_x^2 + v_y^2) / 2 = m v^2, and the smooth z^2/4 on top.
    const double z = omega * h;
    const double bound = omega * omega * depth_there * h * 2 * speed / (2 * speed * speed) + z * z / 4;
    checks.setting(step_of(h));
    checks.equal("bounces of 16 that change the face once", crossings, phases);
    checks.equal("energy left in the springs", left_over, 0, "J");
    checks.at_most("energy after over before, less 1, worst phase", largest, bound);
    worst.add(h, largest, bound);
    checks.note(fmt::format("Steps of {}: energy off by {:.2g} on average.", step_of(h), mean));
  }
  checks.order(worst, {.expected = 1, .least = 0.85, .from = OrderFrom::ends});
  checks.note(fmt::format("Keeping the face of entry would drop k d^2/2, {:.2g} of the energy, whatever the step.",
                          omega * omega * depth_there * depth_there / (2 * speed * speed)));
}

void check_damping(Checks& checks) {
  // m x'' + 2 zeta sqrt(k m) x' + k x = 0 until the force would pull.
  const double zeta = 0.2;
  const double root = std::sqrt(1 - zeta * zeta);
  const double exact = std::exp(-zeta / root * (pi - std::atan(2 * zeta * root / (1 - 2 * zeta * zeta))));
  ErrorSeries errors = over_step("restitution");
  for (const double h : {1e-3, 0.5e-3, 0.25e-3, 0.125e-3, 0.0625e-3}) {
    const double z = omega * h;
    Case c = bounce_case(h);
    c.contact.damping = zeta;
    Run run(c);
    // The same rule on a plain number: force k d and a dashpot on the velocity of the step just done, never pulling.
    double x = 0, v = -speed, apart = 0, pull = 0;
    while (!run.done()) {
      const double step = run.state.clock.next_step;
      run.step();
      x += step * v;
      const double press = x < 0 ? -omega * omega * x : 0;
      const double damp = x < 0 ? std::max(-2 * zeta * omega * v, -press) : 0;
      v += 0.5 * (step + run.state.clock.next_step) * (press + damp);
      apart = std::max(apart, std::fabs(run.displacement(0).y - x));
      for (const SpringState& s : run.state.contacts) {
        pull = std::max(pull, -dot(s.normal_force + s.damping_force, s.normal));
      }
    }
    const double restitution = coming_velocity(run, 0).y / speed;
    const Ledger& ledger = run.state.ledger;
    const double lost = 0.5 * total_mass * speed * speed * (1 - restitution * restitution);
    checks.setting(step_of(h));
    // The dashpot uses a velocity half a step old: first order. It acts as zeta / sqrt(1 - zeta z) would and misses
    // half a step of its first blow: together below 2 zeta z.
    checks.within("restitution", restitution, exact, 2 * zeta * z);
    errors.add(h, std::fabs(restitution / exact - 1), 2 * zeta * z);
    checks.at_most("off the plain recursion", apart, 1e-14, "m");
    checks.at_most("largest pull", pull, 1e-9, "N");  // of 1e5: rounding
    checks.within("damped energy", ledger.damped_energy(), lost, 1.1 * z * z / 4 / (1 - exact * exact), "J");
  }
  checks.order(errors, {.expected = 1, .least = 0.85, .from = OrderFrom::ends});
}

}  // namespace

Problem penalty_bounce() {
  return {.topic = Topic::contact,
          .parts = {{"half a cycle of the contact spring", check_half_cycle},
                    {"the discrete oscillator, step by step", check_discrete},
                    {"a moving anvil and a moving mass are the same", check_moving_anvil},
                    {"a glancing blow on a circle", check_glancing},
                    {"across the bisector near a corner", check_corner},
                    {"contact damping, half a damped cycle", check_damping}}};
}

}  // namespace udar::verification

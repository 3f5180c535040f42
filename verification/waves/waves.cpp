// waves: fronts and standing waves, against the wave equation. See README.md.

#include <fmt/core.h>

#include <numbers>

#include "tools.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

constexpr double density = 7850;
const Elasticity steel = elasticity_of(200e9, 0.3);
const double c_p = std::sqrt(steel.wave_modulus() / density);
const double c_s = std::sqrt(steel.shear_modulus / density);
const double c_bar = std::sqrt(200e9 / (1 - 0.09) / density);
constexpr double pi = std::numbers::pi;

void hold(Case& c, bool along_x) {
  for (SupportCase& s : c.supports) {
    s.move_x = along_x ? std::optional(TimeTable::constant(0)) : std::nullopt;
    s.move_y = along_x ? std::nullopt : std::optional(TimeTable::constant(0));
  }
}

// --- fronts

enum class Wave { p, s, bar };

struct Front {
  double speed;               ///< m/s, from two stations
  double history;             ///< relative L2 error of the velocity against time at the second station
  double mirror;              ///< error of the symmetry about the middle line, over the largest velocity
  CheckLine computed, exact;  ///< velocity at the second station over time
};

/// Sends the front through and watches it pass 0.2 m and 0.6 m on the middle line.
Front send(Wave wave, int cells_per_rise) {
  Case c = load("waves/waves.toml");
  const double speed = wave == Wave::p ? c_p : (wave == Wave::s ? c_s : c_bar);
  constexpr double rise_length = 0.16;  // m, the same for all waves
  const double rise = rise_length / speed;
  RectangleMesh& mesh = std::get<RectangleMesh>(c.bodies[0].mesh);
  mesh.element_size = rise_length / cells_per_rise;
  if (wave == Wave::bar) {
    c.supports.clear();
    mesh.size.y = 4 * mesh.element_size;
  }
  if (wave == Wave::s) {
    hold(c, true);
    c.loads[0].value = {0, 1e6};
  }
  c.loads[0].factor.times = {0, rise};
  c.run.end_time = 0.6 / speed + 1.2 * rise;
  Run run(c);

  const double middle = 0.5 * mesh.size.y;
  const Index first = nearest(run.model, {0.2, middle});
  const Index second = nearest(run.model, {0.6, middle});
  const auto along = [&](Index node) {
    const Vec2 v = velocity(run.state, node);
    return wave == Wave::s ? v.y : v.x;
  };
  const double plateau = 1e6 / (density * speed);
  Record at_first, at_second;
  double error = 0;
  double norm = 0;
  CheckLine exact_line{.name = "exact", .exact = true, .x = {}, .y = {}};
  run.run([&](const Run& now) {
    at_first.add(now.time(), along(first));
    at_second.add(now.time(), along(second));
    const double exact = plateau * c.loads[0].factor.at(now.time() - run.model.rest[second].x / speed);
    error += std::pow(at_second.values.back() - exact, 2);
    norm += exact * exact;
    exact_line.x.push_back(now.time());
    exact_line.y.push_back(exact);
  });
  const double distance = run.model.rest[second].x - run.model.rest[first].x;
  const double time = at_second.passes(0.5 * plateau) - at_first.passes(0.5 * plateau);
  return {.speed = distance / time,
          .history = std::sqrt(error / norm),
          .mirror = wave == Wave::s ? 0 : mirror_error(run, false, middle, 1),
          .computed = {.name = fmt::format("{} cells in the rise", cells_per_rise),
                       .x = at_second.times,
                       .y = at_second.values},
          .exact = exact_line};
}

// Numerical dispersion: linear elements, lumped masses and central difference carry a wave number k at
// c (1 - (k h)^2 / 24) at most (one dimension, steps far below the limit; larger steps do better), and its group 3
// times as much slower. The rise is half a wave: k = pi over its length, k h = pi / n with n cells in it.
double front_bound(int cells_per_rise) { return std::pow(pi / cells_per_rise, 2) / 8; }

void check_front(Checks& checks, Wave wave, double speed) {
  ErrorSeries errors{.what = "velocity history, L2 error"};
  CheckCurve passing{.title = "The front passes 0.6 m", .y_label = "velocity", .y_unit = "m/s"};
  for (const int n : {8, 16, 32}) {
    const Front front = send(wave, n);
    checks.setting(fmt::format("{} cells in the rise", n));
    checks.within("speed of the front", front.speed, speed, front_bound(n), "m/s");
    // The order of sums at the nodes is not mirrored: rounding only, which 1e3 steps add up.
    checks.at_most("mirror symmetry", front.mirror, 1e-11);
    errors.add(0.16 / n, front.history);
    if (n != 16) passing.lines.push_back(front.computed);
    if (n == 32) passing.lines.push_back(front.exact);
  }
  // Smooth data: order 2. The rise is C2 only, its third derivative jumps; that costs nothing in L2 for order 2.
  checks.order(errors, {.expected = 2, .least = 1.9});
  checks.curve(passing);
}

void check_bar(Checks& checks) {
  // Rayleigh and Love: the bar's sides breathe, which slows wave number k by nu'^2 (k H)^2 / 24, its group by 3 times
  // that, nu' = nu/(1 - nu). Thinner bars of four cells each: the plane-strain speed of a bar remains.
  for (const int n : {32, 64, 128}) {
    const Front front = send(Wave::bar, n);
    const double kh = pi / 0.16 * (4 * 0.16 / n);
    checks.setting(fmt::format("{} cells in the rise, 4 in the height", n));
    checks.within("speed of the front", front.speed, c_bar, front_bound(n) + std::pow(0.3 / 0.7 * kh, 2) / 8, "m/s");
    checks.at_most("mirror symmetry", front.mirror, 1e-11);
  }
}

void check_speeds(Checks& checks) {
  checks.within("c_P", c_p, 5856.36, 1e-6, "m/s");
  checks.within("c_S", c_s, 3130.35, 1e-6 + 0.005 / 3130, "m/s");
  checks.within("plane-strain bar", c_bar, 5291.26, 1e-6 + 0.005 / 5291, "m/s");
}

// --- standing waves

struct Errors {
  double displacement;
  double stress;
};

/// P or S standing wave after 9/8 of a period, so that an error of phase shows as well as one of amplitude.
Errors stand(bool shear, double element_size, const char* diagonals) {
  Case c = load("waves/standing.toml", {fmt::format("bodies.block.mesh.diagonals=\"{}\"", diagonals)});
  std::get<RectangleMesh>(c.bodies[0].mesh).element_size = element_size;
  CosineMode& mode = *c.bodies[0].cosine_mode;
  if (shear) {
    hold(c, true);
    std::swap(mode.amplitude.x, mode.amplitude.y);
  }
  const double speed = shear ? c_s : c_p;
  const double k = mode.wave_vector.x;
  const double omega = speed * k;
  c.run.end_time = 9.0 / 8 * 2 * pi / omega;
  Run run(c);
  run.run();
  const Vec2 amplitude = (std::sin(omega * run.time()) / omega) * mode.amplitude;
  const Norms u = displacement_error(run, [&](Vec2 p) { return std::cos(k * p.x) * amplitude; });
  const Norms s = stress_error(run, [&](Vec2 p) {
    const Vec2 slope = (-k * std::sin(k * p.x)) * amplitude;
    return SymTensor<double>{steel.wave_modulus() * slope.x, steel.lambda * slope.x, steel.shear_modulus * slope.y,
                             steel.lambda * slope.x};
  });
  return {u.relative(), s.relative()};
}

/// Lame's mode of a free square of side L: u = (cos kx sin ky, -sin kx cos ky), k = pi / L, frequency sqrt(2) c_S k.
/// No traction on any side, so nothing holds the body.
Errors ring(double side, double element_size, const char* diagonals) {
  Case c = load("waves/standing.toml", {fmt::format("bodies.block.mesh.diagonals=\"{}\"", diagonals)});
  c.supports.clear();
  RectangleMesh& mesh = std::get<RectangleMesh>(c.bodies[0].mesh);
  mesh.size = {side, side};
  mesh.element_size = element_size;
  const double k = pi / side;
  const double omega = std::sqrt(2.0) * c_s * k;
  c.run.end_time = 9.0 / 8 * 2 * pi / omega;
  Model model = build_model(c);
  const auto shape = [&](Vec2 p) {
    return Vec2{std::cos(k * p.x) * std::sin(k * p.y), -std::sin(k * p.x) * std::cos(k * p.y)};
  };
  constexpr double speed = 0.01;  // m/s
  for (Index i = 0; i < model.node_count; ++i) model.start_velocity[i] = speed * shape(model.rest[i]);
  ModelRun run(std::move(model));
  while (!run.done()) run.step();
  const double amplitude = speed * std::sin(omega * run.time()) / omega;
  const Norms u = displacement_error(run, [&](Vec2 p) { return amplitude * shape(p); });
  const Norms s = stress_error(run, [&](Vec2 p) {
    const double stretch = -2 * steel.shear_modulus * amplitude * k * std::sin(k * p.x) * std::sin(k * p.y);
    return SymTensor<double>{stretch, -stretch, 0, 0};
  });
  return {u.relative(), s.relative()};
}

/// Bounds from theory. Stress: the error of the finite element stress is about that of linear interpolation (best in
/// the energy norm). In a right triangle of leg h a derivative along a leg is taken from the middle of that leg: for a
/// wave along x that is off by h/6 from the centroid, and a constant cannot follow the slope (h^2/18): k h sqrt(1/18 +
/// 1/36). For Lame's mode all derivatives count: k h sqrt(2.06 / 2) with lambda = 1.5 G. A fifth more for dispersion.
/// Displacement: interpolation (k h)^2 / 8 at most, and the phase w t (k h)^2 / 24, at 9/8 of a period 0.29 (k h)^2; on
/// meshes with two kinds of nodes up to twice that.
constexpr double plane_stress_factor = 1.2 * 0.28868;
constexpr double lame_stress_factor = 1.2 * 1.0155 / std::numbers::sqrt2;  // k is sqrt(2) pi / L here

template <class Solve>
void check_mode(Checks& checks, const std::string& name, double wave_number, double stress_factor,
                const std::vector<double>& sizes, Solve&& solve) {
  ErrorSeries displacement{.what = name + ": displacement, L2 error"};
  ErrorSeries stress{.what = name + ": stress, L2 error"};
  for (const double h : sizes) {
    const Errors e = solve(h);
    const double kh = wave_number * h;
    checks.setting(fmt::format("h = {} mm, k h = {:.3f}", 1e3 * h, kh));
    const double displacement_bound = (1.0 / 8 + 2 * 0.29) * kh * kh;
    checks.at_most(name + ": displacement, L2 error", e.displacement, displacement_bound);
    checks.at_most(name + ": stress, L2 error", e.stress, stress_factor * kh);
    displacement.add(h, e.displacement, displacement_bound);
    stress.add(h, e.stress, stress_factor * kh);
  }
  checks.order(displacement, {.expected = 2, .least = 1.9});
  checks.order(stress, {.expected = 1, .least = 0.9});
}

const std::vector<double> coarse{0.02, 0.01, 0.005};
const std::vector<double> medium{0.01, 0.005, 0.0025};
const std::vector<double> fine{0.00125, 0.000625};

void check_plane(Checks& checks, bool shear, const char* diagonals, const std::vector<double>& sizes) {
  check_mode(checks, diagonals, 2 * pi / 0.4, plane_stress_factor, sizes,
             [&](double h) { return stand(shear, h, diagonals); });
}

void check_lame(Checks& checks, const char* diagonals, const std::vector<double>& sizes) {
  check_mode(checks, diagonals, std::sqrt(2.0) * pi / 0.2, lame_stress_factor, sizes,
             [&](double h) { return ring(0.2, h, diagonals); });
}

constexpr std::array<const char*, 3> all_diagonals{"right", "alternating", "crossed"};

}  // namespace

Problem waves() {
  const auto plane = [](bool shear) {
    return [shear](Checks& checks) {
      for (const char* d : all_diagonals) check_plane(checks, shear, d, coarse);
    };
  };
  const auto fine_plane = [](bool shear) {
    return [shear](Checks& checks) { check_plane(checks, shear, "alternating", fine); };
  };
  const auto lame = [](Checks& checks) {
    for (const char* d : all_diagonals) check_lame(checks, d, medium);
  };
  return {.topic = Topic::waves,
          .parts = {
              {"the speeds", check_speeds},
              {"P front", [](Checks& checks) { check_front(checks, Wave::p, c_p); }},
              {"S front", [](Checks& checks) { check_front(checks, Wave::s, c_s); }},
              {"front in a slender bar", check_bar},
              {"standing P wave", plane(false)},
              {"standing S wave", plane(true)},
              {"Lame's mode of a free square", lame},
              {.name = "standing P wave, finer meshes", .check = fine_plane(false), .is_long = true},
              {.name = "standing S wave, finer meshes", .check = fine_plane(true), .is_long = true},
              {.name = "Lame's mode, finer meshes",
               .check = [](Checks& checks) { check_lame(checks, "alternating", fine); },
               .is_long = true},
          }};
}

}  // namespace udar::verification

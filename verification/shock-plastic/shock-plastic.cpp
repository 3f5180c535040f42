// shock-plastic: elastic precursor and plastic front, against the jump conditions. See README.md.

#include <fmt/core.h>

#include "tools.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

constexpr double density = 7850;
constexpr double poisson = 0.3;
constexpr double yield = 400e6;
constexpr double impact = 100;
constexpr double height = 0.002;
constexpr double end_time = 18e-6;  // s
const Elasticity steel = elasticity_of(200e9, poisson);

/// Two fronts into bar at rest stress, in material coordinates. Lateral strains are 0, so the Cauchy stress is the
/// force on the undeformed section. The law in rate form makes it a function of the logarithmic strain e = ln(1 -
/// shortening): (lambda + 2 G) e up to the elastic limit, slope K behind. Both branches stiffen with compression, so
/// both fronts are shocks (Rankine and Hugoniot): speed^2 = [stress] / (density [shortening]), velocity jump =
/// [stress]/(density speed).
struct Exact {
  double elastic_limit;    ///< Pa, 2 k (1 - nu)/(1 - 2 nu)
  double precursor_speed;  ///< m/s
  double plastic_speed;    ///< m/s
  double precursor_jump;   ///< m/s
  double pressure;         ///< Pa, -s_x behind both

  Exact() {
    elastic_limit = yield * (1 - poisson) / (1 - 2 * poisson);
    const double e_limit = elastic_limit / steel.wave_modulus();
    const double shortening = 1 - std::exp(-e_limit);
    precursor_speed = std::sqrt(elastic_limit / (density * shortening));
    precursor_jump = elastic_limit / (density * precursor_speed);
    const auto jump = [&](double e) {
      const double stress = steel.bulk_modulus() * (e - e_limit);
      const double more = std::exp(-e_limit) - std::exp(-e);
      return precursor_jump + std::sqrt(stress * more / density) - impact;
    };
    const double e = root_between(jump, e_limit * (1 + 1e-9), 0.2);
    const double stress = steel.bulk_modulus() * (e - e_limit);
    plastic_speed = std::sqrt(stress / (density * (std::exp(-e_limit) - std::exp(-e))));
    pressure = elastic_limit + stress;
  }
};

struct Shock {
  double precursor_speed;
  double plastic_speed;
  double precursor;  ///< Pa, mean of s_x between the fronts
  double plateau;    ///< Pa, mean of s_x behind both
  double lateral_y;  ///< Pa, mean of s_y - s_x there
  double lateral_z;
  double overshoot;     ///< largest -s_x over the exact plateau
  double wall_force;    ///< N, mean
  double yield_excess;  ///< largest difference of principal stresses over the yield stress, less 1
  double momentum;
  double energy;
  double mirror;
  CheckLine along;  ///< s_x along the bar at the end, mean of each column of cells, in undeformed coordinates
};

/// Mean s_x of each column of cells.
CheckLine stress_along(const Run& run, double element_size) {
  std::map<long long, std::pair<double, int>> columns;
  for (Index e = 0; e < run.model.bodies[0].element_end; ++e) {
    auto& [sum, count] = columns[std::llround(std::floor(rest_centroid(run.model, e).x / element_size))];
    sum += run.state.stress_xx[e];
    ++count;
  }
  CheckLine line{.name = fmt::format("h = {} mm", 1e3 * element_size), .x = {}, .y = {}};
  for (const auto& [column, mean] : columns) {
    line.x.push_back((static_cast<double>(column) + 0.5) * element_size);
    line.y.push_back(mean.first / mean.second);
  }
  return line;
}

Shock strike(double element_size) {
  const Exact exact;
  Run run(load("shock-plastic/shock-plastic.toml",
               {fmt::format("bodies.bar.mesh.element_size={} mm", 1e3 * element_size)}));
  const Body& body = run.model.bodies[0];
  // Mean of s_x over the column of elements at two stations, in undeformed coordinates.
  constexpr std::array<double, 2> stations{0.02, 0.07};
  std::array<std::vector<Index>, 2> columns;
  for (Index e = body.element_begin; e < body.element_end; ++e) {
    const double x = rest_centroid(run.model, e).x;
    for (std::size_t s = 0; s < 2; ++s) {
      if (std::fabs(x - stations[s]) < element_size) columns[s].push_back(e);
    }
  }
  std::array<Record, 2> pressure;
  Record wall;
  Shock out{};
  run.run([&](const Run& now) {
    for (std::size_t s = 0; s < 2; ++s) {
      double sum = 0;
      for (const Index e : columns[s]) sum -= now.state.stress_xx[e];
      pressure[s].add(now.time(), sum / static_cast<double>(columns[s].size()));
    }
    wall.add(now.time(), now.state.obstacles[0].total.force.x);
    for (Index e = body.element_begin; e < body.element_end; ++e) {
      const SymTensor<double> s = stress_of(now.state, e);
      out.overshoot = std::max(out.overshoot, -s.xx / exact.pressure - 1);
      const double centre = 0.5 * (s.xx + s.yy);
      const double radius = std::hypot(0.5 * (s.xx - s.yy), s.xy);
      const double largest = std::max(centre + radius, s.zz);
      const double smallest = std::min(centre - radius, s.zz);
      out.yield_excess = std::max(out.yield_excess, (largest - smallest) / yield - 1);
    }
  });

  const double way = stations[1] - stations[0];
  const auto speed = [&](double level) { return way / (pressure[1].passes(level) - pressure[0].passes(level)); };
  out.precursor_speed = speed(0.5 * exact.elastic_limit);
  out.plastic_speed = speed(0.5 * (exact.elastic_limit + exact.pressure));
  const double end = run.time();
  out.wall_force = wall.mean(0.3 * end, 0.9 * end);
  // At the far station between the fronts: the middle third of the time between them.
  const double first = stations[1] / exact.precursor_speed;
  const double second = stations[1] / exact.plastic_speed;
  out.precursor = -pressure[1].mean(first + (second - first) / 3, second - (second - first) / 3);
  // The plateau now: between the wall's neighbourhood and the plastic front, in undeformed coordinates.
  double area = 0;
  for (Index e = body.element_begin; e < body.element_end; ++e) {
    const double x = rest_centroid(run.model, e).x;
    if (x < 0.2 * exact.plastic_speed * end || x > 0.8 * exact.plastic_speed * end) continue;
    const SymTensor<double> s = stress_of(run.state, e);
    const double a = run.model.area_density[e];
    area += a;
    out.plateau += a * s.xx;
    out.lateral_y += a * (s.yy - s.xx);
    out.lateral_z += a * (s.zz - s.xx);
  }
  for (double* mean : {&out.plateau, &out.lateral_y, &out.lateral_z}) *mean /= area;
  out.along = stress_along(run, element_size);
  out.momentum = momentum_error(run);
  out.energy = run.state.ledger.energy_error();
  out.mirror = mirror_error(run, false, 0.5 * height, 1);
  return out;
}

/// Returns how much of the difference s_z - s_x the ringing took away.
double check(Checks& checks, double element_size, CheckCurve& along) {
  const Exact exact;
  const Shock s = strike(element_size);
  checks.setting(fmt::format("h = {} mm", 1e3 * element_size));
  // The half level lags by a fixed part (below one) of Airy's length: it grows from station to station by the
  // difference.
  const double lag = (airy_length(element_size, 0.07) - airy_length(element_size, 0.02)) / 0.05;
  checks.within("speed of the precursor", s.precursor_speed, exact.precursor_speed, lag, "m/s");
  // The front's speed follows from the pressure on the plateau by momentum: [stress] = density speed [velocity].
  const double by_momentum = (-s.plateau - exact.elastic_limit) / (density * (impact - exact.precursor_jump));
  checks.within("speed of the plastic front, by momentum and the plateau", s.plastic_speed, by_momentum, lag, "m/s");
  checks.within("speed of the plastic front", s.plastic_speed, exact.plastic_speed, 0.01, "m/s");
  checks.within("plateau s_x", s.plateau, -exact.pressure, 0.01, "Pa");
  checks.within("plateau s_y", s.plateau + s.lateral_y, yield - exact.pressure, 0.01, "Pa");
  checks.within("plateau s_z", s.plateau + s.lateral_z, yield - exact.pressure, 0.01, "Pa");
  checks.within("wall force", s.wall_force, exact.pressure * height, 0.01, "N");
  // The return to the yield surface is exact, up to rounding of stresses 10 times as large.
  checks.at_most("largest excess over the yield condition", s.yield_excess, 1e-13);
  checks.at_most("momentum: change less impulses", s.momentum, 1e-12);
  checks.at_most("energy error", s.energy, 5e-3);
  checks.at_most("mirror symmetry", s.mirror, 1e-9);
  checks.note(fmt::format(
      "h = {} mm: s_x between the fronts {:.5g} MPa, exact {:.5g} MPa; overshoot of a single element {:.3g} %.",
      1e3 * element_size, 1e-6 * s.precursor, -1e-6 * exact.elastic_limit, 100 * s.overshoot));
  along.lines.push_back(s.along);
  return 1 - s.lateral_z / yield;
}

/// The ringing behind the front unloads elements elastically and leaves them inside the yield surface: s_z - s_x is
/// below the yield stress on the mean and s_x too small by less than half of that. The loss of a particle falls with
/// the number of cells that the front has run to it as (cells)^(-1/3), the order of a jump: at least 1/3 over the
/// plateau.
void check_meshes(Checks& checks, const std::vector<double>& sizes) {
  const Exact exact;
  ErrorSeries inside{.what = "1 - (s_z - s_x) / yield stress, mean over the plateau"};
  CheckCurve along{.title = "Stress along the bar after 18 us, two fronts",
                   .x_label = "distance from the wall, undeformed",
                   .x_unit = "m",
                   .y_label = "s_x",
                   .y_unit = "Pa"};
  for (const double h : sizes) inside.add(h, check(checks, h, along));
  checks.order(inside, {.expected = 1.0 / 3, .least = 0.3});
  const double plastic = exact.plastic_speed * end_time;
  const double elastic = exact.precursor_speed * end_time;
  along.lines.erase(along.lines.begin() + 1, along.lines.end() - 1);  // the coarsest and the finest
  along.lines.push_back({.name = "exact",
                         .exact = true,
                         .x = {0, plastic, plastic, elastic, elastic, 0.12},
                         .y = {-exact.pressure, -exact.pressure, -exact.elastic_limit, -exact.elastic_limit, 0, 0}});
  checks.curve(along);
}

void check_exact(Checks& checks) {
  const Exact exact;
  checks.within("elastic limit", exact.elastic_limit, 700e6, 1e-12, "Pa");
  checks.within("s_x", -exact.pressure, -3.7849e9, 0.00005 / 3.7849, "Pa");
  checks.within("precursor", exact.precursor_speed, 5860.2, 0.05 / 5860, "m/s");
  checks.within("plastic front", exact.plastic_speed, 4635.1, 0.05 / 4635, "m/s");
  // Small strains: c_P and sqrt(K / density).
  checks.within("small strain: plastic front", std::sqrt(steel.bulk_modulus() / density), 4607.76, 0.005 / 4607, "m/s");
  const double c = std::sqrt(steel.wave_modulus() / density);
  const double small = 700e6 + density * std::sqrt(steel.bulk_modulus() / density) * (impact - 700e6 / (density * c));
  checks.within("small strain: s_x", -small, -3.76633e9, 0.000005 / 3.76633, "Pa");
}

}  // namespace

Problem shock_plastic() {
  return {.topic = Topic::plasticity,
          .parts = {{"the exact answer", check_exact},
                    {"fronts and plateau",
                     [](Checks& checks) {
                       check_meshes(checks, {0.5e-3, 0.25e-3});
                     }},
                    {.name = "finer meshes",
                     .check =
                         [](Checks& checks) {
                           check_meshes(checks, {0.25e-3, 0.125e-3, 0.0625e-3});
                         },
                     .is_long = true}}};
}

}  // namespace udar::verification

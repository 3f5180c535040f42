// short-beam: fronts, the plateau under the stop, accelerations. See README.md.

#include "short_beam.hpp"
#include "tools.hpp"

namespace udar::verification::short_beam_parts {
namespace {

// --- waves

/// -sigma_y of elements above the middle of the stop, against time.
struct Stations {
  std::vector<Vec2> places;  // m, undeformed centroids
  std::vector<Record> pressures;
};

Stations watch(const Changes& changes, const std::vector<double>& heights) {
  Case input = beam_case(changes);
  for (std::size_t k = 0; k < heights.size(); ++k) {
    input.observed_elements.push_back({.name = fmt::format("station{}", k), .body = "beam", .at = {0, heights[k]}});
  }
  Run run(input);
  Stations stations;
  std::vector<Index> elements;
  for (std::size_t k = 0; k < heights.size(); ++k) {
    elements.push_back(element_called(run.model, fmt::format("station{}", k)));
    stations.places.push_back(rest_centroid(run.model, elements.back()));
  }
  stations.pressures.resize(heights.size());
  run.run([&](const Run& now) {
    for (std::size_t k = 0; k < elements.size(); ++k) {
      stations.pressures[k].add(now.time(), -now.state.stress_yy[elements[k]]);
    }
  });
  return stations;
}

double front_speed(const Stations& s, double level) {
  return (s.places[1].y - s.places[0].y) / (s.pressures[1].passes(level) - s.pressures[0].passes(level));
}

// A step of stress is spread by the mesh into the integral of an Airy function, whose width grows with
// (element^2 path)^(1/3). What stays on the exact front is a third of the step; the half comes later, by an amount that
// falls with element^(2/3). So the 1 % are asked of a third of the precursor on the medium mesh, and of the half of it
// on the fine mesh and in the limit of fine meshes.
const std::vector<double> front_stations{2.4 * cm, 7.4 * cm};
constexpr double half = elastic_limit / 2;
constexpr double third = elastic_limit / 3;
const std::string front_time = end_time("0.018 ms");

}  // namespace

void check_first_front(Checks& checks) {
  const Stations s = watch(medium + front_time, front_stations);
  const double speed = front_speed(s, half);
  compare(checks, "first front, 0.25 cm, third of the precursor", front_speed(s, third), pressure_wave, 0.01, "m/s",
          "m/s");
  const double finer = front_speed(watch(mesh("0.125 cm", "3.2e-8 s") + front_time, front_stations), half);
  checks.page_row("first front, 0.25 cm, half of the precursor",
                  fmt::format("{:.5g} m/s | {:.5g} m/s | {:.2f} % | none", speed, pressure_wave,
                              100 * (1 - speed / pressure_wave)));
  checks.page_row("first front, 0.125 cm, half of the precursor",
                  fmt::format("{:.5g} m/s | {:.5g} m/s | {:.2f} % | none", finer, pressure_wave,
                              100 * (1 - finer / pressure_wave)));
  checks.below("first front late on the finer mesh, half of the precursor", pressure_wave - finer,
               pressure_wave - speed, "m/s");
  const double limit = finer + (finer - speed) / (std::cbrt(4.0) - 1);
  compare(checks, "first front, limit of the first two with order 2/3", limit, pressure_wave, 0.01, "m/s", "m/s");
}

void check_first_front_fine(Checks& checks) {
  const Stations s = watch(mesh("0.0625 cm", "1.6e-8 s") + front_time, front_stations);
  compare(checks, "first front, 0.0625 cm, half of the precursor", front_speed(s, half), pressure_wave, 0.01, "m/s",
          "m/s");
}

namespace {

/// Behind the main plastic front, in uniaxial strain at the speed of the impact; pressure positive, Pa.
const double plateau =
    elastic_limit + density * plastic_wave * (start_velocity - elastic_limit / (density * pressure_wave));

}  // namespace

void check_plastic_front(Checks& checks) {
  // Release from the corners of the stop overtakes this front 3.35 cm above it.
  const Stations s = watch(medium + end_time("0.012 ms"), {0.9 * cm, 2.4 * cm});
  compare(checks, "main plastic front", front_speed(s, 0.5 * (elastic_limit + plateau)), plastic_wave, 0.03, "m/s",
          "m/s");
}

void check_tension(Checks& checks) {
  // In an elastic beam twice as high nothing returns as yet; what its stress differs by has come from the top.
  const Changes changes = medium + elastic + end_time("0.042 ms");
  const std::vector<double> heights{0.1 * cm, 5.1 * cm, 7.6 * cm};
  const Stations low = watch(changes, heights);
  const Stations high = watch(changes + "bodies.beam.mesh.size=[\"40 cm\", \"20 cm\"]", heights);
  for (std::size_t k = 0; k < heights.size(); ++k) {
    Record tension;
    const Record& pressure = low.pressures[k];
    for (std::size_t i = 0; i < pressure.times.size(); ++i) {
      tension.add(pressure.times[i], high.pressures[k].values[i] - pressure.values[i]);
    }
    const double path = 2 * height - low.places[k].y;
    const double step = density * pressure_wave * start_velocity;
    const double arrival = tension.passes(step / 3);
    compare(checks, fmt::format("tension from the top at y = {:.2f} cm, path over time", low.places[k].y / cm),
            path / arrival, pressure_wave, 0.05, "m/s", "m/s");
    checks.setting(fmt::format("y = {:.2f} cm", low.places[k].y / cm));
    checks.below("tension before it comes, over rho c V", tension.mean(0, 0.9 * arrival) / step, 0.01);
    checks.above("tension after it came, over rho c V", tension.mean(arrival, arrival + 2e-6) / step, 0.5);
    checks.setting("");
  }
  // In the Tresca beam the tension is stronger than what is left of the pressure.
  const Stations plastic = watch(medium + end_time("0.042 ms"), {7.6 * cm});
  const double lowest = *std::ranges::min_element(plastic.pressures[0].values);
  checks.page_row("largest tension 2.4 cm below the top, Tresca",
                  fmt::format("{:.0f} kgf/cm2 | above 2400 kgf/cm2 | |", -lowest / kgf_cm2));
  checks.above("largest tension 2.4 cm below the top, Tresca", -lowest, yield_stress, "Pa");
}

namespace {

/// Means over 2 to 5 us in the bottom element above the middle of the stop; pressure positive, Pa.
SymTensor<double> plateau_stress(const Changes& changes) {
  Run run(beam_case(changes + end_time("5.1 us")));
  const Index bottom = element_called(run.model, "bottom");
  Record xx, yy, xy, zz;
  run.run([&](const Run& now) {
    const SymTensor<double> s = stress_of(now.state, bottom);
    xx.add(now.time(), -s.xx), yy.add(now.time(), -s.yy), xy.add(now.time(), -s.xy), zz.add(now.time(), -s.zz);
  });
  const auto mean = [](const Record& r) { return r.mean(2e-6, 5e-6) / kgf_cm2; };
  return {mean(xx), mean(yy), mean(xy), mean(zz)};
}

}  // namespace

void check_plateau(Checks& checks) {
  const SymTensor<double> springy = plateau_stress(medium + elastic);
  const double rho_c_v = density * pressure_wave * start_velocity / kgf_cm2;
  compare(checks, "plateau, elastic", springy.yy, rho_c_v, 0.05, "kgf/cm2", "Pa", kgf_cm2);
  compare(checks, "plateau, elastic: lateral stress", springy.xx, rho_c_v * poisson_ratio / (1 - poisson_ratio), 0.05,
          "kgf/cm2", "Pa", kgf_cm2);
  const SymTensor<double> plastic = plateau_stress(medium);
  compare(checks, "plateau, Tresca", plastic.yy, plateau / kgf_cm2, 0.05, "kgf/cm2", "Pa", kgf_cm2);
  checks.page_row(
      "plateau, Tresca: lateral stress less by",
      fmt::format("{:.0f} kgf/cm2 | {:.0f} kgf/cm2 | | none", plastic.yy - plastic.xx, yield_stress / kgf_cm2));
}

void check_lateral(Checks& checks) {
  // The stiff springs of the case load an element in less than the time a wave needs to cross it. Its stress overshoots
  // by a tenth, 2700 kgf/cm2, and comes back elastically: that takes 1800 of the 2400 kgf/cm2 of difference away, on
  // any mesh. Springs that load it over some ten crossings, on a mesh fine enough for that, leave the difference alone.
  const SymTensor<double> s = plateau_stress(mesh("0.0625 cm", "1.6e-8 s") + "obstacles.stop.stiffness=4e5 kgf/cm");
  compare(checks, "plateau, Tresca, smooth front", s.yy, plateau / kgf_cm2, 0.05, "kgf/cm2", "Pa", kgf_cm2);
  compare(checks, "plateau, Tresca, smooth front: lateral stress x less by", s.yy - s.xx, yield_stress / kgf_cm2, 0.05,
          "kgf/cm2", "Pa", kgf_cm2);
  compare(checks, "plateau, Tresca, smooth front: lateral stress z less by", s.yy - s.zz, yield_stress / kgf_cm2, 0.05,
          "kgf/cm2", "Pa", kgf_cm2);
}

// --- accelerations

namespace {

struct Accelerations {
  double node = 0;            // m/s2, largest upwards
  double centre_of_mass = 0;  // m/s2
};

Accelerations accelerations(const Changes& changes) {
  Run run(beam_case(changes + end_time("0.12 ms")));
  const Index node = node_called(run.model, "lower_edge").node;
  const double mass = run.model.bodies.front().mass;
  Accelerations largest;
  run.run([&](const Run& now) {
    double force = 0;
    for (Index i = 0; i < now.model.node_count; ++i) force += now.model.mass[i] * now.state.acceleration[i].y;
    largest.node = std::max(largest.node, now.state.acceleration[node].y);
    largest.centre_of_mass = std::max(largest.centre_of_mass, force / mass);
  });
  return largest;
}

}  // namespace

void check_accelerations(Checks& checks) {
  const std::vector<std::pair<std::string, Accelerations>> runs{{"1 cm", accelerations(coarse)},
                                                                {"0.5 cm", accelerations(mesh("0.5 cm", "1.28e-7 s"))},
                                                                {"0.25 cm", accelerations(medium)}};
  const std::vector<Accelerations> reference{{3.71e7, 4.96e5}, {7.42e7, 4.61e5}, {1.48e8, 4.87e5}};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto& [size, a] = runs[k];
    compare(checks, "largest acceleration of node (0, 0), " + size, a.node, reference[k].node, 0.02, "m/s2", "m/s^2");
    compare(checks, "largest acceleration of the centre of mass, " + size, a.centre_of_mass,
            reference[k].centre_of_mass, 0.02, "m/s2", "m/s^2");
    if (k > 0) {
      // Doubled, a tenth of the original and the larger number for the bound.
      checks.near("acceleration of the node over that on twice the elements, " + size, a.node / runs[k - 1].second.node,
                  2, 0.2);
    }
  }
  const auto [smallest, largest] =
      std::minmax({runs[0].second.centre_of_mass, runs[1].second.centre_of_mass, runs[2].second.centre_of_mass});
  checks.at_most("acceleration of the centre of mass, largest over smallest", largest / smallest, 1.1);
}

}  // namespace udar::verification::short_beam_parts

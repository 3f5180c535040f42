#include "short_beam.hpp"

#include "wave_tools.hpp"

namespace udar::verification {
namespace {

// --- the table: against an independent program of the same method

struct Reference {
  std::string name;
  Changes changes;
  double displacement;    // m
  double velocity;        // m/s
  double duration;        // s
  double velocity_after;  // m/s
  double energy_bound;
};

constexpr double plastic_books = 0.0005;
constexpr double elastic_books = 0.001;

void compare(const Reference& reference) {
  const Impact impact = strike(short_beam(reference.changes));
  const auto cell = [](double computed, double expected, double scale) {
    return fmt::format("{:.4g} ({:+.2f} %)", scale * computed, 100 * (computed / expected - 1));
  };
  tell(reference.name,
       fmt::format("{} | {} | {} | {} | {:.4f} %", cell(impact.displacement, reference.displacement, 1 / cm),
                   cell(impact.velocity, reference.velocity, 1), cell(impact.duration(), reference.duration, 1e3),
                   cell(impact.velocity_after, reference.velocity_after, 1), 100 * impact.energy_error));
  CHECK(impact.displacement == doctest::Approx(reference.displacement).epsilon(0.01));
  CHECK(impact.velocity == doctest::Approx(reference.velocity).epsilon(0.01));
  CHECK(impact.duration() == doctest::Approx(reference.duration).epsilon(0.02));
  CHECK(impact.velocity_after == doctest::Approx(reference.velocity_after).epsilon(0.02));
  CHECK(impact.energy_error <= reference.energy_bound);
  CHECK(impact.shortened == 0);
}

TEST_CASE("coarse rows of the table") {
  compare({"coarse, right, Tresca", coarse + diagonals("right"), -0.03694, -87.56, 1.188e-3, 2.95, plastic_books});
  compare({"coarse, right, elastic", coarse + diagonals("right") + elastic, -0.01079, -148.60, 0.288e-3, 53.42,
           elastic_books});
  compare({"coarse, alternating, Tresca", coarse, -0.04186, -89.10, 1.348e-3, 3.14, plastic_books});
  compare({"coarse, alternating, elastic", coarse + elastic, -0.01094, -151.22, 0.287e-3, 53.95, elastic_books});
}

TEST_CASE("medium row of the table, alternating diagonals, Tresca") {
  compare({"medium, alternating, Tresca", medium, -0.04177, -88.88, 1.375e-3, 2.86, plastic_books});
}

TEST_CASE("medium row of the table, right diagonals, Tresca (long)") {
  compare({"medium, right, Tresca", medium + diagonals("right"), -0.04137, -88.21, 1.346e-3, 3.33, plastic_books});
}

TEST_CASE("medium row of the table, alternating diagonals, elastic (long)") {
  compare({"medium, alternating, elastic", medium + elastic, -0.01099, -168.07, 0.279e-3, 52.99, elastic_books});
}

TEST_CASE("crossed row of the table, Tresca (long)") {
  compare({"crossed, Tresca", mesh("0.25 cm", "3.2e-8 s") + diagonals("crossed"), -0.04156, -88.81, 1.382e-3, 2.83,
           plastic_books});
}

TEST_CASE("plastic contact lasts much longer than elastic contact, and plastic flow eats most of the energy") {
  const Impact plastic = strike(short_beam(coarse));
  const Impact springy = strike(short_beam(coarse + elastic));
  tell("plastic contact over elastic contact (coarse)", fmt::format("{:.2f} | above 3 | |", plastic.duration() / springy.duration()));
  tell("plastic work over start energy (coarse)", fmt::format("{:.1f} % | above 50 % | |", 100 * plastic.plastic_part));
  CHECK(plastic.duration() > 3 * springy.duration());
  CHECK(plastic.plastic_part > 0.5);
  CHECK(springy.plastic_part == 0);
  CHECK(plastic.velocity_after < 0.1 * springy.velocity_after);
}

// --- integrators

void compare_integrators(const std::string& name, const Changes& changes) {
  const Impact central = strike(short_beam(changes));
  const Impact adams = strike(short_beam(changes + integrator("adams")));
  const double d = std::fabs(adams.displacement / central.displacement - 1);
  const double v = std::fabs(adams.velocity / central.velocity - 1);
  const double t = std::fabs(adams.duration() / central.duration() - 1);
  const double after = std::fabs(adams.velocity_after / central.velocity_after - 1);
  tell(name, fmt::format("{:.3f} % | {:.3f} % | {:.3f} % | {:.3f} % | {:.4f} %", 100 * d, 100 * v, 100 * t, 100 * after,
                         100 * adams.energy_error));
  CHECK(d <= 0.003);
  CHECK(v <= 0.003);
  CHECK(t <= 0.003);
  CHECK(after <= 0.003);
}

TEST_CASE("adams agrees with central difference, coarse") {
  compare_integrators("adams, coarse, Tresca", coarse);
  compare_integrators("adams, coarse, elastic", coarse + elastic);
}

TEST_CASE("adams agrees with central difference, medium, Tresca (long)") {
  compare_integrators("adams, medium, Tresca", medium);
}

TEST_CASE("adams agrees with central difference, medium, elastic (long)") {
  compare_integrators("adams, medium, elastic", medium + elastic);
}

TEST_CASE("adams2 blows up on the elastic beam") {
  Run run(short_beam(coarse + elastic + integrator("adams2") + "run.when_unstable=continue"));
  std::string stopped = "no";
  try {
    run.run();
  } catch (const NumericalError& error) {
    stopped = fmt::format("at {:.2f} ms", 1e3 * run.time());
  }
  const double energy_error = run.state.ledger.energy_error();
  tell("adams2, coarse, elastic: energy error; stopped", fmt::format("{:.3g} %; {} | above 100 %, or a stop | |", 100 * energy_error, stopped));
  CHECK((stopped != "no" || energy_error > 1));
}

// --- waves

/// -sigma_y of elements above the middle of the stop, against time.
struct Stations {
  std::vector<Vec2> places;  // m, undeformed centroids
  std::vector<Record> pressures;
};

Stations watch(Case input, const std::vector<double>& heights) {
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

TEST_CASE("the first front runs with the speed of pressure waves") {
  const double level = 0.5 * elastic_limit;
  const Changes changes = medium + end_time("0.03 ms");
  const std::vector<double> heights{2.4 * cm, 7.4 * cm};
  CHECK(holds("first front, Tresca", front_speed(watch(short_beam(changes), heights), level), pressure_wave, 0.01, "m/s"));
  CHECK(holds("first front, elastic", front_speed(watch(short_beam(changes + elastic), heights), level), pressure_wave,
              0.01, "m/s"));
}

TEST_CASE("the main plastic front runs with sqrt(K / density)") {
  const std::vector<double> heights{0.9 * cm, 2.4 * cm};
  const double plateau = elastic_limit + density * plastic_wave * (start_velocity - elastic_limit / (density * pressure_wave));
  const double level = 0.5 * (elastic_limit + plateau);
  CHECK(holds("main plastic front", front_speed(watch(short_beam(medium + end_time("0.03 ms")), heights), level), plastic_wave, 0.03,
              "m/s"));
}

TEST_CASE("the front returns from the top as tension") {
  const Stations s = watch(short_beam(medium + elastic + end_time("0.04 ms")), {5.1 * cm});
  const double path = 2 * height - s.places[0].y;
  const double arrival = s.pressures[0].passes(0, height / pressure_wave);
  CHECK(holds("tension from the top, speed over the path up and back", path / arrival, pressure_wave, 0.05, "m/s"));
  CHECK(s.pressures[0].mean(arrival, arrival + 1e-6) < 0);
}

/// Means over 2 to 5 us in the bottom element above the middle of the stop, Pa, pressure positive.
SymTensor<double> plateau_stress(const Changes& changes) {
  Run run(short_beam(changes));
  const Index bottom = element_called(run.model, "bottom");
  Record xx, yy, xy, zz;
  run.run([&](const Run& now) {
    const SymTensor<double> s = stress_of(now.state, bottom);
    xx.add(now.time(), -s.xx), yy.add(now.time(), -s.yy), xy.add(now.time(), -s.xy), zz.add(now.time(), -s.zz);
  });
  const auto mean = [](const Record& r) { return r.mean(2e-6, 5e-6); };
  return {mean(xx), mean(yy), mean(xy), mean(zz)};
}

TEST_CASE("the plateau under the stop") {
  const Changes changes = medium + end_time("6 us");
  const SymTensor<double> springy = plateau_stress(changes + elastic);
  const double rho_c_v = density * pressure_wave * start_velocity;
  CHECK(holds("plateau, elastic", springy.yy / kgf_cm2, rho_c_v / kgf_cm2, 0.05, "kgf/cm2"));

  const SymTensor<double> plastic = plateau_stress(changes);
  const double expected = elastic_limit + density * plastic_wave * (start_velocity - elastic_limit / (density * pressure_wave));
  CHECK(holds("plateau, Tresca", plastic.yy / kgf_cm2, expected / kgf_cm2, 0.05, "kgf/cm2"));
  CHECK(holds("plateau, Tresca: lateral stress less by", (plastic.yy - plastic.xx) / kgf_cm2, yield_stress / kgf_cm2, 0.05,
              "kgf/cm2"));
}

// --- accelerations

struct Accelerations {
  double node = 0;            // m/s2, largest upwards
  double centre_of_mass = 0;  // m/s2
};

Accelerations accelerations(const Changes& changes) {
  Run run(short_beam(changes + end_time("0.12 ms")));
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

TEST_CASE("the acceleration of a node grows without bound, that of the centre of mass converges") {
  const std::vector<std::pair<std::string, Accelerations>> runs{
      {"1 cm", accelerations(coarse)},
      {"0.5 cm", accelerations(mesh("0.5 cm", "1.28e-7 s"))},
      {"0.25 cm", accelerations(medium)}};
  const std::vector<Accelerations> reference{{3.71e7, 4.96e5}, {7.42e7, 4.61e5}, {1.48e8, 4.87e5}};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto& [size, a] = runs[k];
    CHECK(holds("largest acceleration of node (0, 0), " + size, a.node, reference[k].node, 0.02, "m/s2"));
    CHECK(holds("largest acceleration of the centre of mass, " + size, a.centre_of_mass, reference[k].centre_of_mass,
                0.02, "m/s2"));
    if (k > 0) CHECK(a.node / runs[k - 1].second.node == doctest::Approx(2).epsilon(0.1));
  }
  const auto [smallest, largest] = std::minmax({runs[0].second.centre_of_mass, runs[1].second.centre_of_mass,
                                               runs[2].second.centre_of_mass});
  CHECK(largest <= 1.1 * smallest);
}

}  // namespace
}  // namespace udar::verification

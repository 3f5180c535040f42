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
  tell("plastic contact over elastic contact, coarse",
       fmt::format("{:.2f} | above 3 | |", plastic.duration() / springy.duration()));
  tell("plastic work over start energy, coarse", fmt::format("{:.1f} % | above 50 % | |", 100 * plastic.plastic_part));
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
  tell("adams2, coarse, elastic: energy error; stopped",
       fmt::format("{:.3g} %; {} | above 100 %, or a stop | |", 100 * energy_error, stopped));
  CHECK((stopped != "no" || energy_error > 1));
}

// --- waves

/// -sigma_y of elements above the middle of the stop, against time.
struct Stations {
  std::vector<Vec2> places;  // m, undeformed centroids
  std::vector<Record> pressures;
};

Stations watch(const Changes& changes, const std::vector<double>& heights) {
  Case input = short_beam(changes);
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

TEST_CASE("the first front runs with the speed of pressure waves") {
  const Stations s = watch(medium + front_time, front_stations);
  const double speed = front_speed(s, half);
  CHECK(holds("first front, 0.25 cm, third of the precursor", front_speed(s, third), pressure_wave, 0.01, "m/s"));
  const double finer = front_speed(watch(mesh("0.125 cm", "3.2e-8 s") + front_time, front_stations), half);
  tell("first front, 0.25 cm, half of the precursor", fmt::format("{:.5g} m/s | {:.5g} m/s | {:.2f} % | none", speed,
                                                                  pressure_wave, 100 * (1 - speed / pressure_wave)));
  tell("first front, 0.125 cm, half of the precursor", fmt::format("{:.5g} m/s | {:.5g} m/s | {:.2f} % | none", finer,
                                                                   pressure_wave, 100 * (1 - finer / pressure_wave)));
  CHECK(pressure_wave - finer < pressure_wave - speed);
  const double limit = finer + (finer - speed) / (std::cbrt(4.0) - 1);
  CHECK(holds("first front, limit of the first two with order 2/3", limit, pressure_wave, 0.01, "m/s"));
}

TEST_CASE("the first front on the fine mesh (long)") {
  const Stations s = watch(mesh("0.0625 cm", "1.6e-8 s") + front_time, front_stations);
  CHECK(holds("first front, 0.0625 cm, half of the precursor", front_speed(s, half), pressure_wave, 0.01, "m/s"));
}

/// Behind the main plastic front, in uniaxial strain at the speed of the impact; pressure positive, Pa.
const double plateau =
    elastic_limit + density * plastic_wave * (start_velocity - elastic_limit / (density * pressure_wave));

TEST_CASE("the main plastic front runs with sqrt(K / density)") {
  // Release from the corners of the stop overtakes this front 3.35 cm above it.
  const Stations s = watch(medium + end_time("0.012 ms"), {0.9 * cm, 2.4 * cm});
  CHECK(holds("main plastic front", front_speed(s, 0.5 * (elastic_limit + plateau)), plastic_wave, 0.03, "m/s"));
}

TEST_CASE("the front returns from the top as tension") {
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
    CHECK(holds(fmt::format("tension from the top at y = {:.2f} cm, path over time", low.places[k].y / cm),
                path / arrival, pressure_wave, 0.05, "m/s"));
    CHECK(tension.mean(0, 0.9 * arrival) < 0.01 * step);
    CHECK(tension.mean(arrival, arrival + 2e-6) > 0.5 * step);
  }
  // In the Tresca beam the tension is stronger than what is left of the pressure.
  const Stations plastic = watch(medium + end_time("0.042 ms"), {7.6 * cm});
  const double lowest = *std::ranges::min_element(plastic.pressures[0].values);
  tell("largest tension 2.4 cm below the top, Tresca",
       fmt::format("{:.0f} kgf/cm2 | above 2400 kgf/cm2 | |", -lowest / kgf_cm2));
  CHECK(-lowest > yield_stress);
}

/// Means over 2 to 5 us in the bottom element above the middle of the stop; pressure positive, Pa.
SymTensor<double> plateau_stress(const Changes& changes) {
  Run run(short_beam(changes + end_time("5.1 us")));
  const Index bottom = element_called(run.model, "bottom");
  Record xx, yy, xy, zz;
  run.run([&](const Run& now) {
    const SymTensor<double> s = stress_of(now.state, bottom);
    xx.add(now.time(), -s.xx), yy.add(now.time(), -s.yy), xy.add(now.time(), -s.xy), zz.add(now.time(), -s.zz);
  });
  const auto mean = [](const Record& r) { return r.mean(2e-6, 5e-6) / kgf_cm2; };
  return {mean(xx), mean(yy), mean(xy), mean(zz)};
}

TEST_CASE("the plateau under the stop") {
  const SymTensor<double> springy = plateau_stress(medium + elastic);
  const double rho_c_v = density * pressure_wave * start_velocity / kgf_cm2;
  CHECK(holds("plateau, elastic", springy.yy, rho_c_v, 0.05, "kgf/cm2"));
  CHECK(holds("plateau, elastic: lateral stress", springy.xx, rho_c_v * poisson_ratio / (1 - poisson_ratio), 0.05,
              "kgf/cm2"));
  const SymTensor<double> plastic = plateau_stress(medium);
  CHECK(holds("plateau, Tresca", plastic.yy, plateau / kgf_cm2, 0.05, "kgf/cm2"));
  tell("plateau, Tresca: lateral stress less by",
       fmt::format("{:.0f} kgf/cm2 | {:.0f} kgf/cm2 | | none", plastic.yy - plastic.xx, yield_stress / kgf_cm2));
}

TEST_CASE("behind a smooth plastic front the lateral stress is less by the yield stress") {
  // The stiff springs of the case load an element in less than the time a wave needs to cross it. Its stress overshoots
  // by a tenth, 2700 kgf/cm2, and comes back elastically: that takes 1800 of the 2400 kgf/cm2 of difference away, on
  // any mesh. Springs that load it over some ten crossings, on a mesh fine enough for that, leave the difference alone.
  const SymTensor<double> s = plateau_stress(mesh("0.0625 cm", "1.6e-8 s") + "obstacles.stop.stiffness=4e5 kgf/cm");
  CHECK(holds("plateau, Tresca, smooth front", s.yy, plateau / kgf_cm2, 0.05, "kgf/cm2"));
  CHECK(holds("plateau, Tresca, smooth front: lateral stress x less by", s.yy - s.xx, yield_stress / kgf_cm2, 0.05,
              "kgf/cm2"));
  CHECK(holds("plateau, Tresca, smooth front: lateral stress z less by", s.yy - s.zz, yield_stress / kgf_cm2, 0.05,
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
  const std::vector<std::pair<std::string, Accelerations>> runs{{"1 cm", accelerations(coarse)},
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
  const auto [smallest, largest] =
      std::minmax({runs[0].second.centre_of_mass, runs[1].second.centre_of_mass, runs[2].second.centre_of_mass});
  CHECK(largest <= 1.1 * smallest);
}

// --- free flight

void fly(const std::string& name, const Changes& changes, double energy_bound) {
  Run run(load_case(case_folder + "flight.toml", changes));
  const double gravity = run.model.run.gravity.y;
  double separation = -1;
  double plastic_at_separation = 0;
  double plastic_at_half = 0;
  double last_plastic = 0;
  double last_flow = 0;
  bool work_without_flow = false;
  Vec2 place, speed;
  double off_parabola = 0;
  bool touched = false;
  run.run([&](const Run& now) {
    const double plastic = now.state.ledger.plastic_work.value();
    if (now.state.obstacles.front().touching > 0) {
      touched = true;
      separation = -1;
    } else if (touched && separation < 0) {
      separation = last_flow = now.time();
      plastic_at_separation = plastic;
      place = centre_of_mass(now);
      speed = mean_velocity(now);
      off_parabola = 0;
    } else if (touched) {
      if (plastic != last_plastic) {
        last_flow = now.time();
        work_without_flow |= std::ranges::none_of(now.state.flowing, [](std::uint8_t byte) { return byte != 0; });
      }
      if (now.state.clock.step % 100 == 0) {
        const double t = now.time() - separation;
        const Vec2 path = t * speed + Vec2{0, 0.5 * gravity * t * t};
        off_parabola = std::max(off_parabola, length(centre_of_mass(now) - place - path));
      }
    }
    last_plastic = plastic;
    if (now.time() <= 0.5 * now.model.run.end_time) plastic_at_half = plastic;
  });
  REQUIRE(separation > 0);
  const Ledger& ledger = run.state.ledger;
  const double flown = length(centre_of_mass(run) - place);
  const double growth = (last_plastic - plastic_at_separation) / ledger.start_energy;
  const double late_growth = (last_plastic - plastic_at_half) / ledger.start_energy;
  tell(name, fmt::format("{:.4g} | {:.4g} | {:.4f} % | {:.4f} % | {:.4f} % | {:.0e} | {:.0e}", 1e3 * separation,
                         1e3 * last_flow, 100 * growth, 100 * late_growth, 100 * ledger.energy_error(),
                         momentum_error(run), off_parabola / flown));
  CHECK_FALSE(work_without_flow);
  // At separation about 1 % of the energy is left in the ringing beam, and some of its elements stay at the yield
  // surface. So flow does not end at once; it must take no more than half of that 1 %, and fade.
  CHECK(growth >= 0);
  CHECK(growth <= 0.005);
  CHECK(late_growth <= 0.0001);
  CHECK(ledger.energy_error() <= energy_bound);
  CHECK(momentum_error(run) <= 1e-12);
  CHECK(off_parabola <= 1e-9 * flown);
}

TEST_CASE("free flight of the coarse beam") {
  fly("coarse, Tresca, 20 ms", coarse, plastic_books);
  fly("coarse, elastic, 20 ms", coarse + elastic, elastic_books);
}

TEST_CASE("free flight of the medium beam, Tresca (long)") { fly("medium, Tresca, 20 ms", {}, plastic_books); }

TEST_CASE("free flight of the medium beam, elastic (long)") { fly("medium, elastic, 20 ms", {elastic}, elastic_books); }

}  // namespace
}  // namespace udar::verification

// beam-vibration: frequencies of a free beam, against Timoshenko's theory. See README.md.

#include <fmt/core.h>

#include <numbers>

#include "tools.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

constexpr double density = 7850;
constexpr double poisson = 0.3;
constexpr double modulus = 200e9 / (1 - poisson * poisson);  // Pa, E' of plane strain
constexpr double shear = 200e9 / (2 * (1 + poisson));        // Pa
constexpr double beam_length = 1;
constexpr double height = 0.05;
constexpr double pi = std::numbers::pi;
constexpr std::array<double, 3> hertz{269.401, 729.817, 1396.37};

/// A free mode of Timoshenko's beam about its middle: w = A ch(alpha x) + B cos(beta x) or the same with sh and sin.
struct Mode {
  bool symmetric;
  double alpha, beta, r, ratio;  ///< r = rho w^2 / (kappa G), 1/m2; ratio = B / A

  [[nodiscard]] double deflection(double x) const {
    return symmetric ? std::cosh(alpha * x) + ratio * std::cos(beta * x)
                     : std::sinh(alpha * x) + ratio * std::sin(beta * x);
  }
  /// Turn of the section: psi' = w'' + r w.
  [[nodiscard]] double turn(double x) const {
    const double a = (alpha * alpha + r) / alpha;
    const double b = (beta * beta - r) / beta;
    return symmetric ? a * std::sinh(alpha * x) - ratio * b * std::sin(beta * x)
                     : a * std::cosh(alpha * x) + ratio * b * std::cos(beta * x);
  }
};

Mode mode_at(double frequency, double kappa, bool symmetric) {
  const double w2 = std::pow(2 * pi * frequency, 2);
  const double inertia = height * height / 12;  // of the section over its area
  const double p = density * w2 / modulus;
  const double r = density * w2 / (kappa * shear);
  // w'''' + (p + r) w'' - (p / inertia - p r) w = 0
  const double half = 0.5 * (p + r);
  const double root = std::sqrt(half * half + p / inertia - p * r);
  Mode m{symmetric, std::sqrt(root - half), std::sqrt(root + half), r, 0};
  // No moment at the end: psi' = 0.
  const double x = 0.5 * beam_length;
  const double up = m.alpha * m.alpha + r;
  const double down = m.beta * m.beta - r;
  m.ratio = symmetric ? up * std::cosh(m.alpha * x) / (down * std::cos(m.beta * x))
                      : up * std::sinh(m.alpha * x) / (down * std::sin(m.beta * x));
  return m;
}

/// Frequency (Hz) near `guess` at which no shear force is left at the end either: w' = psi (Timoshenko 1921).
double timoshenko(double guess, double kappa, bool symmetric) {
  const auto force = [&](double frequency) {
    const Mode m = mode_at(frequency, kappa, symmetric);
    const double x = 0.5 * beam_length;
    // w' - psi, times what keeps it finite where cos or sin of the denominator passes 0.
    return symmetric ? -m.r / m.alpha * std::sinh(m.alpha * x) * std::cos(m.beta * x) -
                           m.r / m.beta * m.ratio * std::sin(m.beta * x) * std::cos(m.beta * x)
                     : -m.r / m.alpha * std::cosh(m.alpha * x) * std::sin(m.beta * x) +
                           m.r / m.beta * m.ratio * std::cos(m.beta * x) * std::sin(m.beta * x);
  };
  return root_between(force, 0.93 * guess, 1.07 * guess);
}

constexpr double kappa = 5.0 / 6;

struct Ringing {
  std::array<double, 3> frequency;  ///< Hz
  double momentum;
  double energy;
};

/// Frequency from the sine that fits a record best: least squares of cosine, sine and a constant at each frequency,
/// then the best frequency.
double fit_frequency(const Record& record, double guess) {
  const auto misfit = [&](double frequency) {
    std::array<std::array<double, 4>, 3> m{};
    double square = 0;
    for (std::size_t i = 0; i < record.times.size(); ++i) {
      const double phase = 2 * pi * frequency * record.times[i];
      const std::array<double, 3> f{std::cos(phase), std::sin(phase), 1};
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) m[a][b] += f[a] * f[b];
        m[a][3] += f[a] * record.values[i];
      }
      square += record.values[i] * record.values[i];
    }
    const auto right = std::array{m[0][3], m[1][3], m[2][3]};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        if (b == a) continue;
        const double factor = m[b][a] / m[a][a];
        for (std::size_t c = a; c < 4; ++c) m[b][c] -= factor * m[a][c];
      }
    }
    double explained = 0;
    for (std::size_t a = 0; a < 3; ++a) explained += right[a] * m[a][3] / m[a][a];
    return square - explained;
  };
  double low = 0.85 * guess;
  double high = 1.25 * guess;
  // A coarse scan, then thirds.
  double best = low;
  for (int i = 0; i <= 80; ++i) {
    const double f = low + i * (high - low) / 80;
    if (misfit(f) < misfit(best)) best = f;
  }
  low = best - 0.006 * guess;
  high = best + 0.006 * guess;
  for (int i = 0; i < 40; ++i) {
    const double third = (high - low) / 3;
    if (misfit(low + third) < misfit(high - third))
      high -= third;
    else
      low += third;
  }
  return 0.5 * (low + high);
}

/// Shakes a beam of so many layers and reads three frequencies: the velocities are projected on Timoshenko's modes,
/// with the masses as weights, which leaves one mode in each record.
Ringing shake(int layers) {
  Run run(
      load("beam-vibration/beam-vibration.toml", {fmt::format("bodies.beam.mesh.element_size={} m", height / layers)}));
  const Model& model = run.model;
  std::array<std::vector<Vec2>, 3> weights;
  for (std::size_t m = 0; m < 3; ++m) {
    const bool symmetric = m != 1;
    const Mode mode = mode_at(timoshenko(hertz[m], kappa, symmetric), kappa, symmetric);
    for (Index i = 0; i < model.node_count; ++i) {
      const double x = model.rest[i].x - 0.1;
      weights[m].push_back(model.mass[i] * Vec2{-mode.turn(x) * model.rest[i].y, mode.deflection(x)});
    }
  }
  std::array<Record, 3> records;
  const double every = 1.0 / (hertz[2] * 40);
  double next = 0;
  run.run([&](const Run& now) {
    if (now.time() < next) return;
    next += every;
    for (std::size_t m = 0; m < 3; ++m) {
      double sum = 0;
      for (Index i = 0; i < model.node_count; ++i) sum += dot(weights[m][i], velocity(now.state, i));
      records[m].add(now.time(), sum);
    }
  });
  Ringing out{};
  for (std::size_t m = 0; m < 3; ++m) out.frequency[m] = fit_frequency(records[m], hertz[m]);
  out.momentum = momentum_error(run);
  out.energy = run.state.ledger.energy_error();
  return out;
}

/// Linear triangles are too stiff in bending. For pure bending with curvature k, linear interpolation of the exact
/// displacement makes the energy of a square cell too large by ((lambda + 2 G) + G) k^2 h^2 / 8 - E' k^2 h^2 / 24 per
/// area; over E' k^2 H^2 / 24 that is (3 (lambda + 3 G)/E' - 1) (h/H)^2 = 3.73 (h/H)^2, and elements can only do
/// better. Half of that for the frequency.
double excess_bound(int layers) {
  const Elasticity e = elasticity_of(200e9, poisson);
  return 0.5 * (3 * (e.lambda + 3 * e.shear_modulus) / modulus - 1) / (layers * layers);
}

/// How far Timoshenko's theory itself is from plane elasticity: the shear factor is 5/6 or (5 + 5 nu')/(6 + 5 nu')
/// (Timoshenko 1922), nu' = nu/(1 - nu); the truth lies between or near.
double theory_bound(std::size_t m) {
  const double nu = poisson / (1 - poisson);
  return timoshenko(hertz[m], (5 + 5 * nu) / (6 + 5 * nu), m != 1) / timoshenko(hertz[m], kappa, m != 1) - 1;
}

void check(Checks& checks, const std::vector<int>& meshes) {
  std::array<ErrorSeries, 3> excess;
  std::vector<Ringing> results;
  for (const int layers : meshes) {
    checks.setting(fmt::format("{} layers", layers));
    results.push_back(shake(layers));
    const Ringing& r = results.back();
    for (std::size_t m = 0; m < 3; ++m) {
      const double bound = excess_bound(layers) + theory_bound(m);
      checks.within(fmt::format("frequency {}", m + 1), r.frequency[m], hertz[m], bound, "Hz");
      checks.above(fmt::format("frequency {} comes from above", m + 1), r.frequency[m], hertz[m], "Hz");
      excess[m].what = fmt::format("frequency {}, over Timoshenko's", m + 1);
      excess[m].add(height / layers, std::fabs(r.frequency[m] / hertz[m] - 1), bound);
    }
    checks.at_most("momentum", r.momentum, 1e-12);
    checks.at_most("energy error", r.energy, 1e-3);
  }
  checks.setting("");
  const std::size_t n = results.size();
  for (std::size_t m = 0; m < 3; ++m) {
    const auto f = [&](std::size_t back) { return results[n - 1 - back].frequency[m]; };
    if (n >= 3) {
      // From three meshes, whatever the limit is.
      checks.between(fmt::format("order of frequency {}, from three meshes", m + 1),
                     std::log2((f(2) - f(1)) / (f(1) - f(0))), 1.7, 2.3);
    }
    // Richardson takes the h^2 term out; the h^4 term is about the square of the excess on the finer mesh, times 4.
    const double limit = f(0) + (f(0) - f(1)) / 3;
    const double left = 4 * std::pow(excess_bound(meshes.back()), 2);
    checks.within(fmt::format("frequency {}, extrapolated", m + 1), limit, hertz[m], theory_bound(m) + left, "Hz");
    checks.series(excess[m]);
  }
}

void check_theory(Checks& checks) {
  for (std::size_t m = 0; m < 3; ++m) {
    checks.within(fmt::format("frequency {} by the root of Timoshenko's equation", m + 1),
                  timoshenko(hertz[m], kappa, m != 1), hertz[m], 3e-6, "Hz");
    checks.note(fmt::format("Frequency {} with the other shear factor: {:.3g} % more.", m + 1, 100 * theory_bound(m)));
  }
}

void check_mirror(Checks& checks) {
  // Upside down: y and v_y change their signs. Bending is antisymmetric only as long as it is infinitely small (here
  // the difference is 1e-5), but two opposite beams are mirror images at any size.
  const std::vector<std::string> coarse{"run.end_time=1 ms"};
  std::vector<std::string> opposite = coarse;
  opposite.emplace_back("bodies.beam.cosine_mode.amplitude=[\"0 m/s\", \"-10 mm/s\"]");
  Run up(load("beam-vibration/beam-vibration.toml", coarse));
  Run down(load("beam-vibration/beam-vibration.toml", opposite));
  up.run();
  down.run();
  const auto pairs = partners(up.model, 1, [](Vec2 p) { return Vec2{p.x, -p.y}; });
  checks.equal("nodes that have an image", static_cast<double>(pairs.size()), up.model.node_count);
  double difference = 0;
  double largest = 0;
  for (const auto& [i, j] : pairs) {
    const Vec2 a = velocity(up.state, i);
    const Vec2 b = velocity(down.state, j);
    difference = std::max(difference, length(a - Vec2{b.x, -b.y}));
    largest = std::max(largest, length(a));
  }
  checks.at_most("largest difference of velocity over the largest", difference / largest, 1e-10);
}

}  // namespace

Problem beam_vibration() {
  return {.topic = Topic::vibration,
          .parts = {{"Timoshenko's equation", check_theory},
                    {"2, 4 and 8 layers",
                     [](Checks& checks) {
                       check(checks, {2, 4, 8});
                     }},
                    {"the same beam seen in a mirror", check_mirror},
                    {.name = "finer meshes",
                     .check =
                         [](Checks& checks) {
                           check(checks, {4, 8, 16});
                         },
                     .is_long = true}}};
}

}  // namespace udar::verification

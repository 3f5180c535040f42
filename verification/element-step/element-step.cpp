// element-step: the largest eigenfrequency of a triangle, against the eigenvalues of its matrices. See README.md.

#include <fmt/core.h>

#include "tools.hpp"
#include "udar/base/error.hpp"
#include "udar/step/element_kernels.hpp"
#include "udar/step/stages.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

using Triangle = std::array<Vec2, 3>;
using Matrix = std::array<std::array<double, 6>, 6>;

constexpr double density = 7850;
const Elasticity steel = elasticity_of(200e9, 0.3);

struct Shape {
  const char* name;
  Triangle corners;
  double factor;  ///< stable step x c_P over the smallest height
};
const std::array<Shape, 4> shapes{{
    {"right isosceles", {{{0, 0}, {1, 0}, {0, 1}}}, 0.9065},
    {"equilateral", {{{0, 0}, {1, 0}, {0.5, std::sqrt(0.75)}}}, 0.7888},
    {"right 4:1", {{{0, 0}, {4, 0}, {0, 1}}}, 0.8312},
    {"needle 1 by 0.1", {{{0, 0}, {1, 0}, {0.5, 0.1}}}, 0.9416},
}};

double twice_area_of(const Triangle& t) { return twice_area(t[0], t[1], t[2]); }

double smallest_height(const Triangle& t) {
  const double longest = std::max({length(t[1] - t[0]), length(t[2] - t[1]), length(t[0] - t[2])});
  return twice_area_of(t) / longest;
}

double by_kernel(const Triangle& t, const Elasticity& e) {
  const Vec2 a = t[1] - t[0];
  const Vec2 b = t[2] - t[0];
  return eigenfrequency_squared(Sides<double>{a.x, a.y, b.x, b.y}, e, density * 0.5 * twice_area_of(t));
}

/// M^-1 K of the triangle with its mass in thirds, unit thickness; textbook B and D, nothing of the solver.
Matrix dynamic_matrix(const Triangle& t, const Elasticity& e) {
  const double area = 0.5 * twice_area_of(t);
  double b[3][6] = {};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 next = t[(k + 1) % 3];
    const Vec2 last = t[(k + 2) % 3];
    const double n_x = (next.y - last.y) / (2 * area);
    const double n_y = (last.x - next.x) / (2 * area);
    b[0][2 * k] = b[2][2 * k + 1] = n_x;
    b[1][2 * k + 1] = b[2][2 * k] = n_y;
  }
  const double d[3][3] = {{e.wave_modulus(), e.lambda, 0}, {e.lambda, e.wave_modulus(), 0}, {0, 0, e.shear_modulus}};
  const double corner_mass = density * area / 3;
  Matrix k{};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      for (std::size_t p = 0; p < 3; ++p) {
        for (std::size_t q = 0; q < 3; ++q) k[i][j] += area * b[p][i] * d[p][q] * b[q][j] / corner_mass;
      }
    }
  }
  return k;
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      for (std::size_t k = 0; k < 6; ++k) c[i][j] += a[i][k] * b[k][j];
    }
  }
  return c;
}

double trace(const Matrix& a) {
  double sum = 0;
  for (std::size_t i = 0; i < 6; ++i) sum += a[i][i];
  return sum;
}

/// Power iteration by repeated squaring: a^(2^60) over its trace. What is left is the projection on the modes of the
/// largest frequency, over their number; the eigenvalue is exact to rounding even where the next one is close.
struct LargestMode {
  double eigenvalue;
  Matrix projection;
};

LargestMode largest_mode(const Matrix& a) {
  Matrix power = a;
  for (int i = 0; i < 60; ++i) {
    power = product(power, power);
    const double scale = 1 / trace(power);
    for (auto& row : power) {
      for (double& value : row) value *= scale;
    }
  }
  const double eigenvalue = trace(product(a, power));
  const double modes = 1 / trace(product(power, power));
  for (auto& row : power) {
    for (double& value : row) value *= modes;
  }
  return {eigenvalue, power};
}

/// Numbers between 0 and 1 that look random and are the same everywhere.
struct Numbers {
  std::uint64_t state = 1;
  double operator()() {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state >> 11) * 0x1p-53;
  }
};

/// The case's cell with its first triangle replaced by `t` (in mm) and its second one taken out.
Model one_triangle(const Triangle& t, double speed, double safety) {
  Model model = build_model(load("element-step/element-step.toml"));
  Body& body = model.bodies[0];
  model.corners[1] = model.corners[2];  // padding
  model.quads[1] = model.quads[2];
  model.area_density[1] = model.area_density[2];
  model.element_count = 1;
  model.segments.clear();  // its boundary is not that of the cell: it cannot touch itself
  body.element_end = body.element_begin + 1;
  const double area = 0.5e-6 * twice_area_of(t);
  model.area_density[0] = density * area;
  body.mass = density * area;
  Numbers numbers;
  for (std::size_t k = 0; k < 3; ++k) {
    const Index node = model.corners[0][k];
    model.rest[node] = 1e-3 * t[k];
    model.mass[node] = body.mass / 3;
    model.inverse_mass[node] = 3 / body.mass;
    const double x = numbers();
    const double y = numbers();
    model.start_velocity[node] = speed * Vec2{x - 0.5, y - 0.5};
  }
  for (Index node = 0; node < model.node_count; ++node) {
    if (node == model.corners[0][0] || node == model.corners[0][1] || node == model.corners[0][2]) continue;
    model.start_velocity[node] = {};  // the fourth node belongs to nothing any more
  }
  model.run.time_step.reset();
  model.run.step_safety = safety;
  model.run.end_time = 1;  // far away: a last step cut short would disturb the count
  model.run.stop_at_energy_error = 1e300;
  return model;
}

/// Part of the start energy that is in the modes of the largest frequency.
double share_of_largest_mode(const Model& model, const Triangle& t) {
  const Matrix p = largest_mode(dynamic_matrix(t, steel)).projection;
  std::array<double, 6> v{};
  for (std::size_t k = 0; k < 3; ++k) {
    v[2 * k] = model.start_velocity[model.corners[0][k]].x;
    v[2 * k + 1] = model.start_velocity[model.corners[0][k]].y;
  }
  double part = 0;
  double all = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    all += v[i] * v[i];
    for (std::size_t j = 0; j < 6; ++j) part += v[i] * p[i][j] * v[j];
  }
  return part / all;
}

void check_factors(Checks& checks) {
  const double c_p = std::sqrt(steel.wave_modulus() / density);
  for (const Shape& shape : shapes) {
    const double factor = 2 / std::sqrt(by_kernel(shape.corners, steel)) * c_p / smallest_height(shape.corners);
    // The table has four digits: half a unit of the last one.
    checks.setting(shape.name);
    checks.within("h c_P / h_min", factor, shape.factor, 0.00005 / shape.factor);
  }
}

void check_formula(Checks& checks) {
  double worst = 0;
  double worst_at_zero = 0;
  Numbers numbers;
  for (int trial = 0; trial < 2000; ++trial) {
    Triangle t = trial < 4 ? shapes[static_cast<std::size_t>(trial)].corners : Triangle{};
    if (trial >= 4) {
      for (Vec2& corner : t) {
        const double x = numbers();
        corner = {x, numbers()};
      }
      if (twice_area_of(t) < 0) std::swap(t[1], t[2]);
      if (twice_area_of(t) < 1e-3) continue;
    }
    for (const double ratio : {-0.5, 0.0, 0.25, 0.3, 0.45, 0.499}) {
      const Elasticity e = elasticity_of(200e9, ratio);
      const double exact = largest_mode(dynamic_matrix(t, e)).eigenvalue;
      double& mine = ratio == 0 ? worst_at_zero : worst;
      mine = std::max(mine, std::fabs(by_kernel(t, e) / exact - 1));
    }
  }
  // Both are a few dozen roundings; flat triangles (height 1e-3 of a side) lose three digits in the 6 x 6 matrix.
  checks.setting("2000 triangles, Poisson's ratio -0.5 to 0.499");
  checks.at_most("largest relative difference", worst, 1e-11);
  // With lambda = 0 the two in-plane eigenvalues of an equilateral triangle are equal: the root of the formula is then
  // that of a difference of equal numbers and right to the square root of the rounding, 1.5e-8.
  checks.setting("the same, Poisson's ratio 0");
  checks.at_most("largest relative difference", worst_at_zero, 3e-8);
}

void check_invariance(Checks& checks) {
  double worst = 0;
  for (const Shape& shape : shapes) {
    const double w2 = by_kernel(shape.corners, steel);
    const auto compare = [&](const Triangle& t, double expected) {
      worst = std::max(worst, std::fabs(by_kernel(t, steel) / expected - 1));
    };
    for (int k = 1; k < 12; ++k) {
      Triangle t = shape.corners;
      for (Vec2& corner : t) corner = turn_by(0.5 * k) * corner + Vec2{3, -2};
      compare(t, w2);
    }
    const auto& [a, b, c] = shape.corners;
    compare({b, c, a}, w2);
    compare({Vec2{-a.x, a.y}, Vec2{-c.x, c.y}, Vec2{-b.x, b.y}}, w2);
    compare({1e-3 * a, 1e-3 * b, 1e-3 * c}, 1e6 * w2);
  }
  checks.at_most("largest relative change", worst, 1e-13);
}

void check_below(Checks& checks) {
  constexpr double safety = 0.999;
  const double c_p = std::sqrt(steel.wave_modulus() / density);
  for (const Shape& shape : shapes) {
    ModelRun run(one_triangle(shape.corners, 1e-9 * c_p, safety));
    double largest = 0;
    for (int n = 0; n < 100000; ++n) {
      run.step();
      largest = std::max(largest, run.state.ledger.half_step_kinetic);
    }
    // (1 - z^2/4) v_{n+1/2}^2 + (w (x_n + x_{n+1})/2)^2 stays as it is for central difference, z = h w. So the
    // half-step energy of a mode reaches 1/(1 - z^2/4) times that at the start and never more; z/2 = 0.999 in the
    // fastest mode. In 1e5 steps its phase comes within 1e-4 of every value; the slower modes are far below their
    // limit.
    const double bound = 1 / (1 - safety * safety);
    const double share = share_of_largest_mode(run.model, shape.corners);
    const double ratio = largest / run.state.ledger.start_kinetic;
    checks.setting(shape.name);
    checks.between("largest half-step energy over start energy", ratio, share * bound * (1 - 1e-3), bound * (1 + 1e-5));
  }
}

void check_case(Checks& checks) {
  Run run(load("element-step/element-step.toml"));
  double largest = 0;
  run.run([&](const Run& now) { largest = std::max(largest, now.state.ledger.half_step_kinetic); });
  checks.note(fmt::format("{} steps of {:.6g} s; limit {:.6g} s.", run.state.clock.step, run.state.clock.largest_step,
                          run.state.clock.limit.size));
  const double ratio = run.state.clock.largest_step / run.state.clock.limit.size;
  checks.at_most("largest half-step energy over start energy", largest / run.state.ledger.start_kinetic,
                 1 / (1 - ratio * ratio));
  checks.at_most("energy error", run.state.ledger.energy_error(), 1e-6);
}

void check_growth(Checks& checks) {
  constexpr double excess = 1.0005;
  const double c_p = std::sqrt(steel.wave_modulus() / density);
  const double g = 2 * excess * excess - 1;
  const double growth = g + std::sqrt(g * g - 1);  // of the amplitude, per step: mu^2 - (2 - z^2) mu + 1 = 0
  for (const Shape& shape : shapes) {
    // The stages of a step, with its size in the hands of the check: that of an automatic step may be a percent
    // below what it is asked for.
    const double h = 1e-3 * excess * 2 / std::sqrt(by_kernel(shape.corners, steel));
    const Model model = one_triangle(shape.corners, 1e-14 * c_p, 1);
    Workspace work(model, 1);
    State state = start(model, work);
    std::array<double, 301> energy{};
    for (int n = 0; n <= 300; ++n) {
      energy[static_cast<std::size_t>(n)] = state.ledger.half_step_kinetic;
      advance_clock(model, state);
      state.clock.next_step = h;
      sweep(model, state, work);
      close_books(model, state, work);
    }
    const double measured = std::pow(energy[300] / energy[200], 0.5 / 100);
    // After 200 steps everything else is 1e-5 of the growing mode in amplitude, 1e-10 in energy; over 100 steps that is
    // 1e-12. Strain reaches 1e-6 and moves the limit by as much: 1e-6 of z, z growth' / growth = 32: 3e-5.
    checks.setting(shape.name);
    checks.within("growth per step, less 1", measured - 1, growth - 1, 1e-3);
  }
}

void check_refused(Checks& checks) {
  Model model = one_triangle(shapes[0].corners, 1e-6, 1);
  const double limit = 2 / std::sqrt(by_kernel(shapes[0].corners, steel)) * 1e-3;
  const auto is_refused = [&](double part) {
    model.run.time_step = part * limit;
    try {
      const ModelRun run{model};
      return false;
    } catch (const UserError&) {
      return true;
    }
  };
  checks.holds("0.9999 of the limit is taken", !is_refused(0.9999));
  checks.holds("1.0001 of the limit is refused", is_refused(1.0001));
}

void check_meshes(Checks& checks) {
  const std::vector<std::pair<const char*, std::string>> meshes{
      {"right", R"({ shape = "rectangle", size = ["10 mm", "8 mm"], element_size = "1 mm", diagonals = "right" })"},
      {"alternating", R"({ shape = "rectangle", size = ["10 mm", "8 mm"], element_size = "1 mm" })"},
      {"crossed", R"({ shape = "rectangle", size = ["10 mm", "8 mm"], element_size = "1 mm", diagonals = "crossed" })"},
      {"disc", R"({ shape = "disc", radius = "6 mm", element_size = "1 mm" })"}};
  for (const auto& [name, mesh] : meshes) {
    Model model = build_model(load("element-step/element-step.toml", {"bodies.cell.mesh=" + mesh}));
    model.run.time_step.reset();
    // Power iteration without a matrix: element by element. Its Rayleigh quotient never exceeds the true eigenvalue.
    std::vector<double> v(2 * model.node_count), kv(2 * model.node_count);
    Numbers numbers;
    for (double& value : v) value = numbers() - 0.5;
    std::vector<Matrix> stiffness;
    for (Index e = 0; e < model.bodies[0].element_end; ++e) {
      const auto& c = model.corners[e];
      stiffness.push_back(dynamic_matrix({model.rest[c[0]], model.rest[c[1]], model.rest[c[2]]}, steel));
    }
    double assembled = 0;
    for (int iteration = 0; iteration < 3000; ++iteration) {
      std::fill(kv.begin(), kv.end(), 0);
      for (Index e = 0; e < model.bodies[0].element_end; ++e) {
        const auto& c = model.corners[e];
        const double third = model.area_density[e] / 3;
        for (std::size_t i = 0; i < 6; ++i) {
          double sum = 0;
          for (std::size_t j = 0; j < 6; ++j) sum += stiffness[e][i][j] * v[2 * c[j / 2] + j % 2];
          kv[2 * c[i / 2] + i % 2] += third * sum;
        }
      }
      double above = 0;
      double under = 0;
      for (std::size_t i = 0; i < v.size(); ++i) {
        above += v[i] * kv[i];
        under += v[i] * v[i] * model.mass[i / 2];
      }
      assembled = above / under;
      const double scale = 1 / (assembled * std::sqrt(under));
      for (std::size_t i = 0; i < v.size(); ++i) v[i] = scale * kv[i] * model.inverse_mass[i / 2];
    }
    double by_elements = 0;
    for (Index e = 0; e < model.bodies[0].element_end; ++e) {
      const auto& c = model.corners[e];
      by_elements = std::max(by_elements, by_kernel({model.rest[c[0]], model.rest[c[1]], model.rest[c[2]]}, steel));
    }
    ModelRun run(model);
    const double solver_limit = run.state.clock.limit.size;
    checks.setting(name);
    // Largest eigenvalue: true one of the mesh over the bound from its elements, by Rayleigh's quotient.
    checks.at_most("w^2 of the mesh over that of its elements", assembled / by_elements, 1 + 1e-12);
    checks.within("limit of the solver over that of the elements", solver_limit * std::sqrt(by_elements) / 2, 1, 1e-12);
    checks.note(fmt::format("{}: the true limit of the mesh is {:.4f} of the limit from its elements.", name,
                            std::sqrt(by_elements / assembled)));
  }
}

void check_long_runs(Checks& checks) {
  // The true limits of these meshes are at least 1.08 of those of their elements (the check before this one).
  const double bound = 1 / (1 - 0.999 * 0.999 / (1.08 * 1.08));
  for (const char* diagonals : {"right", "alternating", "crossed"}) {
    Model model =
        build_model(load("element-step/element-step.toml", {fmt::format("bodies.cell.mesh.diagonals=\"{}\"", diagonals),
                                                            "bodies.cell.mesh.size=[\"5 mm\", \"5 mm\"]"}));
    model.run.time_step.reset();
    model.run.step_safety = 0.999;
    model.run.end_time = 1;
    ModelRun run(std::move(model));
    double largest = 0;
    for (int n = 0; n < 100000; ++n) {
      run.step();
      largest = std::max(largest, run.state.ledger.half_step_kinetic);
    }
    checks.setting(diagonals);
    checks.at_most("largest half-step energy over start energy", largest / run.state.ledger.start_kinetic, bound);
  }
}

}  // namespace

Problem element_step() {
  return {
      .topic = Topic::scheme,
      .parts = {{"factors of four triangles", check_factors},
                {"the formula against the 6 x 6 problem", check_formula},
                {"turned, mirrored, scaled, renumbered", check_invariance},
                {"one triangle rings for ever below the limit", check_below},
                {"100 000 steps of a cell at 0.9995 of the limit", check_case},
                {"one triangle grows above the limit", check_growth},
                {"a fixed step above the limit is refused", check_refused},
                {"whole meshes", check_meshes},
                {.name = "100 000 steps of a mesh at 0.999 of its limit", .check = check_long_runs, .is_long = true}}};
}

}  // namespace udar::verification

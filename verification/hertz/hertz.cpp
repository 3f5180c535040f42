// hertz: an elastic cylinder pressed onto a rigid plane, against Hertz's solution. See README.md.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "tools.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double radius = 0.05;                      // m
constexpr double modulus = 200e9 / (1 - 0.3 * 0.3);  // Pa, E / (1 - nu^2)
constexpr double spring = 1.2e12;                    // N/m at each node

/// What Hertz (1882) says for the force P, N for 1 m.
struct Exact {
  explicit Exact(double force)
      : half_width(std::sqrt(4 * force * radius / (pi * modulus))), pressure(2 * force / (pi * half_width)) {}
  double half_width;  ///< m
  double pressure;    ///< Pa, the largest
  [[nodiscard]] double shear() const { return 0.3003 * pressure; }
  [[nodiscard]] double depth() const { return 0.7861 * half_width; }
};

struct Pressed {
  double force = 0;                                           ///< N, of the plane on the cylinder
  double half_width = 0;                                      ///< m, from the second moment of the contact forces
  double edge = 0;                                            ///< m, the outermost node that touches
  double pressure = 0;                                        ///< Pa, at the lowest node
  double shear = 0;                                           ///< Pa, the largest below the contact
  double depth = 0;                                           ///< m, where it is
  double penetration = 0;                                     ///< m, the largest
  double approach = 0;                                        ///< m, of the centre to the plane
  double kinetic = 0;                                         ///< over internal energy
  double lopsided = 0;                                        ///< m, first moment of the contact forces over their sum
  CheckLine pressures{.name = "computed", .x = {}, .y = {}};  ///< over the contact
  CheckLine shears{.name = "computed", .x = {}, .y = {}};     ///< below its middle
};

void measure_contact(const Run& run, Pressed& out) {
  const State& s = run.state;
  std::map<double, double> forces;  // from left to right
  double second = 0, first = 0;
  for (std::size_t c = 0; c < run.model.contact_nodes.size(); ++c) {
    const double x = s.nodes[run.model.contact_nodes[c]].x;
    const double f = s.contacts[c].normal_force.y;
    if (f <= 0) continue;
    forces[x] = f;
    out.force += f;
    first += f * x;
    second += f * x * x;
    out.edge = std::max(out.edge, std::fabs(x));
    out.penetration = std::max(out.penetration, s.contacts[c].penetration);
  }
  // Where p = p0 sqrt(1 - x^2 / b^2), the mean of x^2 is b^2 / 4.
  out.half_width = 2 * std::sqrt(second / out.force);
  out.lopsided = first / out.force;
  auto lowest = forces.begin();
  for (auto it = forces.begin(); it != forces.end(); ++it) {
    if (std::fabs(it->first) < std::fabs(lowest->first)) lowest = it;
  }
  const auto pressure_at = [](auto it) { return it->second / (0.5 * (std::next(it)->first - std::prev(it)->first)); };
  out.pressure = pressure_at(lowest);
  for (auto it = std::next(forces.begin()); std::next(it) != forces.end(); ++it) {
    out.pressures.x.push_back(it->first);
    out.pressures.y.push_back(pressure_at(it));
  }
}

/// Largest shear in the plane on the axis: means over the elements of each row, and a parabola through the largest.
void measure_shear(const Run& run, double half_width, double row, Pressed& out) {
  const State& s = run.state;
  struct Row {
    double shear = 0, depth = 0;
    int count = 0;
  };
  std::vector<Row> rows(static_cast<std::size_t>(2 * half_width / row));
  for (Index e = 0; e < run.model.element_count; ++e) {
    const Vec2 from = rest_centroid(run.model, e);
    const auto at = static_cast<std::size_t>(from.y / row);
    if (std::fabs(from.x) > row || at >= rows.size()) continue;
    double depth = 0;
    for (const Index node : run.model.corners[e]) depth += s.nodes[node].y / 3;
    rows[at].shear += std::hypot(0.5 * (s.stress_xx[e] - s.stress_yy[e]), s.stress_xy[e]);
    rows[at].depth += depth;
    ++rows[at].count;
  }
  std::size_t top = 1;
  for (Row& r : rows) {
    r.shear /= r.count;
    r.depth /= r.count;
    out.shears.x.push_back(r.depth);
    out.shears.y.push_back(r.shear);
  }
  for (std::size_t k = 1; k + 1 < rows.size(); ++k) {
    if (rows[k].shear > rows[top].shear) top = k;
  }
  const double before = rows[top - 1].shear - rows[top].shear;
  const double after = rows[top + 1].shear - rows[top].shear;
  const double way = 0.5 * (before - after) / (before + after);  // in rows
  out.depth = rows[top].depth + way * 0.5 * (rows[top + 1].depth - rows[top - 1].depth);
  out.shear = rows[top].shear - 0.25 * (before - after) * way;
}

/// `part` of the width and so its square of the force, elements of `h`.
Pressed press(double part, double h, double turn = -pi / 3) {
  Case input = load("hertz/hertz.toml");
  auto& mesh = std::get<DiscMesh>(input.bodies[0].mesh);
  mesh.finest_size = h;
  mesh.turn = turn;
  mesh.finest_within *= part;
  input.loads[0].value.y *= part * part;
  Run run(input);
  Index centre = 0;
  for (Index i = 0; i < run.model.node_count; ++i) {
    if (length(run.model.rest[i] - Vec2{0, radius}) < 1e-9) centre = i;
  }
  run.run();
  Pressed out;
  measure_contact(run, out);
  measure_shear(run, Exact(out.force).half_width, h, out);
  out.approach = -run.displacement(centre).y;
  out.kinetic = run.state.ledger.kinetic_energy / run.state.ledger.elastic_energy();
  return out;
}

/// Pressure over the width and shear below the middle, beside Hertz's.
void draw(Checks& checks, const Pressed& p, const Exact& exact) {
  const double b = exact.half_width;
  CheckLine pressure{.name = "Hertz", .exact = true, .x = {}, .y = {}};
  CheckLine shear{.name = "Hertz", .exact = true, .x = {}, .y = {}};
  for (int i = 0; i <= 200; ++i) {
    const double x = (i / 100.0 - 1) * b;
    pressure.x.push_back(x);
    pressure.y.push_back(exact.pressure * std::sqrt(std::max(0.0, 1 - x * x / (b * b))));
    // On the axis: half the difference of the principal stresses, p0 (z - z^2 / sqrt(1 + z^2)), z over b (Johnson,
    // Contact Mechanics, 1985, eq. 4.46).
    const double z = i / 100.0;
    shear.x.push_back(z * b);
    shear.y.push_back(exact.pressure * (z - z * z / std::sqrt(1 + z * z)));
  }
  checks.curve({.title = "Pressure on the plane",
                .x_label = "distance from the middle",
                .x_unit = "m",
                .y_label = "pressure",
                .y_unit = "Pa",
                .lines = {p.pressures, pressure}});
  checks.curve({.title = "Largest shear below the middle",
                .x_label = "depth",
                .x_unit = "m",
                .y_label = "shear stress",
                .y_unit = "Pa",
                .lines = {p.shears, shear}});
}

/// Elements are `coarse` times those of the case file, which are a tenth of the half-width.
void check_press(Checks& checks, double part, double coarse) {
  const double h = coarse * 0.26e-3 * part;
  const Pressed p = press(part, h);
  const Exact exact(p.force);
  const double b = exact.half_width;
  // Large strains: Hertz's are infinitely small; p0 / E' = b / 2 R.
  const double large = b / (2 * radius);
  // Springs of stiffness k on every pi / 3 h sink in by s = pi / 3 h p / k. In cos(theta) = x / b, s sqrt(1 - x^2/b^2)
  // is 8 / 3 pi of a parabola in cos(2 theta), which flattens the cylinder: R and b^2 grow by that part of s over the
  // height of the shape, b^2 / 2 R.
  const double sunk = pi / 3 * h * exact.pressure / spring / (b * b / (2 * radius));
  const double soft = 0.5 * 8 / (3 * pi) * sunk;
  // The mesh cannot follow the root at the edge: the force on the last half element, over that on the half-width, is
  // (4 / 3) sqrt(2) / (pi / 2) (h / 2 b)^1.5 = 0.42 (h / b)^1.5. b and p0 hang together by P = pi b p0 / 2.
  const double edge = 0.42 * std::pow(h / b, 1.5);
  const double bound = large + soft + edge;
  checks.within("half-width", p.half_width, b, bound, "m");
  checks.within("outermost node", p.edge, b, bound + h / b, "m");
  checks.within("peak pressure", p.pressure, exact.pressure, bound, "Pa");
  // Means over rows of triangles are right to the second order.
  checks.within("largest shear", p.shear, exact.shear(), bound + h * h / (b * b), "Pa");
  checks.within("its depth", p.depth, exact.depth(), bound + h / exact.depth(), "m");
  checks.at_most("penetration over approach", p.penetration / p.approach, 0.02);
  checks.at_most("kinetic over internal energy", p.kinetic, 0.01);
  // Symmetry: the two flanks of mesh and load mirror each other but for rounding, which contact does not make grow.
  checks.at_most("middle of the force over half-width", std::fabs(p.lopsided) / b, 1e-6);
  draw(checks, p, exact);
}

void check_seam(Checks& checks) {
  for (const double h : {0.52e-3, 0.26e-3}) {
    const Pressed p = press(1, h, -0.5 * pi);
    const Exact exact(p.force);
    checks.setting(fmt::format("elements of {:.2f} mm", 1e3 * h));
    // Its neighbours are not like it, so the error of the triangles' stress, h / b, is not taken away.
    checks.within("pressure at that node", p.pressure, exact.pressure, h / exact.half_width, "Pa");
  }
}

}  // namespace

Problem hertz() {
  const auto press = [](double part, double coarse) {
    return [part, coarse](Checks& checks) { check_press(checks, part, coarse); };
  };
  return {.topic = Topic::contact,
          .parts = {{"five elements in the half-width", press(1, 2)},
                    {"ten elements in the half-width", press(1, 1)},
                    {"the node where two sectors of the mesh meet", check_seam},
                    {.name = "twenty elements in the half-width", .check = press(1, 0.5), .is_long = true},
                    {.name = "a quarter of the width", .check = press(0.25, 1), .is_long = true}}};
}

}  // namespace udar::verification

// prandtl: a rigid flat punch pressed into a deep block, against the limit pressure of Prandtl and Hill. See README.md.

#include <doctest/doctest.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "punch.hpp"

namespace udar::verification {
namespace {

/// Bounds on the pressure over the limit: see README.md. `reach` is how far the mesh lets the flow go beyond the punch.
struct Bounds {
  double low, high, rise;
};

Bounds bounds_of(const Punch& punch, double reach) {
  const double way = punch.depth() / punch.elastic_depth(limit_pressure);
  const double sunk = geometry_gain * punch.depth() / punch.half_width();
  // What is left to the limit falls at least as from the start on: e to the depth in elastic depths.
  return {std::exp(-way) + at_rest, (1 + reach / punch.half_width()) * (1 + sunk) - 1 + at_rest,
          std::exp(-0.9 * way) + (1 + reach / punch.half_width()) * sunk / way};
}

/// Off the limit by this part of it.
double check_pressure(const std::string& name, const Pressed& p, double low, double high) {
  const double over = p.pressure / limit_pressure - 1;
  MESSAGE(fmt::format("{}: pressure {:.6g} MPa, off the limit by {:.4f}, bounds {:.4f} and {:.4f}; rise {:.4f}", name,
                      p.pressure * 1e-6, over, -low, high, p.rise));
  CHECK(over >= -low);
  CHECK(over <= high);
  CHECK(below("force of the punch less that of the bottom, over both", p.unbalanced, at_rest));
  CHECK(below("kinetic over internal energy from half the limit on", p.kinetic, 0.01));
  CHECK(below("energy error", p.energy_error, 1e-3));
  return over;
}

double check_limit(const std::string& name, const Punch& punch) {
  const Pressed p = press(punch);
  const Bounds bounds = bounds_of(punch, punch.cell);
  CHECK(below("rise over the last tenth against the elastic one", p.rise, bounds.rise));
  return check_pressure(name, p, bounds.low, bounds.high);
}

/// The punch ends `past` cells from the last node under it.
void check_ends(double past) {
  Punch punch{.cell = 2e-3, .past = past, .stiffer = 10};
  // The corner takes the boundary along, so the next node may have the punch's velocity.
  const Bounds along = bounds_of(punch, (2 - past) * punch.cell);
  check_pressure(fmt::format("{} cells past a node, with corners", past), press(punch), along.low, along.high);
  punch.corners = false;  // the last node is the end of the punch
  const Bounds nodes = bounds_of(punch, (1 - past) * punch.cell);
  check_pressure(fmt::format("{} cells past a node, nodes only", past), press(punch),
                 nodes.low + past * punch.cell / punch.half_width(), nodes.high);
}

void check_elastic(double cell) {
  // A twentieth of the strains at the limit.
  const Punch punch{.cell = cell, .stiffer = 100, .friction = 0, .elastic = true};
  const Pressed p = press(punch);
  const double depth = 0.975 * punch.depth();  // on the mean over the last twentieth of the way
  const double exact = depth / (punch.elastic_depth(1) + punch.spring_depth(1));
  const double wider = depth / (punch.elastic_depth(1, cell) + punch.spring_depth(1));
  const double over = p.pressure / exact - 1;
  const double high = wider / exact - 1 + at_rest;
  MESSAGE(
      fmt::format("cells of {} mm: elastic pressure {:.6g} MPa, exact {:.6g}, off by {:.4f}, bounds {:.4f} and {:.4f}",
                  cell * 1e3, p.pressure * 1e-6, exact * 1e-6, over, -at_rest, high));
  CHECK(over >= -at_rest);
  CHECK(over <= high);
}

}  // namespace

TEST_CASE("prandtl: limit pressure of steel, crossed cells") {
  const double coarse = check_limit("a fifth of the half-width", {.cell = 2e-3});
  const double fine = check_limit("a tenth", {.cell = 1e-3});
  CHECK(fine < coarse);
}

TEST_CASE("prandtl: a smooth punch, steel ten times as stiff, so that the punch hardly sinks") {
  check_limit("smooth punch", {.cell = 2e-3, .stiffer = 10, .friction = 0});
}

TEST_CASE("prandtl: how cells are cut") {
  using Diagonals = RectangleMesh::Diagonals;
  // Without grading, which would cut cells in other ways. Alternating cells are crossed ones turned by 45 degrees.
  Punch punch{.cell = 2e-3, .diagonals = Diagonals::alternating, .stiffer = 10, .graded = false};
  const Bounds bounds = bounds_of(punch, std::sqrt(2) * punch.cell);
  const Pressed alternating = press(punch);
  check_pressure("alternating", alternating, bounds.low, bounds.high);
  // Cells all cut one way lock: no bound from above, and the pressure goes on rising.
  punch.diagonals = Diagonals::right;
  const Pressed right = press(punch);
  check_pressure("all cut to the right", right, bounds.low, std::numeric_limits<double>::infinity());
  CHECK(right.pressure > alternating.pressure);
  CHECK(right.rise > bounds.rise);
}

TEST_CASE("prandtl: the punch ends amid two nodes") { check_ends(0.5); }

TEST_CASE("prandtl: elastic stiffness before any flow") { check_elastic(2e-3); }

TEST_CASE("prandtl: the whole block does as its half, and both halves alike") {
  const Punch half{.cell = 2e-3, .stiffer = 10};
  Punch whole = half;
  whole.both_halves = true;
  const Pressed one = press(half);
  const Pressed both = press(whole);
  const Bounds bounds = bounds_of(whole, whole.cell);
  check_pressure("whole block", both, bounds.low, bounds.high);
  // The spring in the plane of symmetry also counts the left edge of the half, so it gives way by half as much.
  const double spring = 0.5 * (0.5 * half.cell / half.half_width()) * half.spring_depth(1) / half.elastic_depth(1);
  CHECK(below("pressure of the half against the whole", std::fabs(both.pressure / one.pressure - 1), spring));
  // Rounding, which a stable motion with damping does not make grow.
  CHECK(below("mirror error of the velocities", both.mirror_error, 1e-6));
}

TEST_CASE("prandtl: a rigid body under a load comes to rest below the limit and sinks through above it") {
  const Punch punch{.cell = 2e-3, .stiffer = 10, .both_halves = true};
  const Loaded held = load_body(punch, 0.97);
  CHECK(below("held at 0.97: depth over that of the other checks", held.depth / punch.depth(), 1));
  CHECK(below("its velocity over the mean one", std::fabs(held.velocity) * punch.time() / held.depth, 0.01));
  CHECK(below("force between the bodies against the load", std::fabs(held.pressure / (0.97 * limit_pressure) - 1),
              at_rest));
  CHECK(below("tilt (rad)", std::fabs(held.tilt), 1e-9));
  // The mesh may carry more than the limit, as beside corners, but not this.
  const double most = 1 + bounds_of(punch, (2 - punch.past) * punch.cell).high;
  const Loaded sunk = load_body(punch, most);
  MESSAGE(fmt::format("loaded with {:.3f} of the limit: {:.3g} of that depth after {:.3g} ms", most,
                      sunk.depth / punch.depth(), sunk.time * 1e3));
  CHECK(sunk.depth > 2 * punch.depth());
}

TEST_CASE("prandtl: overshoot and cells (long)") {
  // The sides of a smooth punch's last node slide out from under it where cells are finer still.
  for (const auto& [friction, finest] : {std::pair{1.0, 0.25e-3}, std::pair{0.0, 0.5e-3}}) {
    std::vector<double> over;
    for (double cell = 2e-3; cell > 0.9 * finest; cell *= 0.5) {
      over.push_back(check_limit(fmt::format("cells of {} mm, friction {}", cell * 1e3, friction),
                                 {.cell = cell, .stiffer = 10, .friction = friction}));
      if (over.size() > 1) CHECK(over.back() < over[over.size() - 2]);
    }
    order_of("overshoot", over);
    for (double& part : over) part -= at_rest + geometry_gain * Punch{.stiffer = 10}.depth() / 0.01;
    order_of("less what sinking and rest may add", over);
  }
}

TEST_CASE("prandtl: steel, a twentieth of the half-width (long)") { check_limit("steel", {.cell = 0.5e-3}); }

TEST_CASE("prandtl: alternating cells (long)") {
  for (const double cell : {1e-3, 0.5e-3}) {
    const Punch punch{.cell = cell, .diagonals = RectangleMesh::Diagonals::alternating, .stiffer = 10};
    const Bounds bounds = bounds_of(punch, std::sqrt(2) * cell);
    check_pressure(fmt::format("alternating, {} mm", cell * 1e3), press(punch), bounds.low, bounds.high);
  }
}

TEST_CASE("prandtl: the punch ends beside a node (long)") {
  check_ends(0.05);
  check_ends(0.95);
}

TEST_CASE("prandtl: elastic stiffness on finer meshes (long)") {
  check_elastic(1e-3);
  check_elastic(0.5e-3);
}

TEST_CASE("prandtl: a block twice as wide and deep (long)") {
  const Punch punch{.cell = 1e-3, .stiffer = 10};
  Punch large = punch;
  large.larger = 2;
  const double over = check_limit("as it is", punch);
  const double deep = check_limit("twice as large", large);
  // The limit is that of the same flow; each is near its own by the elastic rest and what sinking adds.
  const Bounds bounds = bounds_of(large, 0);
  CHECK(below("difference", std::fabs(deep - over), bounds.low + bounds.high));
}

}  // namespace udar::verification

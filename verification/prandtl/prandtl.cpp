// prandtl: a rigid flat punch pressed into a deep block, against the limit pressure of Prandtl and Hill. See README.md.

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

/// Off the limit by this part of it. `high` may be infinite: then there is no bound from above.
double check_pressure(Checks& checks, const std::string& setting, const Pressed& p, double low, double high) {
  checks.setting(setting);
  const double ratio = p.pressure / limit_pressure;
  if (std::isinf(high)) {
    checks.at_least("pressure over the limit", ratio, 1 - low);
  } else {
    checks.between("pressure over the limit", ratio, 1 - low, 1 + high);
  }
  checks.at_most("force of the punch less that of the bottom, over both", p.unbalanced, at_rest);
  checks.at_most("kinetic over internal energy from half the limit on", p.kinetic, 0.01);
  checks.at_most("energy error", p.energy_error, 1e-3);
  return ratio - 1;
}

double check_limit(Checks& checks, const std::string& setting, const Punch& punch) {
  const Pressed p = press(punch);
  const Bounds bounds = bounds_of(punch, punch.cell);
  checks.setting(setting);
  checks.at_most("rise over the last tenth against the elastic one", p.rise, bounds.rise);
  return check_pressure(checks, setting, p, bounds.low, bounds.high);
}

/// The punch ends `past` cells from the last node under it.
void check_ends(Checks& checks, double past) {
  Punch punch{.cell = 2e-3, .past = past, .stiffer = 10};
  // The corner takes the boundary along, so the next node may have the punch's velocity.
  const Bounds along = bounds_of(punch, (2 - past) * punch.cell);
  check_pressure(checks, fmt::format("{} cells past a node, with corners", past), press(punch), along.low, along.high);
  punch.corners = false;  // the last node is the end of the punch
  const Bounds nodes = bounds_of(punch, (1 - past) * punch.cell);
  check_pressure(checks, fmt::format("{} cells past a node, nodes only", past), press(punch),
                 nodes.low + past * punch.cell / punch.half_width(), nodes.high);
}

void check_elastic(Checks& checks, double cell) {
  // A twentieth of the strains at the limit.
  const Punch punch{.cell = cell, .stiffer = 100, .friction = 0, .elastic = true};
  const Pressed p = press(punch);
  const double depth = 0.975 * punch.depth();  // on the mean over the last twentieth of the way
  const double exact = depth / (punch.elastic_depth(1) + punch.spring_depth(1));
  const double wider = depth / (punch.elastic_depth(1, cell) + punch.spring_depth(1));
  const double high = wider / exact - 1 + at_rest;
  checks.setting(fmt::format("cells of {} mm", 1e3 * cell));
  checks.between("elastic pressure over the exact one", p.pressure / exact, 1 - at_rest, 1 + high);
}

void check_steel(Checks& checks) {
  const double coarse = check_limit(checks, "cells of a fifth of the half-width", {.cell = 2e-3});
  const double fine = check_limit(checks, "cells of a tenth", {.cell = 1e-3});
  checks.setting("");
  checks.below("pressure above the limit, finer against coarser cells", fine, coarse);
}

/// Steel ten times as stiff, so that the punch hardly sinks.
void check_smooth(Checks& checks) { check_limit(checks, "", {.cell = 2e-3, .stiffer = 10, .friction = 0}); }

void check_cuts(Checks& checks) {
  using Diagonals = RectangleMesh::Diagonals;
  // Without grading, which would cut cells in other ways. Alternating cells are crossed ones turned by 45 degrees.
  Punch punch{.cell = 2e-3, .diagonals = Diagonals::alternating, .stiffer = 10, .graded = false};
  const Bounds bounds = bounds_of(punch, std::sqrt(2) * punch.cell);
  const Pressed alternating = press(punch);
  check_pressure(checks, "alternating", alternating, bounds.low, bounds.high);
  // Cells all cut one way lock: no bound from above, and the pressure goes on rising.
  punch.diagonals = Diagonals::right;
  const Pressed right = press(punch);
  check_pressure(checks, "all cut to the right", right, bounds.low, std::numeric_limits<double>::infinity());
  checks.above("pressure over that of alternating cells", right.pressure / alternating.pressure, 1);
  checks.above("rise over the last tenth against the elastic one, of cells that lock", right.rise, bounds.rise);
}

void check_whole(Checks& checks) {
  const Punch half{.cell = 2e-3, .stiffer = 10};
  Punch whole = half;
  whole.both_halves = true;
  const Pressed one = press(half);
  const Pressed both = press(whole);
  const Bounds bounds = bounds_of(whole, whole.cell);
  check_pressure(checks, "", both, bounds.low, bounds.high);
  // The spring in the plane of symmetry also counts the left edge of the half, so it gives way by half as much.
  const double spring = 0.5 * (0.5 * half.cell / half.half_width()) * half.spring_depth(1) / half.elastic_depth(1);
  checks.at_most("pressure of the half against the whole", std::fabs(both.pressure / one.pressure - 1), spring);
  // Rounding, which a stable motion with damping does not make grow.
  checks.at_most("mirror error of the velocities", both.mirror_error, 1e-6);
}

void check_loaded(Checks& checks) {
  const Punch punch{.cell = 2e-3, .stiffer = 10, .both_halves = true};
  const Loaded held = load_body(punch, 0.97);
  checks.setting("0.97 of the limit");
  checks.at_most("depth over that of the other checks", held.depth / punch.depth(), 1);
  checks.at_most("velocity over the mean one", std::fabs(held.velocity) * punch.time() / held.depth, 0.01);
  checks.at_most("force between the bodies against the load", std::fabs(held.pressure / (0.97 * limit_pressure) - 1),
                 at_rest);
  checks.at_most("tilt", std::fabs(held.tilt), 1e-9, "rad");
  // The mesh may carry more than the limit, as beside corners, but not this.
  const double most = 1 + bounds_of(punch, (2 - punch.past) * punch.cell).high;
  const Loaded sunk = load_body(punch, most);
  checks.setting(fmt::format("{:.3f} of the limit", most));
  checks.above("depth over that of the other checks: it sinks through", sunk.depth / punch.depth(), 2);
}

/// Overshoot over the cells. The sides of a smooth punch's last node slide out from under it where cells are finer
/// still.
void check_overshoot(Checks& checks, double friction, double finest) {
  ErrorSeries over{.what = "pressure above the limit", .size = "cell"};
  ErrorSeries rest{.what = "the same, less what sinking and rest may add", .size = "cell"};
  for (double cell = 2e-3; cell > 0.9 * finest; cell *= 0.5) {
    const Punch punch{.cell = cell, .stiffer = 10, .friction = friction};
    const double now = check_limit(checks, fmt::format("cells of {} mm", 1e3 * cell), punch);
    if (!over.errors.empty()) checks.below("pressure above the limit, against coarser cells", now, over.errors.back());
    over.add(cell, now, bounds_of(punch, cell).high);
    rest.add(cell, now - at_rest - geometry_gain * Punch{.stiffer = 10}.depth() / 0.01);
  }
  checks.series(over);
  checks.series(rest);
}

void check_alternating(Checks& checks) {
  for (const double cell : {1e-3, 0.5e-3}) {
    const Punch punch{.cell = cell, .diagonals = RectangleMesh::Diagonals::alternating, .stiffer = 10};
    const Bounds bounds = bounds_of(punch, std::sqrt(2) * cell);
    check_pressure(checks, fmt::format("cells of {} mm", cell * 1e3), press(punch), bounds.low, bounds.high);
  }
}

void check_larger(Checks& checks) {
  const Punch punch{.cell = 1e-3, .stiffer = 10};
  Punch large = punch;
  large.larger = 2;
  const double over = check_limit(checks, "as it is", punch);
  const double deep = check_limit(checks, "twice as large", large);
  // The limit is that of the same flow; each is near its own by the elastic rest and what sinking adds.
  const Bounds bounds = bounds_of(large, 0);
  checks.setting("");
  checks.at_most("difference over the limit", std::fabs(deep - over), bounds.low + bounds.high);
}

}  // namespace

Problem prandtl() {
  const auto long_part = [](const char* name, std::function<void(Checks&)> check) {
    return Part{.name = name, .check = std::move(check), .is_long = true};
  };
  return {
      .topic = Topic::plasticity,
      .parts = {
          {"limit pressure of steel, crossed cells", check_steel},
          {"a smooth punch, stiff steel", check_smooth},
          {"how cells are cut", check_cuts},
          {"the punch ends amid two nodes", [](Checks& checks) { check_ends(checks, 0.5); }},
          {"elastic stiffness before any flow", [](Checks& checks) { check_elastic(checks, 2e-3); }},
          {"the whole block does as its half", check_whole},
          {"a rigid body under a load rests below the limit and sinks through above it", check_loaded},
          long_part("overshoot and cells, rough punch", [](Checks& checks) { check_overshoot(checks, 1, 0.25e-3); }),
          long_part("overshoot and cells, smooth punch", [](Checks& checks) { check_overshoot(checks, 0, 0.5e-3); }),
          long_part("steel, a twentieth of the half-width",
                    [](Checks& checks) { check_limit(checks, "", {.cell = 0.5e-3}); }),
          long_part("alternating cells", check_alternating),
          long_part("the punch ends beside a node",
                    [](Checks& checks) {
                      check_ends(checks, 0.05);
                      check_ends(checks, 0.95);
                    }),
          long_part("elastic stiffness on finer meshes",
                    [](Checks& checks) {
                      check_elastic(checks, 1e-3);
                      check_elastic(checks, 0.5e-3);
                    }),
          long_part("a block twice as wide and deep", check_larger),
      }};
}

}  // namespace udar::verification

// The shipped cases of bodies that strike each other: what must come out whatever the mesh. See README.md of each case.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "indentation.hpp"
#include "udar/base/box.hpp"
#include "udar/simulation/simulation.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

Case shipped(const std::string& name) { return load("cases/" + name + "/" + name + ".toml"); }

Box box_of(const Run& run, std::size_t body) {
  Box box;
  for (Index i = run.model.bodies[body].node_begin; i < run.model.bodies[body].node_end; ++i) {
    box.include({run.state.nodes[i].x, run.state.nodes[i].y});
  }
  return box;
}

double total_spin(const Run& run) {
  double spin = 0;
  for (const double s : run.state.body_spin) spin += s;
  return spin;
}

void check_two_plates(Checks& checks) {
  Run run(shipped("two-plates"));
  const Vec2 momentum = run.state.body_momentum[0] + run.state.body_momentum[1];
  const double spin = total_spin(run);
  const double arm = 0.05;  // m, of the flying plate about the origin
  double last = 0;
  run.run([&](const Run& now) {
    if (!now.state.touches.empty()) last = now.time();
  });
  const Vec2 after = run.state.body_momentum[0] + run.state.body_momentum[1];
  checks.at_most("momentum", length(after - momentum) / length(momentum), 1e-12);
  checks.at_most("spin", std::fabs(total_spin(run) - spin) / (arm * length(momentum)), 1e-12);
  checks.at_most("energy error", run.state.ledger.energy_error(), 2e-3);
  checks.at_most("penetration over element", run.state.largest_penetration, 0.05);
  checks.above("heat of friction", run.state.ledger.friction_work.value(), 0, "J");
  checks.above("plastic work", run.state.ledger.plastic_work.value(), 0, "J");
  checks.below("last touch", last, 0.9 * run.model.run.end_time, "s");
}

void check_ring(Checks& checks) {
  Run run(shipped("ring-crush"));
  constexpr double wall = 0.003;  // m
  bool itself = false;
  double thinnest = 1;
  run.run([&](const Run& now) {
    const ContactBook* const ring = book_of_pair(now.state, 0, 0);
    itself = itself || (ring != nullptr && ring->touching > 0);
    thinnest = std::min(thinnest, box_of(now, 0).size().y);
  });
  checks.holds("the ring touches itself", itself);
  // Two walls on each other: plastic flow keeps the area, so they can hardly get thinner, unless they pass through.
  checks.above("least height of the ring, two walls", thinnest, 1.9 * wall, "m");
  checks.below("least height of the ring, flat", thinnest, 3 * wall, "m");
  checks.at_most("energy error", run.state.ledger.energy_error(), 2e-3);
  checks.at_most("penetration over element", run.state.largest_penetration, 0.05);
}

void check_stack(Checks& checks) {
  Run run(shipped("stack"));
  const double start = run.state.ledger.start_kinetic;
  double worst = 0;
  run.run([&](const Run& now) {
    if (now.time() > 0.15) worst = std::max(worst, std::fabs(now.state.ledger.kinetic_energy));
  });
  checks.at_most("kinetic energy at rest over that of the start", worst / start, 1e-6);
  double weight = 0;
  for (const Body& body : run.model.bodies) weight += body.mass * 9.81;
  checks.within("force on the ground", run.state.obstacles[0].total.force.y, weight, 1e-6, "N");
  // The heap stands: every block is where its row is, within a spring's give, and has not left its place by a
  // centimetre.
  double off_row = 0;
  double off_place = 0;
  for (std::size_t b = 0; b < run.model.bodies.size(); ++b) {
    Box rest;
    for (Index i = run.model.bodies[b].node_begin; i < run.model.bodies[b].node_end; ++i)
      rest.include(run.model.rest[i]);
    const double row = std::round((rest.low.y - 0.0005) / 0.0205);
    off_row = std::max(off_row, std::fabs(box_of(run, b).low.y - 0.02 * row));
    off_place = std::max(off_place, std::fabs(box_of(run, b).low.x - rest.low.x));
  }
  checks.below("blocks off their rows", off_row, 1e-4, "m");
  checks.below("blocks off their places along the ground", off_place, 0.01, "m");
  checks.at_most("energy error", run.state.ledger.energy_error(), 2e-3);
}

void check_hammer(Checks& checks) {
  const Case input = shipped("hammer");
  Run run(input);
  const RigidBody hammer = run.model.rigid_bodies[0];
  const Vec2 start = run.state.body_momentum[0];
  const Vec2 both = start + run.state.body_momentum[1];
  // The edge that strikes first, from the centre of mass, and its velocity.
  Index edge = run.model.bodies[0].node_begin;
  for (Index i = edge; i < run.model.bodies[0].node_end; ++i) {
    if (run.model.rest[i].y < run.model.rest[edge].y) edge = i;
  }
  const Vec2 arm = run.model.rest[edge] - hammer.centre;
  const Vec2 velocity = hammer.start_velocity + hammer.start_spin * perpendicular(arm);

  double first = -1;  // s, first touch, and deepest place of the edge
  double deepest_time = 0;
  double depth = 0;
  bool first_blow = true;
  double first_impulse = 0;
  double worst_friction = 0;
  double last = 0;
  run.run([&](const Run& now) {
    const ContactBook* const book = book_of_pair(now.state, 0, 1);
    if (book == nullptr) return;
    if (first < 0) first = now.time();
    if (book->touching > 0) last = now.time();
    if (first_blow && book->touching == 0 && now.time() > first + 100e-6) first_blow = false;
    if (first_blow) {
      first_impulse = book->normal.impulse().y;
      const double below_face = -now.state.nodes[edge].y;
      if (below_face > depth) {
        depth = below_face;
        deepest_time = now.time() - first;
      }
    }
    for (const BodyTouch& t : now.state.touches) {
      const double most = 0.2 * length(t.springs.normal_force);
      worst_friction = std::max(worst_friction, length(t.springs.friction_force) / most);
    }
  });

  const Vec2 impulse = book_of_pair(run.state, 0, 1)->total.impulse();
  const Vec2 gained = run.state.body_momentum[0] - start;
  checks.at_most("momentum of the hammer less impulse", length(gained - impulse) / length(start), 1e-12);
  const Vec2 of_floor = run.state.obstacles[0].total.impulse();
  const Vec2 all = run.state.body_momentum[0] + run.state.body_momentum[1] - both;
  checks.at_most("momentum of both less impulse of the floor", length(all - of_floor) / length(start), 1e-12);
  checks.at_most("friction over Coulomb's limit", worst_friction, 1 + 1e-12);
  checks.holds("they part", run.state.touches.empty());
  checks.below("last touch", last, 0.9 * run.model.run.end_time, "s");

  // Impact of a rigid body at a point (Routh 1905): the normal impulse lies between that without friction and without
  // rebound and twice that of an edge which may not slip.
  const double nn = 1 / hammer.mass + arm.x * arm.x / hammer.inertia;
  const double tt = 1 / hammer.mass + arm.y * arm.y / hammer.inertia;
  const double nt = -arm.x * arm.y / hammer.inertia;
  const double stuck = nn - nt * nt / tt;
  checks.above("normal impulse of the first blow, without friction and rebound", first_impulse, -velocity.y / nn,
               "N s");
  checks.below("normal impulse of the first blow, twice that of an edge that sticks", first_impulse,
               -2 * velocity.y / stuck, "N s");

  // An oscillator: the mass that the edge feels with sliding friction on the spring of plastic indentation by the face,
  // which lies 10 degrees from the anvil, and by the side.
  const Tresca& steel = std::get<Tresca>(input.materials[1].law);
  const double load = indentation(80 * degree).load() + indentation(10 * degree).load();
  const double spring = load * steel.yield_stress * input.bodies[1].thickness;
  const double omega = std::sqrt(spring * (nn + 0.2 * nt));
  checks.within("time to the deepest place", deepest_time, 0.5 * std::numbers::pi / omega, 0.25, "s");
  checks.within("depth", depth, -velocity.y / omega, 0.25, "m");

  const Ledger& ledger = run.state.ledger;
  checks.note(fmt::format("Parts of the energy: plastic {:.3g}, friction {:.3g}, kinetic {:.3g}.",
                          ledger.plastic_work.value() / ledger.start_kinetic,
                          ledger.friction_work.value() / ledger.start_kinetic,
                          ledger.kinetic_energy / ledger.start_kinetic));
  checks.at_most("energy error", ledger.energy_error(), 1e-3);
  checks.at_most("penetration over element", run.state.largest_penetration, 0.05);
}

constexpr double cell = 0.5e-3;  // m, of the mesh at the notch

/// Runs the wedge and checks depth, time and rebound. The nodes of the block on the wedge when it is deepest.
std::vector<Index> cut_in_and_leave(Checks& checks, Run& run, const Case& input) {
  const Tresca& soft = std::get<Tresca>(input.materials[1].law);
  const double thickness = input.bodies[0].thickness;
  const double speed = length(input.bodies[1].velocity);
  const double reduced = 1 / (1 / run.model.bodies[0].mass + 1 / run.model.bodies[1].mass);
  const double energy = 0.5 * reduced * speed * speed;
  const auto centre = [&](std::size_t body) {
    return (1 / run.model.bodies[body].mass) * run.state.body_sums[body].position;
  };
  const double level = centre(0).y;
  double first = -1;
  double depth = 0;
  double deepest_time = 0;
  double last = 0;
  std::vector<Index> pressed;
  run.run([&](const Run& now) {
    if (now.state.touches.empty()) return;
    if (first < 0) first = now.time();
    last = now.time();
    const double here = centre(0).y - level - box_of(now, 1).low.y;
    if (here <= depth) return;
    depth = here;
    deepest_time = now.time() - first;
    pressed.clear();
    for (const BodyTouch& t : now.state.touches) {
      const Index node = now.model.contact_nodes[t.point];
      if (node < now.model.bodies[0].node_end) pressed.push_back(node);
    }
  });

  const Indentation face = indentation(45 * degree);
  const double spring = 2 * face.load() * soft.yield_stress * thickness;
  const double expected = std::sqrt(2 * energy / spring);
  // Elastic energy under the wedge, all of which might come back: a load on a slab (Johnson, Contact Mechanics, 1985,
  // eq. 5.57).
  const double force = spring * expected;
  const double modulus = soft.young_modulus / (1 - soft.poisson_ratio * soft.poisson_ratio);
  const double give =
      force / (std::numbers::pi * modulus * thickness) *
      (2 * std::log(2 * 0.04 / (face.width * expected)) - soft.poisson_ratio / (1 - soft.poisson_ratio));
  const double elastic = 0.5 * force * give / energy;
  // One cell for the tip, the inertia of what flows, what is elastic.
  const double inertia = 0.25 * input.materials[1].density * speed * speed / (face.pressure * soft.yield_stress);
  const double bound = cell / expected + inertia + elastic;
  checks.within("depth", depth, expected, bound, "m");
  checks.within("time to the deepest place", deepest_time, 0.5 * std::numbers::pi * std::sqrt(reduced / spring), bound,
                "s");
  const double apart =
      run.state.body_momentum[1].y / run.model.bodies[1].mass - run.state.body_momentum[0].y / run.model.bodies[0].mass;
  checks.above("velocity of parting", apart, 0, "m/s");
  checks.at_most("restitution", apart / speed, std::sqrt(elastic));
  checks.holds("they part", run.state.touches.empty());
  checks.below("last touch", last, 0.9 * run.model.run.end_time, "s");
  return pressed;
}

void check_wedge(Checks& checks) {
  Case input = shipped("wedge");
  input.run.end_time = 180e-6;  // parted; the rest is flight
  Run run(input);
  const double area = area_of(run, 0);
  const std::vector<Index> pressed = cut_in_and_leave(checks, run, input);
  // The notch: the nodes that touched the wedge when it was deepest.
  std::vector<Vec2> left, right;
  for (const Index node : pressed) {
    const Vec2 p = place(run.state, node);
    if (run.model.rest[node].x <= 0) left.push_back(p);
    if (run.model.rest[node].x >= 0) right.push_back(p);
  }
  checks.above("nodes on a face of the notch", static_cast<double>(left.size()), 1);
  if (left.size() <= 1) return;
  const double opening = 180 - (slope_of(right) - slope_of(left)) / degree;
  const double notch = area_below_corners(run, 0);
  checks.near("opening of the notch, degrees", opening, 90, 1);
  checks.note(fmt::format("{} nodes on each face; notch {:.3g} mm2.", left.size(), notch * 1e6));
  // No force is left on the block: mean stress in the plane is that of its vibrations, which hold the elastic energy.
  const Ledger& ledger = run.state.ledger;
  const Tresca& soft = std::get<Tresca>(input.materials[1].law);
  const double volume = area * input.bodies[0].thickness;
  const double bulk = soft.young_modulus / (3 * (1 - 2 * soft.poisson_ratio));
  const double rest = std::sqrt(2 * ledger.elastic_energy() / (bulk * volume)) * area;
  checks.at_most("volume lost over that of the notch", std::fabs(area_of(run, 0) - area) / notch, rest / notch);

  const auto pairs = partners(run.model, cell, [](Vec2 p) { return Vec2{-p.x, p.y}; });
  double uneven = 0;
  for (const auto& [i, j] : pairs) {
    uneven = std::max(uneven, length(place(run.state, i) - Vec2{-run.state.nodes[j].x, run.state.nodes[j].y}));
  }
  checks.note(fmt::format("{} of {} nodes have a mirror image.", pairs.size(), run.model.node_count));
  const double rounding = 2.2e-16 * static_cast<double>(run.state.clock.step) * 0.04;
  checks.at_most("places off the mirror", uneven, rounding, "m");
  checks.at_most("energy error", ledger.energy_error(), 1e-3);
  checks.at_most("penetration over element", run.state.largest_penetration, 0.05);
}

void check_wedge_between(Checks& checks) {
  Case input = shipped("wedge");
  input.run.end_time = 180e-6;
  std::get<RectangleMesh>(input.bodies[1].mesh).at.x += 0.5 * cell;
  Run run(input);
  cut_in_and_leave(checks, run, input);
  checks.at_most("energy error", run.state.ledger.energy_error(), 1e-3);
  checks.at_most("penetration over element", run.state.largest_penetration, 0.05);
}

/// The two plates at another speed, the flying one meshed `ratio` times as fine as the resting one.
Case plates(bool elastic, double speed, int ratio) {
  Case c = shipped("two-plates");
  if (elastic) {
    const Tresca steel = std::get<Tresca>(c.materials[0].law);
    c.materials[0].law = Elastic{steel.young_modulus, steel.poisson_ratio};
  }
  BodyCase& flying = c.bodies[1];
  flying.velocity = {0.6 * speed, -0.8 * speed};
  std::get<RectangleMesh>(flying.mesh).element_size = 0.002 / ratio;
  // They meet after a fifth of a millimetre; then a while with both in touch.
  std::get<RectangleMesh>(flying.mesh).at = {-0.05, 0.0002};
  c.run.end_time = 0.0003 / (0.8 * speed) + 0.3e-3;
  return c;
}

/// Any speed from 1 to 500 m/s, any ratio of meshes from 1 to 8.
void check_speeds(Checks& checks, bool elastic) {
  for (const double speed : {1.0, 10.0, 50.0, 100.0, 150.0, 250.0, 350.0, 500.0}) {
    for (const int ratio : {1, 2, 4, 8}) {
      Simulation simulation(plates(elastic, speed, ratio));
      const Summary s = simulation.run({.threads = 1});
      checks.setting(fmt::format("{} m/s, 1:{}", speed, ratio));
      checks.equal("pairs that meet", static_cast<double>(s.contacts.count("resting/flying")), 1);
      checks.at_most("momentum", s.momentum_error, 1e-12);
      // Elastic pairs finish at every speed, plastic ones up to 150 m/s; above they may crush an element and say so.
      // Their books close, but where flush plates of four elements strike node on node: a touch costs up to
      // k h^2/(4 m), a tenth or so, of a node's energy, and there a fifth of all nodes touch at once.
      if (elastic || speed <= 150) checks.holds("it goes to its end", s.stop_reason == "end_time");
      if (!elastic && speed <= 150) {
        checks.holds("verdict good, or flush plates with an energy error below 0.5 %",
                     s.verdict == "good" || (ratio == 1 && s.energy_error < 0.005));
      }
      if (s.stop_reason == "numerical") {
        checks.holds("a stop names its element", s.reasons.front().find("element") != std::string::npos);
      }
      // Nobody has come out on the other side: the flying plate is pushed back, the resting one away.
      checks.below("momentum of the resting plate upwards", simulation.state().body_momentum[0].y, 0, "N s");
    }
  }
}

void check_slap(Checks& checks) {
  const auto slap = [](double safety) {
    Case input = plates(false, 100, 1);
    input.run.step_safety = safety;
    Simulation simulation(input);
    return simulation.run({.threads = 1});
  };
  const Summary whole = slap(0.9);
  const Summary half = slap(0.45);
  // Four times less; touches fall here and there within a step, so something less is asked for.
  checks.at_most("energy error with half the step", half.energy_error, whole.energy_error / 2.5);
  checks.holds("verdict good with half the step", half.verdict == "good");
}

}  // namespace

Problem shipped_cases() {
  return {.topic = Topic::cases,
          .parts = {
              {"two-plates", check_two_plates},
              {"ring-crush", check_ring},
              {"stack", check_stack},
              {"hammer", check_hammer},
              {"wedge", check_wedge},
              {"wedge, its edge between two nodes", check_wedge_between},
              {.name = "two-plates, elastic, any speed, any ratio of meshes",
               .check = [](Checks& checks) { check_speeds(checks, true); },
               .is_long = true},
              {.name = "two-plates, plastic, any speed, any ratio of meshes",
               .check = [](Checks& checks) { check_speeds(checks, false); },
               .is_long = true},
              {.name = "two-plates, half the step", .check = check_slap, .is_long = true},
          }};
}

}  // namespace udar::verification

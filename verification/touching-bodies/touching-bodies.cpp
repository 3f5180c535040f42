// touching-bodies: momentum, spin and energy wherever bodies touch each other or themselves. See README.md.

#include <fmt/core.h>

#include <cmath>

#include "tools.hpp"
#include "udar/step/motion.hpp"
#include "udar/verification/problem.hpp"

namespace udar::verification {
namespace {

Case shipped(const std::string& name) { return load("cases/" + name + "/" + name + ".toml"); }

/// Momentum and spin of all nodes, with the velocity of the coming step, from the nodes themselves.
struct Totals {
  CompensatedSum x, y, spin;
  double size = 0;       ///< kg m/s, sum of m |v|
  double spin_size = 0;  ///< kg m2/s, sum of m |x| |v|
};

Totals totals(const Run& run) {
  Totals t;
  for (Index i = 0; i < run.model.node_count; ++i) {
    const NodeRecord& r = run.state.nodes[i];
    const Vec2 p = run.model.mass[i] * Vec2{r.vx, r.vy};
    t.x.add(p.x);
    t.y.add(p.y);
    t.spin.add(cross({r.x, r.y}, p));
    t.size += length(p);
    t.spin_size += length({r.x, r.y}) * length(p);
  }
  return t;
}

/// What obstacles and gravity give from the middle of one step to the middle of the next, added up.
struct Impulses {
  CompensatedSum x, y, moment;

  void add(double span, Vec2 place, Vec2 force) {
    x.add(span * force.x);
    y.add(span * force.y);
    moment.add(span * cross(place, force));
  }
};

void add_obstacles_and_weight(const Run& run, Impulses& all) {
  const double span = velocity_span(run.state.clock);
  const std::size_t points = run.model.contact_nodes.size();
  for (std::size_t c = 0; c < run.state.contacts.size(); ++c) {
    const SpringState& s = run.state.contacts[c];
    if (s.touches == 0) continue;
    all.add(span, place(run.state, run.model.contact_nodes[c % points]),
            s.normal_force + s.friction_force + s.damping_force);
  }
  const Vec2 gravity = run.model.run.gravity;
  if (gravity == Vec2{}) return;
  for (Index i = 0; i < run.model.node_count; ++i) {
    all.add(span, place(run.state, i), run.model.mass[i] * gravity);
  }
}

/// How much energy touches win or lose because they begin, end and pass corners between two steps, J. In the step in
/// which a touch begins the point moves by g + d along the normal, d of it inside: the spring then holds k d^2 / 2, the
/// kinetic energy has fallen by k d (g + d) / 2. The same where it ends. In a corner the force k d turns within a step
/// by n1 - n0: half of what it does on the way of the step may be wrong.
class TouchCosts {
 public:
  explicit TouchCosts(const Run& run) { note(run); }

  void step(const Run& run) {
    const std::vector<BodyTouch>& now = run.state.touches;
    std::size_t old = 0;
    const auto key = [](const BodyTouch& t) { return std::pair{t.point, t.body}; };
    for (const BodyTouch& touch : now) {
      for (; old < touches_.size() && key(touches_[old]) < key(touch); ++old) ends(run, touches_[old]);
      if (old < touches_.size() && key(touches_[old]) == key(touch)) {
        passes(run, touches_[old++], touch);
      } else {
        meets(run, touch);
      }
    }
    for (; old < touches_.size(); ++old) ends(run, touches_[old]);
    for (std::size_t s = 0; s < springs_.size(); ++s) obstacle(run, s);
    most_ = std::max(most_, now.size());
    for (const BodyTouch& t : now) itself_ = itself_ || run.model.contact_bodies[t.point] == t.body;
    note(run);
  }

  [[nodiscard]] double sum() const { return sum_; }
  [[nodiscard]] std::size_t begun() const { return begun_; }
  [[nodiscard]] std::size_t most() const { return most_; }
  [[nodiscard]] bool itself() const { return itself_; }

 private:
  void note(const Run& run) {
    touches_ = run.state.touches;
    springs_ = run.state.contacts;
    places_.clear();
    for (const Index node : run.model.contact_nodes) places_.push_back(place(run.state, node));
  }
  /// Motion of the point relative to the boundary in the step, m.
  [[nodiscard]] Vec2 moved(const Run& run, const BodyTouch& touch) const {
    const auto of = [&](std::uint32_t point) {
      return place(run.state, run.model.contact_nodes[point]) - places_[point];
    };
    Vec2 move = of(touch.point);
    for (const TouchShare& share : shares_of(run.model.segments, touch.segment, touch.along)) {
      move -= share.weight * of(share.point);
    }
    return move;
  }
  void outside(const Run& run, const BodyTouch& touch) {
    const double depth = touch.springs.penetration;
    const double gap = std::max(0.0, std::fabs(dot(moved(run, touch), touch.springs.normal)) - depth);
    sum_ += 0.5 * touch.stiffness * depth * gap;
  }
  void meets(const Run& run, const BodyTouch& touch) {
    ++begun_;
    outside(run, touch);
  }
  void ends(const Run& run, const BodyTouch& touch) { outside(run, touch); }
  void passes(const Run& run, const BodyTouch& before, const BodyTouch& now) {
    const double turned = length(now.springs.normal - before.springs.normal) * length(moved(run, now));
    // Slip is taken along the tangent at the end of the step; friction at its beginning acted along that of before.
    sum_ += 0.5 * length(before.springs.friction_force) * turned;
    if (before.segment == now.segment && before.along > 0 && before.along < 1 && now.along > 0 && now.along < 1) return;
    const double depth = std::max(before.springs.penetration, now.springs.penetration);
    sum_ += 0.5 * now.stiffness * depth * turned;
  }
  /// The same of a node and an obstacle.
  void obstacle(const Run& run, std::size_t number) {
    const SpringState& before = springs_[number];
    const SpringState& now = run.state.contacts[number];
    if (before.touches == 0 && now.touches == 0) return;
    const std::size_t points = run.model.contact_nodes.size();
    const std::size_t point = number % points;
    const Obstacle& obstacle = run.model.obstacles[number / points];
    const double stiffness = obstacle.normal_stiffness[point];
    const Vec2 move = place(run.state, run.model.contact_nodes[point]) - places_[point] -
                      run.state.clock.last_step * obstacle.velocity;
    const double depth = std::max(before.penetration, now.penetration);
    if (before.touches == 0 || now.touches == 0) {
      const SpringState& in = before.touches != 0 ? before : now;
      sum_ += 0.5 * stiffness * depth * std::max(0.0, std::fabs(dot(move, in.normal)) - depth);
    } else if (before.face != now.face) {
      sum_ += 0.5 * stiffness * depth * length(now.normal - before.normal) * length(move);
    }
  }

  std::vector<BodyTouch> touches_;
  std::vector<SpringState> springs_;
  std::vector<Vec2> places_;
  double sum_ = 0;
  std::size_t begun_ = 0;
  std::size_t most_ = 0;
  bool itself_ = false;
};

struct Audit {
  bool itself = false;  ///< did a body touch itself?
  double heat = 0;      ///< J, of friction
};

Audit audit(Checks& checks, const std::string& name, const Case& input) {
  Run run(input);
  const Totals start = totals(run);
  const Ledger& ledger = run.state.ledger;
  Impulses impulses;
  TouchCosts costs(run);
  double momentum = 0;  // largest drift in any step, over the sum of m |v| at the start
  double spin = 0;      // the same over the sum of m |x| |v|
  while (!run.done()) {
    run.step();
    add_obstacles_and_weight(run, impulses);
    const Totals now = totals(run);
    const Vec2 off{now.x.value() - start.x.value() - impulses.x.value(),
                   now.y.value() - start.y.value() - impulses.y.value()};
    momentum = std::max(momentum, length(off) / start.size);
    const double turned = now.spin.value() - start.spin.value() - impulses.moment.value();
    spin = std::max(spin, std::fabs(turned) / start.spin_size);
    costs.step(run);
  }
  checks.setting(name);
  checks.above("touches at once", static_cast<double>(costs.most()), 0);
  checks.at_most("momentum", momentum, 1e-12);
  checks.at_most("spin", spin, 1e-12);
  checks.at_most("identity of work", ledger.identity_error(), 1e-9);
  checks.at_most("energy error, against what touches can cost", ledger.energy_error(),
                 costs.sum() / ledger.energy_scale());
  return {costs.itself(), ledger.friction_work.value()};
}

const Elastic elastic{.young_modulus = 200e9, .poisson_ratio = 0.3};
const Tresca plastic{.young_modulus = 200e9, .poisson_ratio = 0.3, .yield_stress = 400e6};

BodyCase body(const char* name, const MeshShape& mesh, Vec2 velocity, const char* material = "steel") {
  return {.name = name, .material = material, .thickness = 0.01, .velocity = velocity, .mesh = mesh};
}

Case made_of(const Law& law, double friction, double end_time, std::vector<BodyCase> bodies) {
  return {.run = {.end_time = end_time},
          .contact = {.friction = friction},
          .materials = {{.name = "steel", .density = 7850, .law = law}},
          .bodies = std::move(bodies)};
}

/// A block flies at an angle onto the edge of another one. `fine`: how many times finer the mesh of the flying one.
Case blocks(const Law& law, double friction, double fine) {
  return made_of(
      law, friction, 300e-6,
      {body("lower", RectangleMesh{.size = {0.04, 0.02}, .at = {-0.02, 0}, .element_size = 0.0025}, {0, 20}),
       body("upper",
            RectangleMesh{.size = {0.03, 0.01}, .at = {0.005, 0.0201}, .turn = 0.2, .element_size = 0.0025 / fine},
            {-15, -40})});
}

/// A ring between two hammers: it folds until its walls meet.
Case folding_ring(const Law& law, double friction) {
  Case c = made_of(
      law, friction, 1.6e-3,
      {body("ring", RingMesh{.outer_radius = 0.02, .inner_radius = 0.0185, .element_size = 0.00075}, {}, "soft"),
       body("upper", RectangleMesh{.size = {0.06, 0.01}, .at = {-0.03, 0.0205}, .element_size = 0.005}, {2, -40}),
       body("lower", RectangleMesh{.size = {0.05, 0.01}, .at = {-0.03, -0.0305}, .element_size = 0.0025}, {0, 40})});
  c.materials.push_back({.name = "soft",
                         .density = 7850,
                         .law = Tresca{.young_modulus = 20e9, .poisson_ratio = 0.3, .yield_stress = 60e6}});
  return c;
}

/// Seven discs of two sizes fly into each other, one of them turning.
Case discs(double friction, double damping) {
  std::vector<BodyCase> all{body("middle", DiscMesh{.radius = 0.01, .element_size = 0.002}, {})};
  const char* names[] = {"d0", "d1", "d2", "d3", "d4", "d5"};
  for (int k = 0; k < 6; ++k) {
    const Vec2 out = turn_by(k * 1.0471975511965976 + 0.1) * Vec2{1, 0};
    const double radius = k % 2 == 0 ? 0.01 : 0.007;
    all.push_back(body(
        names[k],
        DiscMesh{.radius = radius, .at = (0.0103 + radius + 0.0005 * k) * out, .turn = 0.3 * k, .element_size = 0.002},
        -20.0 * out + 5.0 * perpendicular(out)));
  }
  all[0].spin = 500;
  Case c = made_of(elastic, friction, 400e-6, std::move(all));
  c.contact.damping = damping;
  return c;
}

/// A square flies with its corner onto the corner of another one.
Case corners(const Law& law) {
  return made_of(
      law, 0.3, 200e-6,
      {body("resting", RectangleMesh{.size = {0.02, 0.02}, .element_size = 0.002}, {}),
       body("flying", RectangleMesh{.size = {0.02, 0.02}, .at = {0.021, 0.02}, .turn = 0.7, .element_size = 0.0015},
            {-20, -60})});
}

/// A disc rattles in a ring, both free.
Case disc_in_ring() {
  return made_of(elastic, 0.2, 1e-3,
                 {body("ring", RingMesh{.outer_radius = 0.03, .inner_radius = 0.025, .element_size = 0.0025}, {}),
                  body("disc", DiscMesh{.radius = 0.02, .element_size = 0.0025}, {30, 10})});
}

/// The crushed ring with a third body for the anvil: free, all of it.
Case free_crush() {
  Case c = shipped("ring-crush");
  c.obstacles.clear();
  c.bodies.push_back(c.bodies[1]);
  c.bodies[2].name = "anvil";
  c.bodies[2].velocity = {};
  std::get<RectangleMesh>(c.bodies[2].mesh).at = {-0.04, -0.03};
  return c;
}

/// The heap without ground and weight: its blocks fly at its middle.
Case free_heap() {
  Case c = shipped("stack");
  c.obstacles.clear();
  c.run.gravity = {};
  c.run.end_time = 0.05;
  for (BodyCase& b : c.bodies) {
    const Vec2 at = std::get<RectangleMesh>(b.mesh).at;
    b.velocity = {-2 * (at.x + 0.02), -10 * (at.y - 0.04)};
  }
  return c;
}

void check_plates(Checks& checks) {
  audit(checks, "two-plates", shipped("two-plates"));
  audit(checks, "stack, free", free_heap());
}

void check_crush(Checks& checks) {
  const bool on_anvil = audit(checks, "ring-crush on its anvil", shipped("ring-crush")).itself;
  checks.holds("the ring touches itself", on_anvil);
  const bool free = audit(checks, "ring-crush, free", free_crush()).itself;
  checks.holds("the ring touches itself", free);
}

void check_heap(Checks& checks) { audit(checks, "stack on the ground", shipped("stack")); }

void check_blocks(Checks& checks) {
  for (const double fine : {1.0, 2.5, 0.4}) {
    for (const double friction : {0.0, 0.3}) {
      const std::string name = fmt::format("mu {}, mesh 1:{}", friction, fine);
      const Audit a = audit(checks, "elastic, " + name, blocks(elastic, friction, fine));
      checks.holds("heat where there is friction, and only there", (a.heat > 0) == (friction > 0));
      audit(checks, "plastic, " + name, blocks(plastic, friction, fine));
    }
  }
  Case input = blocks(elastic, 0, 1);
  input.contact_pairs = {{.body = "upper", .other = "lower", .friction = 0.5, .stiffness = 5e8}};
  audit(checks, "elastic, a pair with mu 0.5 and 500 MN/m", input);
}

void check_shapes(Checks& checks) {
  audit(checks, "elastic corner on corner", corners(elastic));
  audit(checks, "plastic corner on corner", corners(plastic));
  audit(checks, "seven discs, smooth", discs(0, 0));
  audit(checks, "seven discs, rough", discs(0.4, 0));
  audit(checks, "seven discs, rough, damped contact", discs(0.4, 0.3));
  audit(checks, "disc in ring", disc_in_ring());
}

void check_folding(Checks& checks, const char* name, double friction) {
  checks.holds("the ring touches itself", audit(checks, name, folding_ring(plastic, friction)).itself);
}

}  // namespace

Problem touching_bodies() {
  return {.topic = Topic::conservation,
          .parts = {
              {"two plates, and a heap that flies together", check_plates},
              {"two blocks", check_blocks},
              {"corners, discs, a disc in a ring", check_shapes},
              {"a ring folds between two smooth hammers", [](Checks& c) { check_folding(c, "smooth", 0); }},
              {"a ring folds between two rough hammers", [](Checks& c) { check_folding(c, "rough", 0.3); }},
              {.name = "crushed rings", .check = check_crush, .is_long = true},
              {.name = "a heap on the ground", .check = check_heap, .is_long = true},
          }};
}

}  // namespace udar::verification

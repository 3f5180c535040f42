// What an episode says about turning: spins of the bodies, and the velocity along the boundary before and after.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/output/watched_run.hpp"
#include "udar/output/contact_recorder.hpp"

namespace udar {
namespace {

constexpr double radius = 0.01;  // m

/// An elastic disc strikes a half-plane at an angle.
Case oblique_disc(double friction, Vec2 velocity, double spin = 0) {
  return {
      .run = {.end_time = 100e-6},
      .materials = {{.name = "steel", .density = 7850, .law = Elastic{.young_modulus = 196e9, .poisson_ratio = 0.25}}},
      .bodies = {{.name = "disc",
                  .material = "steel",
                  .thickness = 0.01,
                  .velocity = velocity,
                  .spin = spin,
                  .mesh = DiscMesh{.radius = radius, .at = {0, radius + 1e-7}, .element_size = 0.001}}},
      .obstacles = {{.name = "floor", .shape = HalfPlane{}, .friction = friction}}};
}

Vec2 centre_of(const WatchedRun& run, std::size_t body) {
  return (1 / run.model.bodies[body].mass) * run.state.body_sums[body].position;
}

/// Polar moment of inertia of the nodes about their centre of mass, kg m2.
double inertia_of(const Model& model, const Body& body) {
  Vec2 centre;
  for (Index i = body.node_begin; i < body.node_end; ++i) centre += (model.mass[i] / body.mass) * model.rest[i];
  double sum = 0;
  for (Index i = body.node_begin; i < body.node_end; ++i) {
    sum += model.mass[i] * dot(model.rest[i] - centre, model.rest[i] - centre);
  }
  return sum;
}

/// What the floor did to the disc, summed up by hand.
struct Pushes {
  Vec2 impulse{};          ///< N s
  double moment = 0;       ///< N m s, about the centre of mass
  double without_rub = 0;  ///< N s, of the normal impulse on nodes in their first step, which has no friction yet
  double aside = 0;        ///< N m s, of the normal impulses times how far aside from the centre they act
  double height = 0;       ///< N m s, the same times how far above it: negative
  double flattened = 0;    ///< m, most by which the distance of the floor from the centre differs from the radius
};

Pushes watch(WatchedRun& run, ContactRecorder& recorder) {
  Pushes p;
  run.run([&] {
    recorder.record(run.state);
    const double span = 0.5 * (run.state.clock.last_step + run.state.clock.next_step);
    for (std::size_t c = 0; c < run.model.contact_nodes.size(); ++c) {
      const SpringState& s = run.state.contacts[c];
      if (s.touches == 0) continue;
      const Vec2 arm = place(run.state, run.model.contact_nodes[c]) - centre_of(run, 0);
      const Vec2 impulse = span * (s.normal_force + s.friction_force);
      p.impulse += impulse;
      p.moment += cross(arm, impulse);
      if (s.friction_force == Vec2{}) p.without_rub += impulse.y;
      p.aside += std::fabs(arm.x) * span * s.normal_force.y;
      p.height += arm.y * span * s.normal_force.y;
      p.flattened = std::max(p.flattened, std::fabs(arm.y + radius));
    }
  });
  return p;
}

}  // namespace

TEST_CASE("the spin of a body changes by the moment of the forces on it, to rounding") {
  for (const double friction : {0.0, 0.1, 0.5}) {
    CAPTURE(friction);
    WatchedRun run(oblique_disc(friction, {20, -5}, 300));
    ContactRecorder recorder(run.model);
    const Pushes p = watch(run, recorder);
    const EpisodeSummary e = recorder.summary().at("floor").episodes.at(0);
    const double inertia = inertia_of(run.model, run.model.bodies[0]);
    const double size = inertia * 300 + radius * length(p.impulse);
    REQUIRE(e.separation == e.separation);
    CHECK(std::fabs(e.spin_before.at("disc") - 300 * inertia) < 1e-12 * size);
    CHECK(std::fabs(e.spin_after.at("disc") - e.spin_before.at("disc") - p.moment) < 1e-11 * size);
    // The velocity along the floor is that of a rigid disc: pushes turned by +90 degrees point to -x.
    const double height = p.height / p.impulse.y;
    const double slip = -(e.velocity_after.x - height * e.spin_after.at("disc") / inertia);
    CHECK(e.slip_velocity_after == doctest::Approx(slip).epsilon(1e-9));
    CHECK(e.slip_velocity_before == doctest::Approx(-(20 - height * 300)).epsilon(1e-9));
    CHECK(e.tangential_restitution == doctest::Approx(-e.slip_velocity_after / e.slip_velocity_before).epsilon(1e-12));
  }
}

TEST_CASE("without friction a disc keeps spin and slides on: tangential restitution -1") {
  for (const double turn : {0.0, 0.03}) {  // rad; with a node at the very bottom, and beside it
    CAPTURE(turn);
    Case input = oblique_disc(0, {20, -5});
    std::get<DiscMesh>(input.bodies[0].mesh).turn = turn;
    WatchedRun run(input);
    ContactRecorder recorder(run.model);
    const Pushes p = watch(run, recorder);
    const EpisodeSummary e = recorder.summary().at("floor").episodes.at(0);
    const double inertia = inertia_of(run.model, run.model.bodies[0]);
    // The floor pushes straight up; a moment comes only from how far aside of the centre it does so.
    CHECK(e.velocity_after.x == doctest::Approx(20).epsilon(1e-12));
    const double rounding = 1e-12 * radius * length(p.impulse);
    const double moment = p.aside + rounding;
    CHECK(std::fabs(e.spin_after.at("disc")) <= moment);
    CHECK(std::fabs(e.tangential_restitution + 1) <= moment / inertia * radius / 20);
  }
}

TEST_CASE("a disc that slides throughout loses slip as a rigid one does") {
  // Coulomb: J_x = -mu J_y, J_y = m (1 + e) v, and with moment of inertia I about the centre
  //   e_t = -1 + mu (1 + e) (v / u) (1 + m R^2 / I)
  // (Walton 1993, for gross sliding; 3 mu (1 + e) v / u - 1 for a disc). What is different here, each summed up by
  // watch(): no friction in a node's first step (a part f of the impulse), a floor nearer than R by d, and pushes aside
  // of the centre by a on average. Products of these with each other are below a tenth of the bound.
  constexpr double friction = 0.1;
  constexpr double u = 20;
  constexpr double v = 2;
  for (const double turn : {0.0, 0.03}) {
    CAPTURE(turn);
    Case input = oblique_disc(friction, {u, -v});
    std::get<DiscMesh>(input.bodies[0].mesh).turn = turn;
    WatchedRun run(input);
    ContactRecorder recorder(run.model);
    const Pushes p = watch(run, recorder);
    const EpisodeSummary e = recorder.summary().at("floor").episodes.at(0);
    const double mass = run.model.bodies[0].mass;
    const double inertia = inertia_of(run.model, run.model.bodies[0]);
    CHECK(p.impulse.y == doctest::Approx(mass * (1 + e.restitution) * v).epsilon(1e-9));
    CHECK(p.impulse.x == doctest::Approx(-friction * (p.impulse.y - p.without_rub)).epsilon(1e-9));
    const double round = mass * radius * radius / inertia;
    const double change = friction * (1 + e.restitution) * v / u;
    const double rigid = -1 + change * (1 + round);
    const double unlike = p.without_rub / p.impulse.y * (1 + round) + round * (2 * p.flattened / radius) +
                          round * p.aside / p.impulse.y / (friction * radius);
    INFO("tangential restitution ", e.tangential_restitution, ", of a rigid disc ", rigid, " +- ",
         1.1 * change * unlike);
    CHECK(std::fabs(e.tangential_restitution - rigid) <= 1.1 * change * unlike);
  }
}

TEST_CASE("a disc that strikes head-on has no tangential restitution") {
  WatchedRun run(oblique_disc(0.3, {0, -5}));
  ContactRecorder recorder(run.model);
  watch(run, recorder);
  CHECK(std::isnan(recorder.summary().at("floor").episodes.at(0).tangential_restitution));
  CHECK(recorder.summary().at("floor").episodes.at(0).slip_velocity_before == doctest::Approx(0).epsilon(1e-9));
}

TEST_CASE("of two bodies that rub and spin each has its spin; what slips is the first against the second") {
  Case input = oblique_disc(0, {});
  input.obstacles.clear();
  input.contact.friction = 0.2;
  input.bodies[0].velocity = {10, -20};
  input.bodies[0].spin = 500;
  input.bodies.push_back({.name = "plate",
                          .material = "steel",
                          .thickness = 0.01,
                          .velocity = {-5, 0},
                          .mesh = RectangleMesh{.size = {0.03, 0.01}, .at = {-0.012, -0.01}, .element_size = 0.001}});
  WatchedRun run(input);
  ContactRecorder recorder(run.model);
  double pressed = 0;
  Vec2 arms[2];
  double spin_before[2] = {500 * inertia_of(run.model, run.model.bodies[0]), 0};
  run.run([&] {
    recorder.record(run.state);
    const double span = 0.5 * (run.state.clock.last_step + run.state.clock.next_step);
    for (const BodyTouch& touch : run.state.touches) {
      const double push = span * length(touch.springs.normal_force);
      pressed += push;
      for (const std::size_t b : {0U, 1U}) {
        arms[b] += push * (place(run.state, run.model.contact_nodes[touch.point]) - centre_of(run, b));
      }
    }
  });
  const auto contacts = recorder.summary();
  REQUIRE(contacts.size() == 1);
  const ContactSummary& contact = contacts.at("disc/plate");
  REQUIRE(contact.episodes.size() == 1);
  const EpisodeSummary& e = contact.episodes[0];
  REQUIRE(e.separation == e.separation);

  const char* names[] = {"disc", "plate"};
  double spin = 0;  // about the origin, what the two have at the end
  Vec2 before;
  Vec2 after;
  for (const std::size_t b : {0U, 1U}) {
    const Body& body = run.model.bodies[b];
    const double inertia = inertia_of(run.model, body);
    const Vec2 momentum = run.state.body_momentum[b];
    CHECK(std::fabs(e.spin_before.at(names[b]) - spin_before[b]) < 1e-12 * spin_before[0]);
    // Nothing acts after the episode.
    const double own = run.state.body_spin[b] - cross(centre_of(run, b), momentum);
    CHECK(std::fabs(e.spin_after.at(names[b]) - own) < 1e-9 * spin_before[0]);
    spin += own + cross(centre_of(run, b), momentum);
    const Vec2 arm = (1 / pressed) * arms[b];
    const double sign = b == 0 ? 1 : -1;
    before += sign * (input.bodies[b].velocity + spin_before[b] / inertia * perpendicular(arm));
    after += sign * ((1 / body.mass) * momentum + own / inertia * perpendicular(arm));
  }
  CHECK(e.spin_after.at("plate") != 0);
  CHECK(spin == doctest::Approx(run.state.ledger.spin).epsilon(1e-9));
  const Vec2 push = book_of_pair(run.state, 0, 1)->normal.impulse();
  const Vec2 tangent = (1 / length(push)) * perpendicular(push);
  CHECK(e.slip_velocity_before == doctest::Approx(dot(before, tangent)).epsilon(1e-9));
  CHECK(e.slip_velocity_after == doctest::Approx(dot(after, tangent)).epsilon(1e-9));
  CHECK(e.tangential_restitution == doctest::Approx(-e.slip_velocity_after / e.slip_velocity_before).epsilon(1e-12));
}

TEST_CASE("what does not exist is no number: several bodies on an obstacle, a body on itself, a contact that lasts") {
  // Two discs strike the floor at the same time.
  Case input = oblique_disc(0.2, {20, -5});
  input.bodies.push_back(input.bodies[0]);
  input.bodies[1].name = "other";
  std::get<DiscMesh>(input.bodies[1].mesh).at.x = 0.1;
  WatchedRun run(input);
  ContactRecorder recorder(run.model);
  run.run([&] { recorder.record(run.state); });
  const EpisodeSummary both = recorder.summary().at("floor").episodes.at(0);
  CHECK(std::isnan(both.tangential_restitution));
  CHECK(std::isnan(both.slip_velocity_before));
  CHECK(std::isnan(both.slip_velocity_after));
  REQUIRE(both.spin_after.size() == 2);
  CHECK(both.spin_after.at("disc") == doctest::Approx(both.spin_after.at("other")).epsilon(1e-6));

  Case cut = oblique_disc(0.2, {20, -5});
  cut.run.end_time = 5e-6;
  WatchedRun short_run(cut);
  ContactRecorder short_recorder(short_run.model);
  short_run.run([&] { short_recorder.record(short_run.state); });
  const EpisodeSummary lasts = short_recorder.summary().at("floor").episodes.at(0);
  CHECK(std::isnan(lasts.tangential_restitution));
  CHECK(std::isfinite(lasts.slip_velocity_after));
  CHECK(lasts.spin_before.at("disc") == doctest::Approx(0));
}

}  // namespace udar

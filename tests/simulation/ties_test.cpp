// Bodies tied to each other: what must hold exactly, or to rounding.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/simulation/example.hpp"
#include "udar/base/error.hpp"
#include "udar/case/build_model.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

using Touch = ContactPairCase::Touch;

const Elastic elastic{.young_modulus = 196e9, .poisson_ratio = 0.25};

BodyCase block(const char* name, const char* material, const RectangleMesh& mesh) {
  return {.name = name, .material = material, .thickness = 0.01, .mesh = mesh};
}

/// Two blocks of different materials and meshes whose nodes do not meet, tied along a part of their sides.
Case tied_blocks() {
  return {
      .run = {.end_time = 300e-6},
      .contact_pairs = {{.body = "upper", .other = "lower", .touch = Touch::tied}},
      .materials = {{.name = "steel",
                     .density = 7850,
                     .law = Tresca{.young_modulus = 196e9, .poisson_ratio = 0.25, .yield_stress = 235e6}},
                    {.name = "aluminium", .density = 2700, .law = Elastic{70e9, 0.33}}},
      .bodies = {block("lower", "steel", {.size = {0.04, 0.02}, .at = {-0.02, 0}, .element_size = 0.004}),
                 block("upper", "aluminium", {.size = {0.03, 0.015}, .at = {-0.003, 0.02}, .element_size = 0.003})}};
}

/// The same, thrown as one piece that spins about the origin.
Case thrown_blocks(double spin) {
  Case input = tied_blocks();
  for (BodyCase& body : input.bodies) {
    const auto& mesh = std::get<RectangleMesh>(body.mesh);
    body.velocity = Vec2{10, 5} + spin * perpendicular(mesh.at + 0.5 * mesh.size);
    body.spin = spin;
  }
  return input;
}

/// A third one strikes them.
Case struck_blocks() {
  Case input = thrown_blocks(400);
  input.contact.friction = 0.3;
  input.bodies.push_back(
      block("hammer", "steel", {.size = {0.02, 0.02}, .at = {-0.015, 0.0355}, .element_size = 0.0025}));
  input.bodies.back().velocity = {0, -30};
  return input;
}

double largest_stretch(const Model& model, const State& state) {
  const auto at = [&](std::uint32_t point) { return place(state, model.contact_nodes[point]); };
  double most = 0;
  for (const Tie& tie : model.ties) {
    const Segment& s = model.segments[tie.segment];
    most = std::max(most, length(pull(tie, at(tie.point), at(s.a), at(s.b)).stretch));
  }
  return most;
}

std::string refusal(const Case& input) {
  try {
    const Model model = build_model(input);
    Workspace work(model, 1);
    start(model, work);
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("tied blocks that spin and are struck: momentum and spin stay, the books close") {
  for (const Integrator integrator : {Integrator::central_difference, Integrator::adams}) {
    Case input = struck_blocks();
    input.run.integrator = integrator;
    const Model model = build_model(input);
    Workspace work(model, 1);
    State state = start(model, work);
    const Totals before = totals(model, state);
    double spin_drift = 0;
    double momentum_drift = 0;
    double held = 0;
    double stretch = 0;
    bool struck = false;
    while (!finished(model, state)) {
      step(model, state, work);
      const Totals now = totals(model, state);
      spin_drift = std::max(spin_drift, std::fabs(now.spin - before.spin));
      momentum_drift = std::max(momentum_drift, length(now.momentum - before.momentum));
      held = std::max(held, state.ledger.tie_energy);
      stretch = std::max(stretch, largest_stretch(model, state));
      struck = struck || !state.touches.empty();
    }
    CHECK(struck);
    CHECK(held > 0);
    CHECK(stretch < 0.02 * 0.003);  // they hold, while the blocks would have come far apart
    CHECK(state.ledger.energy_error() < 5e-3);
    CHECK(momentum_drift < 1e-12 * before.size);
    // Half-step places and velocities belong together for central difference only.
    if (integrator != Integrator::central_difference) continue;
    CHECK(spin_drift < 1e-12 * before.size * 0.04);
    CHECK(state.ledger.identity_error() < 1e-11);
  }
}

TEST_CASE("a rigid body tied to one that deforms: momentum and spin stay, and it swings with it") {
  Case input = thrown_blocks(400);
  input.materials[0].law = elastic;
  input.bodies[1].rigid = true;
  input.bodies[1].velocity += Vec2{0, -3};
  input.run.end_time = 1e-3;
  const Model model = build_model(input);
  Workspace work(model, 1);
  State state = start(model, work);
  const double size = totals(model, state).size;
  const auto momentum = [&] { return state.body_momentum[0] + state.body_momentum[1]; };
  const auto spin = [&] { return state.body_spin[0] + state.body_spin[1]; };
  const Vec2 start_momentum = momentum();
  const double start_spin = spin();
  double momentum_drift = 0;
  double spin_drift = 0;
  while (!finished(model, state)) {
    step(model, state, work);
    momentum_drift = std::max(momentum_drift, length(momentum() - start_momentum));
    spin_drift = std::max(spin_drift, std::fabs(spin() - start_spin));
  }
  CHECK(momentum_drift < 1e-12 * size);
  CHECK(spin_drift < 1e-12 * size * 0.04);
  CHECK(largest_stretch(model, state) < 0.02 * 0.003);
  CHECK(state.ledger.energy_error() < 1e-3);
}

TEST_CASE("ties lose no energy: the error falls with the square of the step") {
  const auto error = [](double safety) {
    Case input = thrown_blocks(4000);
    input.materials[0].law = elastic;
    input.run.step_safety = safety;
    input.run.end_time = 100e-6;
    const Model model = build_model(input);
    Workspace work(model, 1);
    State state = start(model, work);
    while (!finished(model, state)) step(model, state, work);
    return state.ledger.energy_error();
  };
  CHECK(error(0.4) < error(0.8) / 3.5);
}

TEST_CASE("the stable limit holds with ties: ten thousand steps of noise") {
  // Equal meshes and one five times as fine; a corner tied to two others; ties far stiffer than the elements.
  for (const auto& given : {std::pair{0.004, 0.0}, {0.0008, 0.0}, {0.004, 2e10}, {0.0008, 2e10}}) {
    const double fine = given.first;
    const double stiffness = given.second;
    CAPTURE(fine);
    CAPTURE(stiffness);
    Case input = tied_blocks();
    input.materials[0].law = elastic;
    std::get<RectangleMesh>(input.bodies[1].mesh) = {
        .size = {0.012, 0.008}, .at = {-0.003, 0.02}, .element_size = fine};
    input.bodies.push_back(
        block("beside", "steel", {.size = {0.012, 0.012}, .at = {0.009, 0.02}, .element_size = 0.003}));
    input.contact_pairs.push_back({.body = "beside", .other = "lower", .touch = Touch::tied});
    input.contact_pairs.push_back({.body = "beside", .other = "upper", .touch = Touch::tied});
    if (stiffness > 0) {
      for (ContactPairCase& pair : input.contact_pairs) pair.stiffness = stiffness;
    }
    input.run.end_time = 1;
    Model model = build_model(input);
    std::mt19937 random(5);
    const auto number = [&] { return 1e-3 * (0x1p-31 * static_cast<double>(random()) - 1); };  // m/s
    for (Index i = 0; i < model.node_count; ++i) model.start_velocity[i] = {number(), number()};
    Workspace work(model, 1);
    model.run.time_step = 0.95 * start(model, work).clock.limit.size;
    State state = start(model, work);
    const double energy = state.ledger.start_energy;
    double most = 0;
    for (int k = 0; k < 10000; ++k) {
      step(model, state, work);
      most = std::max(most, state.ledger.half_step_kinetic);
    }
    // Central difference keeps x K x / 2 + m v v / 2 - h^2 v K v / 8, v at half steps: with h = s 2 / omega the kinetic
    // energy there is at most 1 / (1 - s^2) times that. Above the limit it would grow without end.
    CHECK(most < energy / (1 - 0.95 * 0.95));
    CHECK(most > 0.3 * energy);
    CHECK(state.ledger.energy_error() < 1e-5);
  }
}

TEST_CASE("what is tied does not touch, what is not does") {
  // A block set on with a gap that opens like a wedge: tied where it is narrow, and thrown so that the rest closes.
  Case input = tied_blocks();
  input.materials[0].law = elastic;
  std::get<RectangleMesh>(input.bodies[0].mesh) = {.size = {0.05, 0.01}, .at = {-0.01, 0}, .element_size = 0.005};
  std::get<RectangleMesh>(input.bodies[1].mesh) = {
      .size = {0.035, 0.005}, .at = {0, 0.01}, .turn = 0.04, .element_size = 0.005};
  input.bodies[1].velocity = {0, -70};
  input.run.step_safety = 0.3;  // what touches cost falls with its square
  const Model model = build_model(input);
  std::vector<bool> tied(model.contact_nodes.size());
  for (const Tie& tie : model.ties) {
    tied[tie.point] = true;
    CHECK(model.is_tied(tie.point, model.segments[tie.segment].body));
  }
  Workspace work(model, 1);
  State state = start(model, work);
  std::size_t most = 0;
  std::size_t of_tied = 0;
  while (!finished(model, state)) {
    step(model, state, work);
    most = std::max(most, state.touches.size());
    for (const BodyTouch& touch : state.touches) of_tied += tied[touch.point] ? 1 : 0;
  }
  CHECK(most > 0);
  CHECK(of_tied == 0);
  CHECK(state.ledger.energy_error() < 5e-3);
}

TEST_CASE("a disc in a hole whose mesh has other chords of the same circle") {
  for (const auto& sizes : {std::pair{0.0006, 0.006}, {0.006, 0.0006}}) {
    const double disc = sizes.first;
    const double ring = sizes.second;
    CAPTURE(disc);
    Case input = tied_blocks();
    input.bodies[0].mesh = DiscMesh{.radius = 0.01, .element_size = disc};
    input.bodies[1].mesh = RingMesh{.outer_radius = 0.02, .inner_radius = 0.01, .element_size = ring};
    for (BodyCase& body : input.bodies) body.spin = 300;
    const Model model = build_model(input);
    std::size_t round = 0;  // nodes on the circle
    for (const Index node : model.contact_nodes) round += length(model.rest[node]) < 0.0101 ? 1 : 0;
    CHECK(model.ties.size() == round);
    Workspace work(model, 1);
    State state = start(model, work);
    while (!finished(model, state)) step(model, state, work);
    CHECK(state.ledger.energy_error() < 1e-3);
    CHECK(largest_stretch(model, state) < 1e-5);
    CHECK(state.touches.empty());
  }
}

TEST_CASE("the same bits for any number of threads, with ties") {
  const Model model = build_model(struck_blocks());
  const auto hash = [&](int threads) {
    Workspace work(model, threads);
    State state = start(model, work);
    for (int k = 0; k < 300; ++k) step(model, state, work);
    return hash_of(state);
  };
  const std::uint64_t expected = hash(1);
  for (const int threads : {2, 3, 7}) CHECK(hash(threads) == expected);
}

TEST_CASE("all ties of a side together are as stiff as one row of the elements beside it, ends and all") {
  Case input = tied_blocks();
  const Elastic law{.young_modulus = 196e9, .poisson_ratio = 0.25};
  input.materials[0].law = law;
  input.bodies[1].material = "steel";
  auto& mesh = std::get<RectangleMesh>(input.bodies[1].mesh);
  mesh = {.size = {0.04, 0.015}, .at = {-0.02, 0.02}};
  for (const double size : {0.004, 0.002, 0.0015}) {
    CAPTURE(size);
    mesh.element_size = size;
    const Model model = build_model(input);
    double sum = 0;
    for (const Tie& tie : model.ties) sum += tie.stiffness;
    // Elements of the lower block are 4 mm high over that side, the coarser and so the softer ones.
    CHECK(sum == doctest::Approx(law.elasticity().wave_modulus() * 0.01 * 0.04 / 0.004).epsilon(1e-12));
  }
}

TEST_CASE("a stiffness that is given is that of the ties") {
  Case input = tied_blocks();
  input.contact_pairs[0].stiffness = 3e8;
  const Model model = build_model(input);
  REQUIRE(!model.ties.empty());
  for (const Tie& tie : model.ties) CHECK(tie.stiffness == 3e8);
  CHECK(std::is_sorted(model.ties.begin(), model.ties.end(),
                       [](const Tie& a, const Tie& b) { return a.point < b.point; }));
}

TEST_CASE("bodies that are to be tied but are apart are refused, with the distance and a cure") {
  Case input = tied_blocks();
  std::get<RectangleMesh>(input.bodies[1].mesh).at = {-0.003, 0.0225};
  const std::string text = refusal(input);
  CHECK(text.find("bodies `lower` and `upper` are to be tied, but they do not touch: their boundaries are 0.0025 m "
                  "apart") != std::string::npos);
  CHECK(text.find("move one of them (`at` of its mesh)") != std::string::npos);
}

}  // namespace udar

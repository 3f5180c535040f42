// What is shown and summed up of a corner of an obstacle that pushes a boundary between its nodes.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/output/watched_run.hpp"
#include "tests/results/scratch.hpp"
#include "udar/output/contact_recorder.hpp"
#include "udar/output/frame_writer.hpp"

namespace udar {
namespace {

/// An elastic block of cells of 1 cm, 0.1 mm over an obstacle.
Case block_over(const Shape& shape, double friction, Vec2 velocity, double spin) {
  return {.run = {.end_time = 200e-6},
          .materials = {{.name = "steel", .density = 7850, .law = Elastic{196e9, 0.25}}},
          .bodies = {{.name = "block",
                      .material = "steel",
                      .thickness = 0.01,
                      .velocity = velocity,
                      .spin = spin,
                      .mesh = RectangleMesh{.size = {0.06, 0.03}, .at = {-0.03, 0.0001}, .element_size = 0.01}}},
          .obstacles = {{.name = "far", .shape = HalfPlane{.point = {0, -1}}},
                        {.name = "edge", .shape = shape, .friction = friction}}};
}

constexpr Vec2 tip{0.003, 0};
const Polygon wedge{.points = {{-0.004, -0.02}, {0.004, -0.02}, tip}};

Vec2 centre_of(const WatchedRun& run) { return (1 / run.model.bodies[0].mass) * run.state.body_sums[0].position; }

template <class Value>
const std::vector<Value>& values_of(const VtuGrid& grid, std::string_view name) {
  const auto found = std::ranges::find(grid.point_fields, name, &VtuArray::name);
  REQUIRE_MESSAGE(found != grid.point_fields.end(), name);
  return std::get<std::vector<Value>>(found->values);
}

VtuGrid frame_of(const WatchedRun& run) {
  const Scratch folder;
  write_vtu(folder / "a.vtu", body_frame(run.model, run.state));
  return read_vtu(folder / "a.vtu");
}

Vec2 sum_of_forces(const VtuGrid& grid) {
  const auto& force = values_of<float>(grid, "contact_force_N");
  Vec2 sum;
  for (std::size_t i = 0; i < force.size(); i += 3) sum += {force[i], force[i + 1]};
  return sum;
}

}  // namespace

TEST_CASE("an obstacle that only a boundary between nodes touches has its episode, with spins and slip") {
  WatchedRun run(block_over(wedge, 0.3, {2, -5}, 0));
  ContactRecorder recorder(run.model);
  std::size_t nodes = 0;
  double pressed = 0;
  Vec2 arm;
  Vec2 impulse;
  Vec2 normal_impulse;
  run.run([&] {
    recorder.record(run.state);
    for (const SpringState& s : run.state.contacts) nodes += s.touches;
    const double span = 0.5 * (run.state.clock.last_step + run.state.clock.next_step);
    for (const CornerTouch& t : run.state.corner_touches) {
      REQUIRE(t.relieves == 0);
      // The corner's forces are those on the boundary turned round.
      const double size = span * length(t.springs.normal_force);
      pressed += size;
      arm += size * (tip - centre_of(run));
      normal_impulse -= span * t.springs.normal_force;
      impulse -= span * (t.springs.normal_force + t.springs.friction_force);
    }
  });
  REQUIRE(nodes == 0);
  REQUIRE(pressed > 0);
  CHECK(recorder.summary().at("far").episodes.empty());
  const ContactSummary s = recorder.summary().at("edge");
  REQUIRE(s.episodes.size() == 1);
  const EpisodeSummary& e = s.episodes[0];
  const double mass = run.model.bodies[0].mass;
  CHECK(length(e.impulse - impulse) < 1e-12 * length(impulse));
  CHECK(length(mass * (e.velocity_after - e.velocity_before) - impulse) < 1e-11 * length(impulse));
  CHECK(length(e.velocity_before - Vec2{2, -5}) < 1e-12);
  CHECK(e.separation > e.first_touch);
  const Vec2 push = (1 / length(normal_impulse)) * normal_impulse;
  CHECK(e.restitution == doctest::Approx(dot(e.velocity_after, push) / -dot(e.velocity_before, push)).epsilon(1e-9));
  double inertia = 0;
  const Vec2 centre{0, 0.0151};
  for (Index i = 0; i < run.model.node_count; ++i) {
    const Vec2 r = run.model.rest[i] - centre;
    inertia += run.model.mass[i] * dot(r, r);
  }
  const Vec2 along = perpendicular(push);
  const double spin = e.spin_after.at("block");
  CHECK(spin != 0);
  CHECK(e.slip_velocity_before == doctest::Approx(dot(Vec2{2, -5}, along)).epsilon(1e-9));
  const Vec2 after = e.velocity_after + (spin / inertia / pressed) * perpendicular(arm);
  CHECK(e.slip_velocity_after == doctest::Approx(dot(after, along)).epsilon(1e-6));  // the mesh leans to one side
}

TEST_CASE("a frame shows a corner at the two ends of the segment that it is in, and no node else") {
  for (const double friction : {0.0, 10.0}) {
    CAPTURE(friction);
    Case input = block_over(wedge, friction, {2, -5}, 0);
    input.run.end_time = 30e-6;
    WatchedRun run(input);
    run.run([] {});
    REQUIRE(run.state.corner_touches.size() == 1);
    const CornerTouch& touch = run.state.corner_touches[0];
    const VtuGrid grid = frame_of(run);
    const Vec2 total = run.state.obstacles[1].total.force;
    CHECK(total.y > 0);
    CHECK(length(sum_of_forces(grid) - total) < 1e-6 * length(total));
    const Segment& s = run.model.segments[touch.segment];
    for (Index i = 0; i < run.model.node_count; ++i) {
      CAPTURE(i);
      const bool end = i == run.model.contact_nodes[s.a] || i == run.model.contact_nodes[s.b];
      const float depth = end ? static_cast<float>(touch.springs.penetration) : 0;
      CHECK(values_of<float>(grid, "contact_penetration_m")[i] == depth);
      CHECK(values_of<std::int32_t>(grid, "contact_partner")[i] == (end ? 2 : -1));
      CHECK(values_of<std::uint8_t>(grid, "contact_state")[i] == (!end ? 0 : friction > 0 ? 1 : 2));
      const Vec2 normal{values_of<float>(grid, "contact_normal")[3 * i],
                        values_of<float>(grid, "contact_normal")[3 * i + 1]};
      CHECK(length(normal - (end ? -touch.springs.normal : Vec2{})) < 1e-7);
      if (end) CHECK(normal.y > 0.99);  // out of the obstacle
    }
  }
}

TEST_CASE("forces in a frame add up to those of the obstacle where nodes and corners touch it") {
  WatchedRun run(block_over(Rectangle{.at = {-0.0137, -0.05}, .size = {0.0274, 0.05}}, 0.3, {1, -5}, -60));
  std::size_t both = 0;
  while (!finished(run.model, run.state)) {
    step(run.model, run.state, run.work);
    const auto relieves = [](const CornerTouch& t) { return t.relieves != 0; };
    if (run.state.clock.step % 8 != 0 || std::ranges::none_of(run.state.corner_touches, relieves)) continue;
    ++both;
    const Vec2 total = run.state.obstacles[1].total.force;
    double size = 0;
    for (const SpringState& s : run.state.contacts) size += length(s.normal_force);
    CHECK(length(sum_of_forces(frame_of(run)) - total) < 1e-6 * size);
  }
  CHECK(both > 0);
}

}  // namespace udar

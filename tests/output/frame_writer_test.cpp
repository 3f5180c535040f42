#include "udar/output/frame_writer.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <thread>

#include "tests/output/watched_run.hpp"
#include "tests/results/scratch.hpp"
#include "tests/simulation/example.hpp"
#include "udar/case/build_model.hpp"
#include "udar/output/observer.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

/// Runs a case with frames into `folder`; returns the times of all steps.
std::vector<double> run_with_frames(WatchedRun& run, const fs::path& folder) {
  FrameWriter frames(run.model, create_run_folder(folder, false), run.work.pool);
  std::vector<double> times;
  run.run([&] {
    times.push_back(run.time());
    frames.record(run.state);
  });
  frames.close(run.state);
  return times;
}

/// Times of the frames of the bodies.
std::vector<double> frame_times(const fs::path& folder) {
  std::vector<double> times;
  for (const PvdEntry& entry : read_pvd(folder / RunFolder::fields_index)) {
    if (entry.part == 0) times.push_back(entry.time);
  }
  return times;
}

template <class Value>
const std::vector<Value>& values_of(const std::vector<VtuArray>& fields, std::string_view name) {
  const auto found = std::ranges::find(fields, name, &VtuArray::name);
  REQUIRE_MESSAGE(found != fields.end(), name);
  return std::get<std::vector<Value>>(found->values);
}

double first_from(const std::vector<double>& times, double due) { return *std::ranges::lower_bound(times, due); }

}  // namespace

TEST_CASE("frames at the multiples of the interval, from 0 to the end") {
  const Scratch folder;
  Case input = falling_block();
  input.output.fields_every = 20e-6;
  WatchedRun run(input);
  const auto times = run_with_frames(run, folder / "run");
  const std::vector<double> expected{0, first_from(times, 20e-6), first_from(times, 40e-6), run.time()};
  CHECK(frame_times(folder / "run") == expected);
}

TEST_CASE("frames at given times, also at 0 and at the end, in any order, each once") {
  const Scratch folder;
  Case input = falling_block();
  input.output.fields_at = {60e-6, 0, 12e-6, 12e-6};
  WatchedRun run(input);
  const auto times = run_with_frames(run, folder / "run");
  CHECK(frame_times(folder / "run") == std::vector<double>{0, first_from(times, 12e-6), run.time()});
}

TEST_CASE("a given time between steps takes the first step after it, a time of a step that step") {
  const Scratch folder;
  Case input = falling_block();
  input.run.time_step = 0.1e-6;
  input.output.fields_at = {0.3e-6, 0.7e-6, 1.25e-6};
  WatchedRun run(input);
  run_with_frames(run, folder / "run");
  const auto times = frame_times(folder / "run");
  REQUIRE(times.size() == 4);
  CHECK(times[0] == doctest::Approx(0.3e-6));
  CHECK(times[1] == doctest::Approx(0.7e-6));
  CHECK(times[2] == doctest::Approx(1.3e-6));
}

TEST_CASE("no frames where none are asked for") {
  const Scratch folder;
  WatchedRun run(falling_block());
  run_with_frames(run, folder / "run");
  CHECK_FALSE(fs::exists(folder / "run" / RunFolder::fields_index));
  CHECK(fs::is_empty(folder / "run" / RunFolder::fields));
}

TEST_CASE("at every moment the index names only files that are there and whole") {
  const Scratch folder;
  Case input = falling_block();
  input.output.fields_every = 10e-6;
  WatchedRun run(input);
  FrameWriter frames(run.model, create_run_folder(folder / "run", false), run.work.pool);
  const fs::path path = folder / "run" / RunFolder::fields_index;
  std::size_t looks = 0;
  run.run([&] {
    frames.record(run.state);
    // Now and then the writer has the time to renew the index while the run goes on.
    if (run.state.clock.step % 100 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(400));
    if (!fs::exists(path)) return;
    const auto index = read_pvd(path);
    for (const PvdEntry& entry : index) CHECK(read_vtu(folder / "run" / entry.file).time == entry.time);
    looks += index.size();
  });
  CHECK(looks > 0);
  frames.close(run.state);
  CHECK(read_pvd(path).size() == 2 * 7);
}

TEST_CASE("a frame that cannot be written is not in the index") {
  const Scratch folder;
  Case input = falling_block();
  input.output.fields_every = 20e-6;
  WatchedRun run(input);
  const fs::path results = folder / "run";
  FrameWriter frames(run.model, create_run_folder(results, false), run.work.pool);
  frames.record(run.state);
  // Not before the first one is there and in the index.
  while (!fs::exists(results / RunFolder::fields_index)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  fs::remove_all(results / RunFolder::fields);
  CHECK_THROWS_AS(frames.close((step(run.model, run.state, run.work), run.state)), OutputError);
  CHECK(read_pvd(results / RunFolder::fields_index).size() == 2);
}

TEST_CASE("a frame that could not be written is told by a later call, and the run may still close") {
  const Scratch folder;
  Case input = falling_block();
  input.output.fields_every = 20e-6;
  WatchedRun run(input);
  const fs::path results = folder / "run";
  FrameWriter frames(run.model, create_run_folder(results, false), run.work.pool);
  fs::remove_all(results / RunFolder::fields);
  CHECK_NOTHROW(frames.record(run.state));
  const auto go_on = [&] {
    while (!finished(run.model, run.state)) {
      step(run.model, run.state, run.work);
      frames.record(run.state);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  };
  CHECK(contains(message_of<OutputError>(go_on), "bodies_000000.vtu"));
  CHECK_FALSE(finished(run.model, run.state));
  fs::create_directory(results / RunFolder::fields);
  frames.close(run.state);
  CHECK(frame_times(results) == std::vector{run.time()});
  CHECK(read_vtu(results / RunFolder::frame_name("bodies", 0)).time == run.time());
}

TEST_CASE("frames of every step, by any number of threads, are those that would be written at once") {
  const Scratch folder;
  Case input = falling_block(0.00125);
  input.run.end_time = 4e-6;
  input.output.fields_every = 1e-10;
  for (const int threads : {1, 2, 4}) {
    CAPTURE(threads);
    WatchedRun run(input);
    Pool pool(threads);
    const fs::path results = folder / std::to_string(threads);
    FrameWriter frames(run.model, create_run_folder(results, false), pool);
    std::vector<std::string> bodies;
    run.run([&] {
      frames.record(run.state);
      write_vtu(folder / "b.vtu", body_frame(run.model, run.state));
      bodies.push_back(read_file(folder / "b.vtu", 1 << 24));
    });
    frames.close(run.state);
    CHECK(frame_times(results).size() == bodies.size());
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      CAPTURE(k);
      const std::string name = RunFolder::frame_name("bodies", static_cast<int>(k));
      CHECK((read_file(results / name, 1 << 24) == bodies[k]));
    }
  }
}

TEST_CASE("a frame reads back as the state, within a float") {
  const Scratch folder;
  Case input = falling_block();
  input.output.fields_at = {10e-6};
  input.run.end_time = 10e-6;
  WatchedRun run(input);
  run_with_frames(run, folder / "run");
  const Model& model = run.model;
  const State& state = run.state;
  const VtuGrid grid = read_vtu(folder / "run" / RunFolder::frame_name("bodies", 0));
  REQUIRE(grid.points.size() == model.node_count);
  REQUIRE(grid.kinds.size() == model.element_count);
  CHECK(grid.time == run.time());

  const auto& displacement = values_of<float>(grid.point_fields, "displacement_m");
  const auto& speed = values_of<float>(grid.point_fields, "velocity_m_per_s");
  const auto& acceleration = values_of<float>(grid.point_fields, "acceleration_m_per_s2");
  const auto& force = values_of<float>(grid.point_fields, "contact_force_N");
  const auto& number = values_of<std::int32_t>(grid.point_fields, "node_number");
  Vec2 pushed;
  for (Index i = 0; i < model.node_count; ++i) {
    CAPTURE(i);
    CHECK(length(grid.points[i] - Vec2{state.nodes[i].x, state.nodes[i].y}) <= 1e-8);
    const Vec2 u = Vec2{state.nodes[i].x, state.nodes[i].y} - model.rest[i];
    CHECK(displacement[3 * i + 1] == static_cast<float>(u.y));
    CHECK(speed[3 * i] == static_cast<float>(velocity(state, i).x));
    CHECK(acceleration[3 * i + 1] == static_cast<float>(state.acceleration[i].y));
    CHECK(number[i] == static_cast<std::int32_t>(model.node_numbers[i]));
    pushed += {force[3 * i], force[3 * i + 1]};
  }
  REQUIRE(state.obstacles[0].touching > 0);
  CHECK(pushed.y == doctest::Approx(state.obstacles[0].total.force.y).epsilon(1e-6));
  CHECK(pushed.x == doctest::Approx(state.obstacles[0].total.force.x).epsilon(1e-6));

  const auto& stress = values_of<float>(grid.cell_fields, "stress_y_Pa");
  const auto& largest = values_of<float>(grid.cell_fields, "principal_1_Pa");
  const auto& strain = values_of<float>(grid.cell_fields, "plastic_strain");
  const auto& flows = values_of<std::uint8_t>(grid.cell_fields, "flows_now");
  const auto& element_number = values_of<std::int32_t>(grid.cell_fields, "element_number");
  bool one_flows = false;
  for (Index e = 0; e < model.element_count; ++e) {
    CAPTURE(e);
    CHECK(stress[e] == static_cast<float>(state.stress_yy[e]));
    CHECK(largest[e] == static_cast<float>(principal_stresses(state, e)[0]));
    CHECK(strain[e] == static_cast<float>(state.plastic_strain[e]));
    CHECK((flows[e] != 0) == udar::flows(state, e));
    CHECK(element_number[e] == static_cast<std::int32_t>(model.element_numbers[e]));
    for (std::size_t c = 0; c < 3; ++c) {
      CHECK(grid.corners[3 * e + c] == static_cast<std::int32_t>(model.corners[e][c]));
    }
    one_flows = one_flows || flows[e] != 0;
  }
  CHECK(one_flows);
}

TEST_CASE("a frame shows what each node touches: how deep, which way, whether it slides, and what") {
  const Scratch folder;
  // A block slides on a rough floor, another one on top of it comes along; a third one strikes a smooth wall.
  Case input = falling_block();
  input.run.end_time = 4e-6;
  input.contact.friction = 10;
  input.bodies.push_back(input.bodies[0]);
  input.bodies[1].name = "top";
  std::get<RectangleMesh>(input.bodies[1].mesh) = {.size = {0.03, 0.02}, .at = {-0.013, 0.02}, .element_size = 0.006};
  input.bodies[1].velocity = {5, -90};
  input.bodies.push_back(input.bodies[0]);
  input.bodies[2].name = "third";
  input.bodies[2].velocity = {80, 0};
  std::get<RectangleMesh>(input.bodies[2].mesh).at = {0.06, 0.1};
  input.obstacles.push_back({.name = "wall", .shape = HalfPlane{.point = {0.1, 0}, .normal = {-1, 0}}});
  WatchedRun run(input);
  run.run([] {});
  const Model& model = run.model;
  write_vtu(folder / "a.vtu", body_frame(model, run.state));
  const VtuGrid grid = read_vtu(folder / "a.vtu");
  const auto& depth = values_of<float>(grid.point_fields, "contact_penetration_m");
  const auto& normal = values_of<float>(grid.point_fields, "contact_normal");
  const auto& how = values_of<std::uint8_t>(grid.point_fields, "contact_state");
  const auto& partner = values_of<std::int32_t>(grid.point_fields, "contact_partner");
  REQUIRE(depth.size() == model.node_count);
  REQUIRE(normal.size() == 3 * model.node_count);

  // By hand: of each node the deepest of all its touches.
  std::vector<double> deepest(model.node_count);
  std::vector<int> seen(5);  // nodes that touch body 0, 1, 2, the floor, the wall
  std::vector<int> states(3);
  const std::size_t points = model.contact_nodes.size();
  const auto check = [&](std::size_t point, const SpringState& s, std::int32_t with) {
    const Index node = model.contact_nodes[point];
    deepest[node] = std::max(deepest[node], s.penetration);
    if (s.touches == 0 || depth[node] != static_cast<float>(s.penetration)) return;
    CHECK(partner[node] == with);
    CHECK(normal[3 * node] == static_cast<float>(s.normal.x));
    CHECK(normal[3 * node + 1] == static_cast<float>(s.normal.y));
    CHECK(normal[3 * node + 2] == 0);
    const bool smooth = with == 4;
    CHECK(how[node] == (smooth || s.slides != 0 ? 2 : 1));
    ++seen[static_cast<std::size_t>(with)];
    ++states[how[node]];
  };
  for (std::size_t k = 0; k < run.state.contacts.size(); ++k) {
    check(k % points, run.state.contacts[k], static_cast<std::int32_t>(3 + k / points));
  }
  for (const BodyTouch& t : run.state.touches) check(t.point, t.springs, static_cast<std::int32_t>(t.body));
  int none = 0;
  for (Index i = 0; i < model.node_count; ++i) {
    CHECK(depth[i] == static_cast<float>(deepest[i]));
    if (deepest[i] > 0) continue;
    ++none;
    CHECK(how[i] == 0);
    CHECK(partner[i] == -1);
    CHECK(normal[3 * i] == 0);
    CHECK(normal[3 * i + 1] == 0);
  }
  CHECK(none > 0);
  for (const int with : {0, 1, 3, 4}) {
    CAPTURE(with);
    CHECK(seen[static_cast<std::size_t>(with)] > 0);
  }
  CHECK(seen[2] == 0);
  CHECK(states[1] > 0);
  CHECK(states[2] > 0);
}

TEST_CASE("of a node between two obstacles the deeper touch is shown, of both the force") {
  Case input = falling_block();
  input.run.end_time = 4e-6;
  input.bodies[0].velocity = {-20, -80};
  input.obstacles.push_back({.name = "wall", .shape = HalfPlane{.point = {-0.02, 0}, .normal = {1, 0}}});
  WatchedRun run(input);
  run.run([] {});
  const Scratch folder;
  write_vtu(folder / "a.vtu", body_frame(run.model, run.state));
  const VtuGrid grid = read_vtu(folder / "a.vtu");
  const Index corner = run.model.contact_nodes[0];
  REQUIRE(run.model.rest[corner] == Vec2{-0.02, 0});
  const SpringState& floor = run.state.contacts[0];
  const SpringState& wall = run.state.contacts[run.model.contact_nodes.size()];
  REQUIRE(floor.penetration > wall.penetration);
  REQUIRE(wall.penetration > 0);
  CHECK(values_of<std::int32_t>(grid.point_fields, "contact_partner")[corner] == 1);
  CHECK(values_of<float>(grid.point_fields, "contact_penetration_m")[corner] == static_cast<float>(floor.penetration));
  const Vec2 force = floor.normal_force + floor.friction_force + wall.normal_force + wall.friction_force;
  CHECK(values_of<float>(grid.point_fields, "contact_force_N")[3 * corner] == doctest::Approx(force.x));
  CHECK(values_of<float>(grid.point_fields, "contact_force_N")[3 * corner + 1] == doctest::Approx(force.y));
}

TEST_CASE("each of several bodies has its number, and elements come without padding") {
  const Scratch folder;
  Case input = falling_block();
  input.output.fields_at = {0};
  input.bodies.push_back(input.bodies[0]);
  input.bodies[1].name = "other";
  std::get<RectangleMesh>(input.bodies[1].mesh) = {.size = {0.01, 0.01}, .at = {0.1, 0}, .element_size = 0.01};
  WatchedRun run(input);
  write_vtu(folder / "a.vtu", body_frame(run.model, run.state));
  const VtuGrid grid = read_vtu(folder / "a.vtu");
  const auto& body = values_of<std::int32_t>(grid.cell_fields, "body");
  CHECK(body.size() == 64 + 2);
  CHECK(std::ranges::count(body, 1) == 2);
  CHECK(std::ranges::count(values_of<std::int32_t>(grid.point_fields, "body"), 1) == 4);
  CHECK(body[63] == 0);
  CHECK(body[64] == 1);
  for (std::size_t c = 0; c < 3; ++c) {
    const Body& other = run.model.bodies[1];
    CHECK(grid.corners[3 * 64 + c] == static_cast<std::int32_t>(run.model.corners[other.element_begin][c]));
  }
}

TEST_CASE("obstacles are drawn where they stand, moving ones too") {
  Case input = falling_block();
  input.run.end_time = 10e-6;
  input.obstacles = {
      {.name = "fixed", .shape = Polygon{{{-0.01, -0.02}, {0.01, -0.02}, {0, -0.01}}}},
      {.name = "moves", .shape = Rectangle{.at = {0.03, 0}, .size = {0.01, 0.01}}, .velocity = {-100, 20}}};
  WatchedRun run(input);
  run.run([] {});
  const VtuGrid grid = obstacle_grid(run.model, run.state);
  REQUIRE(grid.ends.size() == 2);
  CHECK(grid.ends[0] == 3);
  CHECK(grid.ends[1] == 7);
  CHECK(grid.kinds == std::vector<std::uint8_t>(2, static_cast<std::uint8_t>(VtuCell::polygon)));
  Box box;
  for (std::size_t k = 3; k < 7; ++k) box.include(grid.points[k]);
  CHECK(box.low.x == doctest::Approx(0.03 - 1e-3).epsilon(1e-12));
  CHECK(box.low.y == doctest::Approx(2e-4).epsilon(1e-12));
  CHECK(box.high.x == doctest::Approx(0.04 - 1e-3).epsilon(1e-12));
}

TEST_CASE("of an endless obstacle a strip is drawn, on its own side") {
  Case input = falling_block();
  for (const Vec2 normal : {Vec2{0, 1}, Vec2{0, -1}, Vec2{1, 0}, Vec2{3, 4}}) {
    CAPTURE(normal.x);
    CAPTURE(normal.y);
    // A hair away from the nearest node of the block.
    const Model probe = build_model(falling_block());
    double nearest = std::numeric_limits<double>::infinity();
    for (Index i = 0; i < probe.node_count; ++i) nearest = std::min(nearest, dot(probe.rest[i], normal));
    const Vec2 point = ((nearest - 1e-6) / dot(normal, normal)) * normal;
    input.obstacles[0].shape = HalfPlane{.point = point, .normal = normal};
    input.obstacles[0].stiffness = 1;
    const WatchedRun run(input);
    const auto outlines = obstacle_outlines(run.model, run.state);
    REQUIRE(outlines.size() == 1);
    REQUIRE(outlines[0].size() == 4);
    double deepest = 0;
    for (const Vec2 p : outlines[0]) {
      const double height = dot(p - point, normal) / length(normal);
      CHECK(height <= 1e-12);
      deepest = std::min(deepest, height);
    }
    CHECK(deepest < -1e-3);
  }
}

}  // namespace udar

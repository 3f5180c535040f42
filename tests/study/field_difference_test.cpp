#include "udar/study/field_difference.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/results/scratch.hpp"
#include "tests/study/meshes.hpp"
#include "udar/mesh/rectangle.hpp"
#include "udar/results/pvd.hpp"
#include "udar/results/run_folder.hpp"

using namespace udar;

namespace {

/// A body of a run that is made up: fields are functions of the undeformed place and of time.
struct MadeBody {
  std::string name;
  Mesh mesh;
  bool rigid = false;
  double strain = 1;  ///< plastic strain is this times x
};

/// The second half of the plate flows, or what is beyond `flows_from`.
struct MadeRun {
  std::vector<MadeBody> bodies;
  std::vector<double> times{0, 1e-3};
  double flows_from = 1;  ///< m
  double step = 1e-6;     ///< s; 0: the run left no summary
  double flight = 50;     ///< m/s, to the right
  bool has_displacement = true;

  /// Bodies fly and grow with time.
  [[nodiscard]] Vec2 displacement(Vec2 p, double time) const { return time * (Vec2{flight, 0} + 10 * p); }

  VtuGrid grid(double time) const {
    std::vector<Vec2> places, displacements, velocities;
    std::vector<std::array<std::int32_t, 3>> triangles;
    std::vector<double> strains;
    std::vector<std::uint8_t> flags;
    std::vector<std::int32_t> numbers;
    std::int32_t body_number = 0;
    for (const MadeBody& body : bodies) {
      const auto first = static_cast<std::int32_t>(places.size());
      for (const Vec2 p : body.mesh.nodes) {
        displacements.push_back(displacement(p, time));
        places.push_back(p + displacements.back());
        velocities.push_back({p.x, -p.y});
      }
      for (const auto& t : body.mesh.triangles) {
        auto& corners = triangles.emplace_back();
        for (std::size_t c = 0; c < 3; ++c) corners[c] = first + static_cast<std::int32_t>(t[c]);
        const Vec2 middle = 1.0 / 3 * (body.mesh.nodes[t[0]] + body.mesh.nodes[t[1]] + body.mesh.nodes[t[2]]);
        strains.push_back(body.strain * middle.x);
        flags.push_back(middle.x > flows_from ? 1 : 0);
        numbers.push_back(body_number);
      }
      ++body_number;
    }
    VtuGrid grid = triangle_grid(time, places, triangles);
    if (has_displacement) grid.point_fields.push_back(vector_field("displacement", "m", displacements));
    grid.point_fields.push_back(vector_field("velocity", "m/s", velocities));
    grid.point_fields.push_back(vector_field("contact_force", "N", velocities));
    grid.point_fields.push_back(number_field("node_number", std::vector<std::int32_t>(places.size())));
    grid.cell_fields.push_back(scalar_field("plastic_strain", "", strains));
    grid.cell_fields.push_back(scalar_field("stress_x", "Pa", strains));
    grid.cell_fields.push_back(flag_field("flows_now", flags));
    grid.cell_fields.push_back(number_field("element_number", std::vector<std::int32_t>(triangles.size())));
    grid.cell_fields.push_back(number_field("body", numbers));
    return grid;
  }

  RunFrames write(const std::filesystem::path& folder) const {
    const RunFolder run = create_run_folder(folder, false);
    PvdIndex index(run / RunFolder::fields_index);
    int number = 0;
    for (const double time : times) {
      const std::string file = RunFolder::frame_name("bodies", number++);
      write_vtu(run / file, grid(time));
      index.add({{time, 0, file}});
    }
    index.write();
    Summary summary;
    summary.time_step.max = step;
    for (const MadeBody& body : bodies) summary.bodies.push_back({body.name, body.rigid, 0, 0});
    if (step > 0) write_summary(run / RunFolder::summary, summary);
    return RunFrames(folder);
  }
};

Mesh plate(int n, Vec2 at = {0, 0}) {
  return RectangleMesh{.size = {2, 1}, .at = at, .element_size = 1.0 / n, .diagonals = RectangleMesh::Diagonals::right}
      .generate();
}

const FieldDifference& named(const std::vector<FieldDifference>& all, const std::string& name) {
  const auto at = std::find_if(all.begin(), all.end(), [&](const FieldDifference& d) { return d.name == name; });
  REQUIRE(at != all.end());
  return *at;
}

}  // namespace

TEST_CASE("fields of two runs: which ones, their units, and differences in closed form") {
  const Scratch scratch;
  const RunFrames coarse = MadeRun{.bodies = {{.name = "plate", .mesh = plate(4)}}}.write(scratch / "coarse");
  const RunFrames fine = MadeRun{.bodies = {{.name = "plate", .mesh = plate(8)}}}.write(scratch / "fine");
  const std::vector<FieldDifference> all = field_differences(coarse, fine, 1e-3);
  std::vector<std::string> names;
  for (const FieldDifference& d : all) names.push_back(d.name + " [" + d.unit + "]");
  CHECK(names == std::vector<std::string>{"displacement [m]", "velocity [m/s]", "plastic_strain []", "stress_x [Pa]",
                                          "flows_now []"});
  const double h = 0.25;
  const FieldDifference& strain = named(all, "plastic_strain");
  CHECK(strain.time == 1e-3);
  CHECK(strain.apart == 0);
  CHECK(strain.l2 == doctest::Approx(h / std::sqrt(24)).epsilon(1e-6));
  CHECK(strain.max == doctest::Approx(h / 3).epsilon(1e-6));
  // Of x at the centroids of cells of size k = h / 2: int x^2 / A = 4 / 3, less k^2 / 18 in each triangle.
  CHECK(strain.size == doctest::Approx(std::sqrt(4.0 / 3 - h * h / 4 / 18)).epsilon(1e-6));
  CHECK(strain.largest == doctest::Approx(2 - h / 6).epsilon(1e-6));
  CHECK(strain.outside == 0);
  // Linear fields are the same but for their 32 bits.
  CHECK(named(all, "velocity").l2 < 2e-7);
  CHECK(named(all, "velocity").size == doctest::Approx(std::sqrt(4.0 / 3 + 1.0 / 3)).epsilon(1e-6));
  CHECK(named(all, "displacement").max < 1e-8);
  CHECK(named(all, "flows_now").l2 == 0);
}

TEST_CASE("places are compared as they were before the run, also where no frame is left of its beginning") {
  const Scratch scratch;
  const MadeRun coarse{.bodies = {{"plate", plate(4)}}, .times = {1e-3}, .flight = -700};
  const MadeRun fine{.bodies = {{"plate", plate(8)}}, .times = {1e-3}, .flight = 3000};
  const std::vector<FieldDifference> all =
      field_differences(coarse.write(scratch / "a"), fine.write(scratch / "b"), 1e-3);
  CHECK(named(all, "plastic_strain").l2 == doctest::Approx(0.25 / std::sqrt(24)).epsilon(1e-5));
  CHECK(named(all, "plastic_strain").outside == 0);
  CHECK(named(all, "velocity").max < 2e-6);  // places are known to 3 m * 2^-24
  CHECK(named(all, "displacement").l2 == doctest::Approx(3.7).epsilon(1e-6));
}

TEST_CASE("flags: the square of the norm is the part of the area that differs") {
  const Scratch scratch;
  const RunFrames a = MadeRun{.bodies = {{"plate", plate(4)}}, .flows_from = 1}.write(scratch / "a");
  const RunFrames b = MadeRun{.bodies = {{"plate", plate(8)}}, .flows_from = 1.25}.write(scratch / "b");
  const FieldDifference flows = named(field_differences(a, b, 0), "flows_now");
  CHECK(flows.l2 * flows.l2 == doctest::Approx(0.125).epsilon(1e-12));      // a strip of 0.25 m of 2 m
  CHECK(flows.size * flows.size == doctest::Approx(0.375).epsilon(1e-12));  // 0.75 m
  CHECK(flows.max == 1);
}

TEST_CASE("a run against itself: no difference at all, at every time, by one comparison") {
  const Scratch scratch;
  const MadeRun made{.bodies = {{"plate", plate(5)}, {"other", plate(3, {5, 0})}}, .times = {0, 1e-3, 2e-3}};
  const FieldComparison comparison(made.write(scratch / "a"), made.write(scratch / "b"));
  for (const double time : made.times) {
    for (const FieldDifference& d : comparison.at(time)) {
      CHECK(d.time == time);
      CHECK(d.l2 == 0);
      CHECK(d.max == 0);
      CHECK(d.outside == 0);
    }
  }
}

TEST_CASE("bodies that lie over one another are searched each by itself, and are known by their names") {
  const Scratch scratch;
  // Strains differ ten times: a triangle of the other body would be seen.
  const MadeBody one{.name = "one", .mesh = plate(4), .rigid = false, .strain = 1};
  const MadeBody ten{.name = "ten", .mesh = plate(4, {0.1, 0.1}), .rigid = false, .strain = 10};
  MadeBody fine_one = one;
  MadeBody fine_ten = ten;
  fine_one.mesh = plate(8);
  fine_ten.mesh = plate(8, {0.1, 0.1});
  const RunFrames coarse = MadeRun{.bodies = {one, ten}}.write(scratch / "coarse");
  const RunFrames fine = MadeRun{.bodies = {fine_ten, fine_one}}.write(scratch / "fine");
  const FieldDifference strain = named(field_differences(coarse, fine, 1e-3), "plastic_strain");
  const double h = 0.25;
  CHECK(strain.l2 == doctest::Approx(h / std::sqrt(24) * std::sqrt((1.0 + 100.0) / 2)).epsilon(1e-6));
  CHECK(strain.max == doctest::Approx(10 * h / 3).epsilon(1e-6));
}

TEST_CASE("runs without a summary: bodies go by their numbers") {
  const Scratch scratch;
  const MadeRun coarse{.bodies = {{"", plate(4)}, {"", plate(2, {3, 0})}}, .step = 0};
  const MadeRun fine{.bodies = {{"b", plate(8)}, {"a", plate(4, {3, 0})}}};
  CHECK(field_differences(coarse.write(scratch / "a"), fine.write(scratch / "b"), 1e-3).size() == 5);
}

TEST_CASE("rigid bodies: their motion counts, their stress does not") {
  const Scratch scratch;
  const MadeBody soft{.name = "soft", .mesh = plate(4)};
  MadeBody stiff{.name = "stiff", .mesh = plate(2, {4, 0}), .rigid = true, .strain = 1e6};
  const RunFrames a = MadeRun{.bodies = {soft, stiff}}.write(scratch / "a");
  MadeBody fine_soft = soft;
  fine_soft.mesh = plate(8);
  const RunFrames b = MadeRun{.bodies = {fine_soft, stiff}}.write(scratch / "b");
  const std::vector<FieldDifference> all = field_differences(a, b, 1e-3);
  CHECK(named(all, "stress_x").l2 == doctest::Approx(0.25 / std::sqrt(24)).epsilon(1e-6));
  // x^2 + y^2 over plates from 0 to 2 and from 4 to 6
  CHECK(named(all, "velocity").size == doctest::Approx(std::sqrt(0.5 * (4.0 / 3 + 76.0 / 3) + 1.0 / 3)).epsilon(1e-6));
  const MadeRun only{.bodies = {stiff}};
  const std::vector<FieldDifference> motion =
      field_differences(only.write(scratch / "c"), only.write(scratch / "d"), 0);
  CHECK(motion.size() == 2);
}

TEST_CASE("frames stand at the first step after their time: a step apart is near enough, more is not") {
  const Scratch scratch;
  const std::vector<MadeBody> bodies{{"plate", plate(2)}};
  const RunFrames slow = MadeRun{.bodies = bodies, .times = {0, 0.5009e-3, 1e-3}, .step = 1e-6}.write(scratch / "slow");
  const RunFrames fast = MadeRun{.bodies = bodies, .times = {0, 0.5e-3, 1e-3}, .step = 1e-7}.write(scratch / "fast");
  const FieldDifference moved = named(field_differences(slow, fast, 0.5e-3), "displacement");
  CHECK(moved.time == 0.5e-3);
  CHECK(moved.apart == doctest::Approx(0.9e-6).epsilon(1e-6));
  CHECK(moved.max == doctest::Approx(0.9e-6 * length(Vec2{50, 0} + 10 * Vec2{2, 0.75})).epsilon(1e-3));
  CHECK(field_differences(fast, slow, 0.5009e-3).front().apart < 0);

  const auto refused = [&](const RunFrames& a, const RunFrames& b, double time) {
    return message_of<UserError>([&] { field_differences(a, b, time); });
  };
  const std::string far = refused(slow, fast, 0.6e-3);
  CHECK(contains(far, "slow` has no frame at 600 us; the nearest one is at 500.9 us"));
  CHECK(contains(far, "output.fields_at='[\"0.0006 s\"]'"));
  CHECK(contains(refused(slow, fast, std::nan("")), "has no frame at"));
  // A killed run does not tell its step: a hundredth of the way to the next frame, 4.95 us.
  const RunFrames killed = MadeRun{.bodies = bodies, .times = {0, 0.505e-3, 1e-3}, .step = 0}.write(scratch / "killed");
  CHECK(contains(refused(killed, fast, 0.5e-3), "killed` has no frame"));
  CHECK(refused(killed, slow, 0.503e-3) == "");
  // Both near to the time, not to each other.
  const RunFrames early =
      MadeRun{.bodies = bodies, .times = {0, 0.4992e-3, 1e-3}, .step = 1e-6}.write(scratch / "early");
  CHECK(contains(refused(early, slow, 0.5e-3), "more than a step apart"));
}

TEST_CASE("runs that cannot be compared are refused with the reason and a cure") {
  const Scratch scratch;
  const std::vector<MadeBody> one{{"plate", plate(2)}};
  const RunFrames a = MadeRun{.bodies = one}.write(scratch / "a");
  const auto refused = [&](const std::string& name, const MadeRun& made) {
    const RunFrames b = made.write(scratch / name);
    return message_of<UserError>([&] { FieldComparison(a, b); });
  };
  const std::string more = refused("b", {.bodies = {{"plate", plate(2)}, {"ball", plate(1)}}});
  CHECK(contains(more, "a` has no body `ball`, which the run `"));
  CHECK(contains(more, "compare runs of one case"));
  CHECK(contains(refused("c", {.bodies = {{"slab", plate(2)}}}), "c` has no body `plate`"));
  CHECK(contains(refused("d", {.bodies = {{"plate", plate(2, {0.3, 0})}}}), "another shape or place"));

  MadeRun bare{.bodies = one};
  bare.has_displacement = false;
  const RunFrames old = bare.write(scratch / "old");
  CHECK(contains(message_of<OutputError>([&] { FieldComparison(a, old); }), "no field `displacement_m`"));
}

TEST_CASE("a run whose mesh changes on the way is damaged") {
  const Scratch scratch;
  const MadeRun made{.bodies = {{"plate", plate(2)}}};
  const RunFrames a = made.write(scratch / "a");
  const RunFrames b = made.write(scratch / "b");
  write_vtu(scratch / "b" / RunFolder::frame_name("bodies", 1), MadeRun{.bodies = {{"plate", plate(3)}}}.grid(1e-3));
  const FieldComparison comparison(a, b);
  CHECK(comparison.at(0).size() == 5);
  CHECK(contains(message_of<OutputError>([&] { (void)comparison.at(1e-3); }), "another mesh"));
}

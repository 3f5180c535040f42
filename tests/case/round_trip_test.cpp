#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <random>

#include "tests/case/example.hpp"

namespace udar {
namespace {

/// Cases with every member somewhere in its range, and numbers with all their digits.
class RandomCase {
 public:
  explicit RandomCase(std::uint64_t seed) : random_(seed) {}

  Case make() {
    Case c;
    c.run = {.end_time = positive(),
             .integrator = static_cast<Integrator>(below(4)),
             .time_step = maybe(positive()),
             .step_safety = fraction(),
             .when_unstable = static_cast<WhenUnstable>(below(3)),
             .stop_at_energy_error = positive(),
             .gravity = vector(),
             .damping = {positive(), static_cast<MassDamping::Against>(below(2)), positive_table()}};
    if (c.run.integrator == Integrator::adams2) {
      c.run.time_step = positive();
      c.run.when_unstable = WhenUnstable::carry_on;
    }
    c.contact = {fraction(), positive(), maybe(positive())};
    c.contact_pairs = {{"a", "b", static_cast<ContactPairCase::Touch>(below(3)), maybe(positive()), maybe(positive())},
                       {.body = "b", .other = "b"}};
    for (const char* name : {"steel", "0-soft_one"}) {
      const Law law = below(2) == 0 ? Law(Elastic{positive(), 0.5 * fraction() - 0.01})
                                    : Law(Tresca{positive(), -fraction() * 0.9, positive()});
      c.materials.push_back({name, positive(), law});
    }
    for (const char* name : {"b", "a"}) c.bodies.push_back(body(name));
    c.bodies.push_back(body("hammer"));
    c.bodies.back().rigid = true;
    c.bodies.back().cosine_mode = {};
    c.obstacles = {obstacle("one", HalfPlane{vector(), {positive(), any()}}),
                   obstacle("two", Rectangle{vector(), {positive(), positive()}}),
                   obstacle("three", Polygon{triangle()}), obstacle("four", Circle{vector(), positive()})};
    c.supports = {{.name = "s", .nodes = selection(), .move_x = table(), .move_y = TimeTable::constant(any())},
                  {.name = "t", .nodes = selection(), .turn = table(), .turn_about = vector()}};
    const Selection edges{.body = "a", .line = {vector(), vector()}};
    c.loads = {{.name = "f", .kind = LoadCase::Kind::force, .where = selection(), .value = vector(), .factor = table()},
               {.name = "g", .kind = LoadCase::Kind::traction, .where = edges, .value = vector()},
               {.name = "h", .kind = LoadCase::Kind::pressure, .where = edges, .pressure = any()}};
    c.observed_nodes = {{"n", "a", vector(), window()}, {"N", "b", vector(), window()}};
    c.observed_elements = {{"e", "a", vector(), window()}};
    c.observed_regions = {{"r", "b", triangle(), window()}};
    c.output = {maybe(positive()), {0, positive(), positive()}, maybe(positive()), false};
    return c;
  }

 private:
  std::uint64_t below(std::uint64_t n) { return random_() % n; }
  double fraction() { return static_cast<double>(1 + below(1ULL << 53)) / static_cast<double>(1ULL << 53); }
  double positive() { return fraction() * std::pow(10.0, static_cast<double>(below(24)) - 12); }
  double any() { return below(10) == 0 ? (below(2) == 0 ? 0.0 : -0.0) : (below(2) == 0 ? -1 : 1) * positive(); }
  Vec2 vector() { return {any(), any()}; }
  std::optional<double> maybe(double value) { return below(2) == 0 ? std::optional<double>() : value; }
  TimeTable table() {
    if (below(4) == 0) return TimeTable::constant(any());
    const double begin = any();
    return {{begin, begin + std::fabs(begin) + positive(), 1e13},
            {any(), any(), any()},
            static_cast<TimeTable::Shape>(below(2))};
  }
  TimeTable positive_table() {
    return below(2) == 0 ? TimeTable::constant(positive()) : TimeTable{{0, 1}, {positive(), 0}};
  }
  std::vector<Vec2> triangle() {
    const double size = positive();
    return {{-0.0, 0}, {size * (1 + fraction()), -size * fraction()}, {size * fraction(), size / 3}};
  }
  Window window() { return below(2) == 0 ? Window{any()} : Window{-positive(), positive()}; }

  BodyCase body(const char* name) {
    const double size = positive();
    const MeshShape meshes[] = {
        RectangleMesh{
            {3 * size, 4 * size}, vector(), fraction(), size, static_cast<RectangleMesh::Diagonals>(below(4))},
        DiscMesh{3 * size, vector(), -fraction(), size}, RingMesh{5 * size, 3 * size, vector(), 0, size}};
    BodyCase b{.name = name,
               .material = "steel",
               .thickness = positive(),
               .velocity = vector(),
               .spin = any(),
               .mesh = meshes[below(3)]};
    if (below(2) == 0) {
      const auto grade = [&](auto& mesh) {
        mesh.finest_size = mesh.element_size * fraction();
        mesh.finest_side = mesh.side_names.back();
        mesh.finest_within = mesh.element_size;
      };
      std::visit(grade, b.mesh);
    }
    if (below(2) == 0) b.cosine_mode = CosineMode{vector(), vector()};
    return b;
  }
  ObstacleCase obstacle(const char* name, const Shape& shape) {
    return {name, shape, positive(), maybe(positive()), maybe(positive()), vector(), below(2) == 1};
  }
  Selection selection() {
    Selection s{.body = "a"};
    switch (below(4)) {
      case 0:
        s.side = "left";
        break;
      case 1:
        s.box = {vector(), vector()};
        break;
      case 2:
        s.line = {{0, 0}, {positive(), any()}};
        break;
      default:
        s.point = vector();
    }
    return s;
  }

  std::mt19937_64 random_;
};

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

TEST_CASE("any case reads back from its own text, bit for bit") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Case c = RandomCase(seed).make();
    const std::string text = to_toml(c);
    CAPTURE(seed);
    CAPTURE(text);
    Case back;
    try {
      back = read_case(text, "resolved.toml");
    } catch (const UserError& error) {
      FAIL(std::string(error.what()));
    }
    // The shortest text of a double is that of no other one, and the text names every member.
    REQUIRE(to_toml(back) == text);
    REQUIRE(bits(back.run.gravity.x) == bits(c.run.gravity.x));
    REQUIRE(bits(back.materials[1].density) == bits(c.materials[1].density));
    REQUIRE(bits(back.bodies[0].spin) == bits(c.bodies[0].spin));
    REQUIRE(bits(back.loads[2].pressure) == bits(c.loads[2].pressure));
    REQUIRE(back.supports[0].move_x->times == c.supports[0].move_x->times);
    REQUIRE(back.supports[1].turn->values == c.supports[1].turn->values);
    REQUIRE(back.observed_nodes[0].window.end == c.observed_nodes[0].window.end);
    REQUIRE(back.materials[0].law.index() == c.materials[0].law.index());
    REQUIRE(back.bodies[1].mesh.index() == c.bodies[1].mesh.index());
  }
}

TEST_CASE("the resolved short beam holds every default") {
  const std::string text = to_toml(read_case(short_beam, "short-beam.toml"));
  for (const char* line : {"step_safety = 0.9\n", "when_unstable = \"shorten\"\n", "tangential_stiffness = \"auto\"\n",
                           "histories_every = \"auto\"\n", "window = [\"0 s\", \"end\"]\n", "spin = \"0 rad/s\"\n"}) {
    INFO(line);
    CHECK(text.find(line) != std::string::npos);
  }
}

}  // namespace
}  // namespace udar

#include "udar/mesh/generators.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "udar/base/error.hpp"
#include "udar/mesh/boundary.hpp"

using namespace udar;
using Diagonals = RectangleMesh::Diagonals;

namespace {

constexpr double pi = 3.141592653589793;

double total_area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) sum += 0.5 * twice_area(mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]);
  return sum;
}

/// Smallest and largest angle of all triangles, degrees.
std::pair<double, double> angle_range(const Mesh& mesh) {
  double low = 180;
  double high = 0;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec2 u = mesh.nodes[t[(k + 1) % 3]] - mesh.nodes[t[k]];
      const Vec2 v = mesh.nodes[t[(k + 2) % 3]] - mesh.nodes[t[k]];
      const double angle = std::atan2(cross(u, v), dot(u, v)) * 180 / pi;
      low = std::min(low, angle);
      high = std::max(high, angle);
    }
  }
  return {low, high};
}

/// Every named side lies on the boundary, and together they are all of it.
void check_sides(const Mesh& mesh) {
  std::set<std::pair<Index, Index>> boundary;
  for (const Edge e : boundary_edges(mesh)) boundary.insert({e.a, e.b});
  std::size_t named = 0;
  for (const NamedEdges& side : mesh.sides) {
    named += side.edges.size();
    for (const Edge e : side.edges) CHECK(boundary.count({e.a, e.b}) == 1);
  }
  CHECK(named == boundary.size());
}

}  // namespace

TEST_CASE("a rectangle has the documented numbering") {
  const Mesh mesh = generate(
      RectangleMesh{.size = {0.03, 0.02}, .at = {1, 2}, .element_size = 0.01, .diagonals = Diagonals::alternating});
  check_mesh(mesh);
  check_sides(mesh);
  REQUIRE(mesh.nodes.size() == 12);
  REQUIRE(mesh.triangles.size() == 12);
  CHECK(mesh.nodes[0] == Vec2{1, 2});
  CHECK(mesh.nodes[3] == Vec2{1.03, 2});
  CHECK(mesh.nodes[11] == Vec2{1.03, 2.02});
  CHECK(mesh.triangles[0] == std::array<Index, 3>{0, 1, 5});  // cell (0, 0): lower left to upper right, lower one first
  CHECK(mesh.triangles[1] == std::array<Index, 3>{0, 5, 4});
  CHECK(mesh.triangles[2] == std::array<Index, 3>{1, 2, 5});  // cell (1, 0): the other way
  CHECK(mesh.triangles[3] == std::array<Index, 3>{2, 6, 5});
  CHECK(mesh.triangles[6] == std::array<Index, 3>{4, 5, 8});  // cell (0, 1)
  CHECK(mesh.node_numbers.back() == 11);
  CHECK(mesh.triangle_numbers.back() == 11);
  REQUIRE(mesh.sides.size() == 4);
  CHECK(mesh.sides[0].name == "bottom");
  CHECK(mesh.sides[0].edges.front() == Edge{0, 1});
  CHECK(mesh.sides[3].name == "left");
  CHECK(mesh.sides[3].edges.back() == Edge{4, 0});
}

TEST_CASE("rectangles of all cuts fill their area with right triangles") {
  for (const Diagonals cut : {Diagonals::right, Diagonals::left, Diagonals::alternating, Diagonals::crossed}) {
    const Mesh mesh = generate(RectangleMesh{.size = {0.4, 0.1}, .element_size = 0.01, .diagonals = cut});
    check_mesh(mesh);
    check_sides(mesh);
    CHECK(mesh.triangles.size() == (cut == Diagonals::crossed ? 1600 : 800));
    CHECK(mesh.nodes.size() == (cut == Diagonals::crossed ? 451 + 400 : 451));
    CHECK(total_area(mesh) == doctest::Approx(0.04).epsilon(1e-13));
    const auto [low, high] = angle_range(mesh);
    CHECK(low == doctest::Approx(45));
    CHECK(high == doctest::Approx(90));
  }
}

TEST_CASE("a rectangle about the origin is symmetric to the last bit") {
  const Mesh mesh = generate(RectangleMesh{.size = {0.4, 0.1}, .at = {-0.2, 0}, .element_size = 0.0025});
  for (Index i = 0; i <= 160; ++i) {
    CHECK(mesh.nodes[i].x == -mesh.nodes[160 - i].x);
    CHECK(mesh.nodes[i].y == 0);
  }
}

TEST_CASE("the nearest whole number of cells is taken") {
  const Mesh mesh = generate(RectangleMesh{.size = {1.04, 0.97}, .element_size = 0.1, .diagonals = Diagonals::left});
  CHECK(mesh.triangles.size() == 2 * 10 * 10);
}

TEST_CASE("a turned rectangle keeps its shape") {
  const RectangleMesh flat{.size = {2, 1}, .at = {3, 4}, .element_size = 0.25, .diagonals = Diagonals::crossed};
  RectangleMesh turned = flat;
  turned.turn = 1;
  const Mesh a = generate(flat);
  const Mesh b = generate(turned);
  const Turn turn = turn_by(1);
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    CHECK(length(b.nodes[i] - (flat.at + turn * (a.nodes[i] - flat.at))) < 2e-15);
  }
}

TEST_CASE("a disc is made of good triangles") {
  for (const double size : {1.0, 0.5, 0.1, 0.02}) {
    const Mesh mesh = generate(DiscMesh{.radius = 1, .at = {5, -3}, .turn = 0.3, .element_size = size});
    check_mesh(mesh);
    check_sides(mesh);
    const double rings = std::round(1 / size);
    CHECK(mesh.triangles.size() == 6 * rings * rings);
    CHECK(total_area(mesh) == doctest::Approx(3 * rings * std::sin(pi / 3 / rings)));
    const auto [low, high] = angle_range(mesh);
    CHECK(low > 43);
    CHECK(high < 93);
    for (const Edge e : mesh.sides[0].edges) CHECK(length(mesh.nodes[e.a] - Vec2{5, -3}) == doctest::Approx(1));
  }
}

TEST_CASE("a ring closes with alternating diagonals") {
  const Mesh mesh = generate(RingMesh{.outer_radius = 1, .inner_radius = 0.6, .at = {1, 1}, .element_size = 0.05});
  check_mesh(mesh);
  check_sides(mesh);
  const double around = 0.5 * static_cast<double>(mesh.triangles.size()) / 8;
  CHECK(std::fmod(around, 2) == 0);
  CHECK(total_area(mesh) == doctest::Approx(0.5 * around * std::sin(2 * pi / around) * (1 - 0.36)));
  CHECK(mesh.sides[0].name == "outer");
  CHECK(mesh.sides[1].name == "inner");
  CHECK(angle_range(mesh).first > 30);
  check_mesh(generate(RingMesh{.outer_radius = 1, .inner_radius = 0.01, .element_size = 0.99}));
}

TEST_CASE("sizes that make no mesh are refused") {
  const double nan = std::nan("");
  const std::vector<MeshShape> wrong{
      RectangleMesh{.size = {1, 1}, .element_size = 3},
      RectangleMesh{.size = {1, 1}, .element_size = 0},
      RectangleMesh{.size = {-1, 1}, .element_size = 0.1},
      RectangleMesh{.size = {1, nan}, .element_size = 0.1},
      RectangleMesh{.size = {1, 1}, .element_size = 1e-6},
      RectangleMesh{.size = {1, 1}, .element_size = 1e-300},
      RectangleMesh{.size = {1, 1}, .at = {nan, 0}, .element_size = 1},
      RectangleMesh{.size = {1, 1}, .turn = nan, .element_size = 1},
      DiscMesh{.radius = 1, .element_size = 2.5},
      DiscMesh{.radius = 1, .element_size = 1e-5},
      RingMesh{.outer_radius = 1, .inner_radius = 1, .element_size = 0.1},
      RingMesh{.outer_radius = 1, .inner_radius = 0, .element_size = 0.1},
      RingMesh{.outer_radius = 1, .inner_radius = nan, .element_size = 0.1},
      RingMesh{.outer_radius = 1, .inner_radius = 0.9, .element_size = 0.3},
  };
  for (const MeshShape& shape : wrong) {
    try {
      generate(shape);
      FAIL("accepted");
    } catch (const UserError& error) {
      CHECK(error.code == ExitCode::bad_mesh);
    }
  }
}

TEST_CASE("a generator's choice can be set and read by its word") {
  for (const Parameter<RectangleMesh>& parameter : RectangleMesh::parameters()) {
    if (parameter.name != "diagonals") continue;
    const auto& choice = std::get<Choice<RectangleMesh>>(parameter.member);
    RectangleMesh mesh;
    CHECK(choice.words[static_cast<std::size_t>(choice.get(mesh))] == "alternating");
    choice.set(mesh, 3);
    CHECK(mesh.diagonals == Diagonals::crossed);
    CHECK(choice.words[3] == "crossed");
  }
}

#include "udar/mesh/grading.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "test_meshes.hpp"
#include "udar/base/error.hpp"
#include "udar/mesh/generators.hpp"
#include "udar/mesh/renumber.hpp"
#include "udar/mesh/select.hpp"

using namespace udar;
using Diagonals = RectangleMesh::Diagonals;

namespace {

constexpr double degree = 3.141592653589793 / 180;

double smallest_angle(Vec2 a, Vec2 b, Vec2 c) {
  const auto at = [](Vec2 p, Vec2 q, Vec2 r) { return std::atan2(cross(q - p, r - p), dot(q - p, r - p)); };
  return std::min({at(a, b, c), at(b, c, a), at(c, a, b)});
}

double smallest_angle(const Mesh& mesh) {
  double low = 10;
  for (const auto& [a, b, c] : mesh.triangles) {
    low = std::min(low, smallest_angle(mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]));
  }
  return low;
}

/// Smallest angle of the four shapes that all parts of the triangles have (Mitchell 1989): each itself, its halves upon
/// the base, and a half of a half.
double smallest_angle_of_parts(const Mesh& mesh) {
  double low = 10;
  for (const auto& t : mesh.triangles) {
    const auto [a, b, c] = std::array{mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]]};
    const Vec2 m = 0.5 * (b + c);
    low = std::min({low, smallest_angle(a, b, c), smallest_angle(m, a, b), smallest_angle(m, c, a),
                    smallest_angle(0.5 * (a + b), m, a)});
  }
  return low;
}

double area(const Mesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return 0.5 * twice_area(mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]);
}

double total_area(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sum += area(mesh, t);
  return sum;
}

/// All named sides, end to end, are the boundary.
void check_sides(const Mesh& mesh) {
  std::set<std::pair<Index, Index>> boundary;
  for (const Edge e : boundary_edges(mesh)) boundary.insert({e.a, e.b});
  std::size_t named = 0;
  for (const NamedEdges& side : mesh.sides) {
    named += side.edges.size();
    for (std::size_t k = 0; k < side.edges.size(); ++k) {
      CHECK(boundary.contains({side.edges[k].a, side.edges[k].b}));
      if (k > 0) CHECK(side.edges[k - 1].b == side.edges[k].a);
    }
  }
  CHECK(named == boundary.size());
}

/// Sizes are those that were asked for: `unit` is the area of a triangle of size 1.
void check_sizes(const Mesh& mesh, const Grading& grading, double unit, const DistanceTo& distance) {
  double smallest = 1e300;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double size = std::sqrt(area(mesh, t) / unit);
    double nearest = 1e300;
    for (const Index corner : mesh.triangles[t]) nearest = std::min(nearest, distance(mesh.nodes[corner]));
    const double allowed = *grading.size + (grading.growth - 1) * std::max(0.0, nearest - grading.within);
    CHECK(size <= allowed * (1 + 1e-9));
    smallest = std::min(smallest, size);
  }
  CHECK(smallest == doctest::Approx(*grading.size));  // not halved once too often anywhere
}

}  // namespace

TEST_CASE("a rectangle graded towards a point keeps right isosceles triangles") {
  for (const Diagonals cut : {Diagonals::right, Diagonals::left, Diagonals::alternating, Diagonals::crossed}) {
    const RectangleMesh shape{.size = {0.4, 0.2},
                              .at = {-0.2, 0},
                              .element_size = 0.03,
                              .diagonals = cut,
                              .finest_size = 0.00125,
                              .finest_at = Vec2{0, 0},
                              .finest_within = 0.01};
    const Mesh mesh = generate(shape);  // from cells of 0.02: 16 of 0.00125
    check_mesh(mesh);
    check_sides(mesh);
    CHECK(total_area(mesh) == doctest::Approx(0.08).epsilon(1e-13));
    CHECK(smallest_angle(mesh) > 44.999 * degree);
    check_sizes(mesh, grading_of(shape), cut == Diagonals::crossed ? 0.25 : 0.5, [](Vec2 x) { return length(x); });
    CHECK(mesh.triangles.size() < 8000);  // 102400 if all were of the finest size
    CHECK(nodes_of_side(mesh, "bottom").size() >= 17);
  }
}

TEST_CASE("a rectangle graded towards a side is fine along all of it, turned or not") {
  for (const std::string side : {"bottom", "right", "top", "left"}) {
    RectangleMesh shape{.size = {2, 1}, .at = {5, 6}, .element_size = 0.25, .finest_size = 0.0625, .finest_side = side};
    const Mesh flat = generate(shape);
    check_mesh(flat);
    check_sides(flat);
    CHECK(nodes_of_side(flat, side).size() == (side == "bottom" || side == "top" ? 33 : 17));
    CHECK(smallest_angle(flat) > 44.999 * degree);
    CHECK(total_area(flat) == doctest::Approx(2));
    shape.turn = 0.7;
    CHECK(generate(shape).triangles.size() == flat.triangles.size());
  }
}

TEST_CASE("a graded mesh is symmetric to the last bit where the plain one is") {
  const Mesh mesh = generate(RectangleMesh{.size = {2, 1},
                                           .at = {-1, 0},
                                           .element_size = 0.1,
                                           .diagonals = Diagonals::crossed,
                                           .finest_size = 0.01,
                                           .finest_at = Vec2{0, 0.5}});
  std::set<std::pair<double, double>> places;
  for (const Vec2 p : mesh.nodes) places.insert({p.x, p.y});
  CHECK(places.size() == mesh.nodes.size());
  for (const Vec2 p : mesh.nodes) CHECK(places.contains({-p.x, p.y}));
}

TEST_CASE("a disc graded towards a point of its circle is round there") {
  for (const double size : {0.2, 0.1, 0.05}) {
    const DiscMesh shape{.radius = 1,
                         .at = {0, 1},
                         .turn = -1.5707963267948966,
                         .element_size = size,
                         .finest_size = size / 16,
                         .finest_at = Vec2{0, 0},
                         .finest_within = 0.05};
    const Mesh mesh = generate(shape);
    check_mesh(mesh);
    check_sides(mesh);
    for (const Edge e : mesh.sides[0].edges) CHECK(length(mesh.nodes[e.a] - shape.at) == doctest::Approx(1));
    // The middle of a side s that is put on the circle moves by s^2/8, which changes angles by up to s/4; with all
    // halvings after it s/2.
    DiscMesh unsplit = shape;
    unsplit.finest_size = size;
    const double parts = smallest_angle_of_parts(generate(unsplit));
    CHECK(smallest_angle(mesh) > parts - 0.5 * 1.0472 * size);
    MESSAGE("disc, size " << size << ": " << mesh.triangles.size() << " triangles, smallest angle "
                          << smallest_angle(mesh) / degree << " degrees");
    // Near the point the circle is divided evenly, by pi/3 of the finest size.
    for (const Edge e : mesh.sides[0].edges) {
      if (length(mesh.nodes[e.a]) > 0.05) continue;
      CHECK(length(mesh.nodes[e.b] - mesh.nodes[e.a]) == doctest::Approx(1.0472 * size / 16).epsilon(0.01));
    }
  }
}

TEST_CASE("a ring graded towards its hole is round there") {
  const RingMesh shape{.outer_radius = 1,
                       .inner_radius = 0.5,
                       .element_size = 0.1,
                       .finest_size = 0.025,
                       .finest_side = "inner",
                       .growth = 1.5};
  const Mesh mesh = generate(shape);
  check_mesh(mesh);
  check_sides(mesh);
  CHECK(mesh.sides[1].name == "inner");
  for (const Edge e : mesh.sides[1].edges) CHECK(length(mesh.nodes[e.a]) == doctest::Approx(0.5));
  for (const Edge e : mesh.sides[0].edges) CHECK(length(mesh.nodes[e.a]) == doctest::Approx(1));
  const auto plain = [](double size, std::size_t side) {
    const Mesh m = generate(RingMesh{.outer_radius = 1, .inner_radius = 0.5, .element_size = size});
    return m.sides[side].edges.size();
  };
  CHECK(mesh.sides[0].edges.size() == plain(0.1, 0));
  CHECK(mesh.sides[1].edges.size() == 4 * plain(0.1, 1));
}

TEST_CASE("a graded mesh is swept through like any other") {
  const Mesh mesh = generate(RectangleMesh{
      .size = {4, 1}, .element_size = 0.1, .finest_size = 0.0125, .finest_at = Vec2{2, 0}, .finest_within = 0.1});
  const Mesh swept = renumber(mesh, check_mesh(mesh));
  check_mesh(swept);
  CHECK(swept.triangles.size() == mesh.triangles.size());
  CHECK(nodes_of_side(swept, "bottom").size() == nodes_of_side(mesh, "bottom").size());
}

TEST_CASE("without a finest size nothing is graded") {
  const Mesh plain = generate(DiscMesh{.radius = 1, .element_size = 0.1});
  const Mesh same = generate(DiscMesh{.radius = 1, .element_size = 0.1, .finest_within = 0.3, .growth = 1.5});
  CHECK(plain.nodes == same.nodes);
  CHECK(plain.triangles == same.triangles);
}

TEST_CASE("gradings that make no sense are refused with a cure") {
  const RectangleMesh good{.size = {1, 1}, .element_size = 0.1, .finest_size = 0.01, .finest_side = "top"};
  const auto refused = [](auto shape, const std::string& part) {
    const auto fault = grading_fault(shape);
    REQUIRE(fault);
    CHECK((fault->message + fault->reason).find(part) != std::string::npos);
    CHECK(!fault->cure.empty());
    try {
      generate(shape);
      FAIL("accepted");
    } catch (const UserError& error) {
      CHECK(error.code == ExitCode::bad_mesh);
    }
  };
  CHECK(!grading_fault(good));
  const auto with = [&](auto change) {
    RectangleMesh shape = good;
    change(shape);
    return shape;
  };
  refused(with([](auto& s) { s.finest_size = 0.2; }), "larger than the others");
  refused(with([](auto& s) { s.finest_size = 1e-9; }), "far too small");
  refused(with([](auto& s) { s.finest_size = std::nan(""); }), "above 0");
  refused(with([](auto& s) { s.finest_size.reset(); }), "how fine");
  refused(with([](auto& s) { s.finest_side = ""; }), "where elements are finest is not said");
  refused(with([](auto& s) { s.finest_side = "outer"; }), "no side");
  refused(with([](auto& s) { s.finest_at = Vec2{0.5, 0.5}; }), "finest in two places");
  refused(with([](auto& s) { s.finest_side = "", s.finest_at = Vec2{0.5, 1.5}; }), "outside the body");
  refused(with([](auto& s) { s.finest_side = "", s.finest_at = Vec2{std::nan(""), 0}; }), "outside the body");
  refused(with([](auto& s) { s.finest_within = -1; }), "at least 0");
  refused(with([](auto& s) { s.growth = 1; }), "above 1");
  refused(DiscMesh{.radius = 1, .element_size = 0.1, .finest_size = 0.01, .finest_at = Vec2{1, 1}}, "outside the body");
  const RingMesh hole{
      .outer_radius = 1, .inner_radius = 0.5, .element_size = 0.1, .finest_size = 0.01, .finest_at = Vec2{0, 0}};
  refused(hole, "outside the body");
}

#include "udar/study/projection.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/mesh/test_meshes.hpp"
#include "tests/results/scratch.hpp"
#include "tests/study/meshes.hpp"
#include "udar/mesh/disc.hpp"
#include "udar/mesh/rectangle.hpp"
#include "udar/results/outline.hpp"
#include "udar/study/find_triangle.hpp"

using namespace udar;

namespace {

using Diagonals = RectangleMesh::Diagonals;

/// A plate of 2 m by 1 m, its sides cut into 2 n and n.
Mesh plate(int n, Diagonals diagonals = Diagonals::right) {
  return RectangleMesh{.size = {2, 1}, .element_size = 1.0 / n, .diagonals = diagonals}.generate();
}

double smooth(Vec2 p) { return std::sin(2 * p.x) * std::exp(p.y); }

/// Every triangle tried, the nearest of them by its distance to densely set points of its sides.
double distance_by_trial(const std::vector<TriangleFinder::Corners>& triangles, std::size_t number, Vec2 p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < 3; ++c) {
    for (int k = 0; k <= 1000; ++k) {
      const Vec2 a = triangles[number][c];
      const Vec2 b = triangles[number][(c + 1) % 3];
      least = std::min(least, length(p - (a + 1e-3 * k * (b - a))));
    }
  }
  return least;
}

bool inside_by_trial(const TriangleFinder::Corners& t, Vec2 p) {
  return twice_area(t[0], t[1], p) >= 0 && twice_area(t[1], t[2], p) >= 0 && twice_area(t[2], t[0], p) >= 0;
}

}  // namespace

TEST_CASE("a point is found in the triangle that trying all of them finds, inside and outside") {
  Mesh mesh = shuffled(DiscMesh{.radius = 1, .at = {0.3, -0.2}, .element_size = 0.2}.generate());
  const std::vector<TriangleFinder::Corners> triangles = body_mesh(mesh).corners;
  const TriangleFinder finder(triangles, 0);
  std::mt19937 random(7);
  const auto anywhere = [&] { return 0x1p-30 * static_cast<double>(random()) - 2; };  // -2 to 2
  int inside = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec2 p{anywhere(), anywhere()};
    const TriangleAt at = finder.find(p);
    const auto number = static_cast<std::size_t>(at.triangle);
    const auto first =
        std::find_if(triangles.begin(), triangles.end(), [&](const auto& t) { return inside_by_trial(t, p); });
    REQUIRE(at.outside == (first == triangles.end()));
    if (!at.outside) {
      ++inside;
      REQUIRE(number == static_cast<std::size_t>(first - triangles.begin()));
    } else if (k % 20 == 0) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t t = 0; t < triangles.size(); ++t) least = std::min(least, distance_by_trial(triangles, t, p));
      REQUIRE(distance_by_trial(triangles, number, p) <= least + 1e-9);
    }
    Vec2 back{};
    for (std::size_t c = 0; c < 3; ++c) back += at.weights[c] * triangles[number][c];
    REQUIRE(length(back - p) < 1e-12);
  }
  CHECK(inside > 300);  // the disc has a fifth of the square
  CHECK(inside < 500);
}

TEST_CASE("of triangles that share an edge or a corner the first is found, also where the place is blurred") {
  const std::vector<TriangleFinder::Corners> triangles = body_mesh(plate(4)).corners;
  const TriangleFinder finder(triangles, 1e-6);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec2 corner = triangles[t][0];
    for (const Vec2 off : {Vec2{0, 0}, Vec2{1e-7, -1e-7}, Vec2{-1e-7, 1e-7}, Vec2{-1e-7, -1e-7}}) {
      const TriangleAt at = finder.find(corner + off);
      CHECK_FALSE(at.outside);
      std::size_t first = 0;
      const auto has = [&](std::size_t k) {
        return std::any_of(triangles[k].begin(), triangles[k].end(), [&](Vec2 p) { return p == corner; });
      };
      while (!has(first)) ++first;
      CHECK(static_cast<std::size_t>(at.triangle) == first);
    }
  }
  CHECK(finder.find({-1e-5, 0.5}).outside);
  CHECK(finder.find({-1, -1}).triangle == 0);  // as near to the other one at that corner
}

TEST_CASE("triangles without area are never found, a mesh of them is refused, and so are places that are none") {
  const TriangleFinder::Corners flat{Vec2{0, 0}, Vec2{0.5, 0.5}, Vec2{1, 1}};
  const TriangleFinder::Corners full{Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}};
  const TriangleFinder finder({flat, full}, 1e-9);
  CHECK(finder.find({0.5, 0.5}).triangle == 1);
  CHECK(finder.find({0.2, 0.9}).triangle == 1);
  CHECK_THROWS_AS(TriangleFinder({flat, flat}, 1e-9), OutputError);
  CHECK_THROWS_AS(TriangleFinder({{Vec2{0, 0}, Vec2{1, 0}, Vec2{1, std::nan("")}}}, 1e-9), OutputError);
  CHECK_THROWS_AS(project({}, body_mesh(plate(1)), 1e-9), OutputError);
  CHECK_THROWS_AS(project(body_mesh(plate(1)), {}, 1e-9), OutputError);
}

TEST_CASE("fields of one mesh differ by what they differ, to the last bit") {
  Mesh mesh = plate(7, Diagonals::alternating);
  Mesh moved = mesh;  // as runs with other steps know its places
  std::mt19937 random(3);
  for (Vec2& p : moved.nodes) p += 1e-9 * Vec2{0x1p-32 * static_cast<double>(random()), 0.3};
  const Projection projection = project(body_mesh(mesh), body_mesh(moved), 1e-8);
  const std::vector<double> of_nodes = at_nodes(mesh, smooth);
  const std::vector<double> of_elements = at_centroids(mesh, smooth);
  DifferenceSums sums;
  add_nodes(projection, 1, of_nodes, of_nodes, sums);
  add_elements(projection, of_elements, of_elements, sums);
  CHECK(sums.l2() == 0);
  CHECK(sums.max() == 0);
  CHECK(sums.outside == 0);
  CHECK(sums.largest() > 2);
  // All nodes but one are equal: int (phi_i)^2 dA = A_i / 6 of the triangles round it.
  std::vector<double> other = of_nodes;
  const std::size_t inner = 3 * 15 + 7;
  other[inner] += 3;
  double round = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const bool at = a == inner || b == inner || c == inner;
    if (at) round += 0.5 * twice_area(mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]);
  }
  DifferenceSums one;
  add_nodes(projection, 1, other, of_nodes, one);
  CHECK(one.l2() == doctest::Approx(3 * std::sqrt(round / 6 / 2)).epsilon(1e-7));
  CHECK(one.max() == doctest::Approx(1.5).epsilon(1e-12));  // at a midpoint
}

TEST_CASE("a linear field is the same on meshes that are not nested, also where the finer one sticks out") {
  const auto linear = [](Vec2 p) { return 3 - 2 * p.x + 5 * p.y; };
  for (const Diagonals diagonals : {Diagonals::right, Diagonals::alternating, Diagonals::crossed}) {
    const DifferenceSums sums = node_difference(plate(3), plate(7, diagonals), linear);
    CHECK(sums.max() < 1e-13);
    CHECK(sums.l2() < 1e-13);
    CHECK(sums.outside == 0);
    CHECK(sums.area.value() == doctest::Approx(2).epsilon(1e-14));
    // The mean is 3.5, the variance 4 of x times 2^2 / 12 and 25 of y times 1 / 12; three midpoints are exact for that.
    CHECK(sums.fine_l2() == doctest::Approx(std::sqrt(3.5 * 3.5 + 41.0 / 12)).epsilon(1e-13));
  }
  const Mesh coarse = DiscMesh{.radius = 0.5, .at = {1, 2}, .element_size = 0.25}.generate();
  const Mesh fine = shuffled(DiscMesh{.radius = 0.5, .at = {1, 2}, .element_size = 0.03}.generate());
  const DifferenceSums sums = node_difference(coarse, fine, linear);
  CHECK(sums.max() < 1e-13);
  // Every midpoint tried in every coarse triangle.
  const std::vector<TriangleFinder::Corners> triangles = body_mesh(coarse).corners;
  std::size_t outside = 0;
  for (const auto& [a, b] : mesh_edges(body_mesh(fine).nodes)) {
    const Vec2 middle = 0.5 * (fine.nodes[static_cast<std::size_t>(a)] + fine.nodes[static_cast<std::size_t>(b)]);
    const bool in =
        std::any_of(triangles.begin(), triangles.end(), [&](const auto& t) { return inside_by_trial(t, middle); });
    if (!in) ++outside;
  }
  CHECK(sums.outside == outside);
  CHECK(outside > 30);
}

TEST_CASE("an element field of x, on elements and on their quarters: the difference in closed form") {
  // Of the four quarters one has the centroid of the whole; the others are off by -h/3, h/6 and h/6 in x.
  for (const int n : {2, 8}) {
    const double h = 1.0 / n;
    const DifferenceSums sums = element_difference(plate(n), plate(2 * n), [](Vec2 p) { return p.x; });
    CHECK(sums.l2() == doctest::Approx(h / std::sqrt(24)).epsilon(1e-12));
    CHECK(sums.max() == doctest::Approx(h / 3).epsilon(1e-12));
    CHECK(sums.area.value() == doctest::Approx(2).epsilon(1e-14));
    CHECK(sums.outside == 0);
  }
}

TEST_CASE("a nodal field of x^2, on elements and on their quarters: the difference in closed form") {
  // At the middles of the level and the slanted sides it is q = h^2 / 4, at all other fine nodes 0. The square's
  // integrals over the four quarters are q^2 / 6 times 3, 3, 1 and 1 of their area.
  for (const int n : {2, 8}) {
    const double h = 1.0 / n;
    const DifferenceSums sums = node_difference(plate(n), plate(2 * n), [](Vec2 p) { return p.x * p.x; });
    CHECK(sums.l2() == doctest::Approx(h * h / 4 / std::sqrt(3)).epsilon(1e-12));
    CHECK(sums.max() == doctest::Approx(h * h / 4).epsilon(1e-12));
  }
}

TEST_CASE("a smooth field: differences fall with the first power of the size in elements, the second at nodes") {
  const auto order = [](auto difference, const std::vector<Mesh>& meshes, std::size_t k) {
    return std::log2(difference(meshes[k - 1], meshes[k], smooth).l2() /
                     difference(meshes[k], meshes[k + 1], smooth).l2());
  };
  for (const Diagonals diagonals : {Diagonals::right, Diagonals::alternating}) {
    std::vector<Mesh> meshes;
    for (const int n : {4, 8, 16, 32, 64}) meshes.push_back(plate(n, diagonals));
    for (std::size_t k = 1; k + 1 < meshes.size(); ++k) {
      CHECK(std::fabs(order([](auto&... all) { return element_difference(all...); }, meshes, k) - 1) < 0.1);
      CHECK(std::fabs(order([](auto&... all) { return node_difference(all...); }, meshes, k) - 2) < 0.1);
    }
  }
  std::vector<Mesh> discs;  // not nested, and the finer ones stick out
  for (const double h : {0.2, 0.1, 0.05, 0.025, 0.0125})
    discs.push_back(DiscMesh{.radius = 1, .element_size = h}.generate());
  for (std::size_t k = 1; k + 1 < discs.size(); ++k) {
    CHECK(std::fabs(order([](auto&... all) { return element_difference(all...); }, discs, k) - 1) < 0.1);
    CHECK(std::fabs(order([](auto&... all) { return node_difference(all...); }, discs, k) - 2) < 0.1);
  }
}

TEST_CASE("vectors count by the length of their difference") {
  const Mesh coarse = plate(3);
  const Mesh fine = plate(5);
  const auto constant = [](const Mesh& mesh, std::array<double, 3> value) {
    std::vector<double> values;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) values.insert(values.end(), value.begin(), value.end());
    return values;
  };
  DifferenceSums sums;
  add_nodes(project(body_mesh(coarse), body_mesh(fine), 1e-12), 3, constant(coarse, {4, 1, 0}),
            constant(fine, {1, 5, 0}), sums);
  CHECK(sums.l2() == doctest::Approx(5).epsilon(1e-13));
  CHECK(sums.max() == doctest::Approx(5).epsilon(1e-13));
  CHECK(sums.fine_l2() == doctest::Approx(std::sqrt(26)).epsilon(1e-13));
  CHECK(sums.largest() == doctest::Approx(std::sqrt(26)).epsilon(1e-13));
}

TEST_CASE("a value that is no number makes the norms no number, the largest ones too") {
  DifferenceSums sums;
  sums.add(1, 4, 9, false);
  CHECK(sums.max() == 2);
  CHECK(sums.largest() == 3);
  sums.add(1, std::nan(""), std::nan(""), true);
  sums.add(1, 1, 1, false);
  CHECK(std::isnan(sums.l2()));
  CHECK(std::isnan(sums.max()));
  CHECK(std::isnan(sums.largest()));
  CHECK(sums.outside == 1);
}

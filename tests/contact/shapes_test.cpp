#include "udar/contact/shapes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "udar/base/error.hpp"

using namespace udar;

namespace {

const Polygon stop{.points = {{-3, 0}, {-23, -20}, {23, -20}, {3, 0}}};  // the stop of the short beam, cm
const Polygon sliver{.points = {{0, 0}, {10, 0.1}, {10, 0.2}, {4, 0.3}}};
const Polygon hexagon{.points = {{2, 0}, {1, 1.7}, {-1, 1.7}, {-2, 0}, {-1, -1.7}, {1, -1.7}}};
const std::vector<Shape> shapes{
    HalfPlane{.point = {1, 2}, .normal = {3, -4}}, Rectangle{.at = {-1, -2}, .size = {3, 1}}, stop, sliver, hexagon,
    Circle{.centre = {1, -1}, .radius = 2}};

constexpr Box view{{-40, -40}, {40, 40}};

/// A hundred points in and about the shape, not symmetric to it.
std::vector<Vec2> places(const PreparedShape& shape) {
  std::mt19937 random(7);
  Box box = bounds(shape);
  box = {{std::max(box.low.x, -20.0), std::max(box.low.y, -20.0)},
         {std::min(box.high.x, 20.0), std::min(box.high.y, 20.0)}};
  const Vec2 margin = 0.6 * box.size();
  std::uniform_real_distribution<double> x(box.low.x - margin.x, box.high.x + margin.x);
  std::uniform_real_distribution<double> y(box.low.y - margin.y, box.high.y + margin.y);
  std::vector<Vec2> points(100);
  for (Vec2& p : points) p = {x(random), y(random)};
  return points;
}

/// Distance to the outline by trying points all along it, m; the error is a part in 1e6 of the outline.
double distance_by_trial(const PreparedShape& shape, Vec2 p) {
  double nearest = 1e300;
  for (const Polyline& line : outline(shape, {{-200, -200}, {200, 200}})) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Vec2 a = line[i - 1];
      const Vec2 b = line[i];
      const auto square = [&](double s) { return dot(p - (a + s * (b - a)), p - (a + s * (b - a))); };
      double best = 0;
      for (int k = 0; k <= 200; ++k) best = square(k / 200.0) < square(best) ? k / 200.0 : best;
      for (int k = -200; k <= 200; ++k) {  // once more, finely, about the best
        const double s = std::clamp(best + k / 40000.0, 0.0, 1.0);
        nearest = std::min(nearest, square(s));
      }
    }
  }
  return std::sqrt(nearest);
}

bool inside_by_winding(const PreparedShape& shape, Vec2 p) {
  bool inside = false;
  for (const Polyline& line : outline(shape, view)) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Vec2 a = line[i - 1];
      const Vec2 b = line[i];
      if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
  }
  return inside;
}

void check_refused(const Shape& shape, const char* reason) {
  try {
    prepare(shape);
    FAIL("accepted");
  } catch (const UserError& error) {
    CHECK(error.code == ExitCode::bad_case);
    CHECK(std::string(error.what()).find(reason) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("the gap is the distance to the boundary") {
  for (const Shape& shape : shapes) {
    const PreparedShape ready = prepare(shape);
    const bool round = std::holds_alternative<Circle>(shape);
    for (const Vec2 p : places(ready)) {
      const Gap found = gap(ready, p);
      // The outline of a circle is a polygon of 96 sides, off by up to 2 (1 - cos(pi / 96)).
      CHECK(std::fabs(found.distance) == doctest::Approx(distance_by_trial(ready, p)).epsilon(round ? 2e-3 : 1e-4));
      if (!std::holds_alternative<HalfPlane>(shape) && std::fabs(found.distance) > 2e-3) {
        CHECK((found.distance < 0) == inside_by_winding(ready, p));
      }
    }
  }
}

TEST_CASE("a shape holds the points whose gap is below 0") {
  for (const Shape& shape : shapes) {
    std::visit(
        [&](const auto& prepared) {
          int inside = 0;
          for (const Vec2 p : places(prepared)) {
            CHECK(prepared.holds(p) == (prepared.gap(p).distance < 0));
            inside += prepared.holds(p) ? 1 : 0;
          }
          CHECK(inside > 0);
        },
        prepare(shape));
  }
}

TEST_CASE("the normal is the gradient of the gap") {
  for (const Shape& shape : shapes) {
    const PreparedShape ready = prepare(shape);
    for (const Vec2 p : places(ready)) {
      constexpr double h = 1e-6;
      const Gap here = gap(ready, p);
      if (gap(ready, p + Vec2{h, h}).face != here.face || gap(ready, p - Vec2{h, h}).face != here.face) continue;
      const Vec2 gradient{(gap(ready, p + Vec2{h, 0}).distance - gap(ready, p - Vec2{h, 0}).distance) / (2 * h),
                          (gap(ready, p + Vec2{0, h}).distance - gap(ready, p - Vec2{0, h}).distance) / (2 * h)};
      CHECK(length(here.normal) == doctest::Approx(1).epsilon(1e-14));
      CHECK(length(gradient - here.normal) < 1e-5);
    }
  }
}

TEST_CASE("the foot of a point lies on the boundary") {
  for (const Shape& shape : shapes) {
    const PreparedShape ready = prepare(shape);
    for (const Vec2 p : places(ready)) {
      const Gap found = gap(ready, p);
      CHECK(std::fabs(gap(ready, p - found.distance * found.normal).distance) < 1e-12);
    }
  }
}

TEST_CASE("the inner radius is the depth of the deepest point") {
  CHECK(std::isinf(inner_radius(prepare(shapes[0]))));
  CHECK(inner_radius(prepare(Rectangle{.at = {-1, -2}, .size = {3, 1}})) == doctest::Approx(0.5).epsilon(1e-9));
  CHECK(inner_radius(prepare(Circle{.centre = {1, -1}, .radius = 2})) == 2);
  // Of a triangle: twice the area over the circumference.
  const Polygon triangle{.points = {{0, 0}, {3, 0}, {0, 4}}};
  CHECK(inner_radius(prepare(triangle)) == doctest::Approx(1).epsilon(1e-9));
  for (const Shape& shape : {Shape(stop), Shape(sliver), Shape(hexagon)}) {
    const PreparedShape prepared = prepare(shape);
    const Box box = bounds(prepared);
    double deepest = 0;
    for (int i = 0; i <= 400; ++i) {
      for (int k = 0; k <= 400; ++k) {
        const Vec2 p{box.low.x + i * box.size().x / 400, box.low.y + k * box.size().y / 400};
        deepest = std::max(deepest, -gap(prepared, p).distance);
      }
    }
    CHECK(deepest <= inner_radius(prepared) * (1 + 1e-9));
    // The nearest of the points tried is half a diagonal of their net away.
    CHECK(deepest >= inner_radius(prepared) - 0.5 * length(box.size()) / 400);
  }
}

TEST_CASE("a way from one place outside to another crosses a shape where a point of it is inside") {
  for (const Shape& shape : shapes) {
    const PreparedShape prepared = prepare(shape);
    const auto holds = [&](Vec2 p) { return std::visit([&](const auto& s) { return s.holds(p); }, prepared); };
    std::vector<Vec2> outside = places(prepared);
    std::erase_if(outside, holds);
    for (std::size_t i = 1; i < outside.size(); ++i) {
      const Vec2 from = outside[i - 1];
      const Vec2 to = outside[i];
      double nearest = std::numeric_limits<double>::infinity();
      for (int k = 0; k <= 2000; ++k) {
        nearest = std::min(nearest, gap(prepared, from + (k / 2000.0) * (to - from)).distance);
      }
      const bool crossed = std::visit([&](const auto& s) { return s.is_crossed(from, to); }, prepared);
      if (nearest < 0) CHECK(crossed);
      if (crossed) CHECK(nearest <= 0.5 * length(to - from) / 2000);
    }
  }
}

TEST_CASE("corners given clockwise make the same obstacle") {
  for (const Polygon& polygon : {stop, sliver, hexagon}) {
    Polygon other = polygon;
    std::reverse(other.points.begin(), other.points.end());
    const PreparedShape a = prepare(polygon);
    const PreparedShape b = prepare(other);
    for (const Vec2 p : places(a)) {
      CHECK(gap(a, p).distance == doctest::Approx(gap(b, p).distance).epsilon(1e-13));
      CHECK(length(gap(a, p).normal - gap(b, p).normal) < 1e-13);
    }
  }
}

TEST_CASE("a rectangle is the polygon of its corners") {
  const PreparedShape a = prepare(Rectangle{.at = {-1, -2}, .size = {3, 1}});
  const PreparedShape b = prepare(Polygon{.points = {{-1, -2}, {2, -2}, {2, -1}, {-1, -1}}});
  for (const Vec2 p : places(a)) CHECK(gap(a, p).distance == gap(b, p).distance);
}

TEST_CASE("distance is continuous where the nearest face changes, the normal is not") {
  const PreparedShape ready = prepare(Rectangle{.at = {0, 0}, .size = {2, 1}});
  constexpr double h = 1e-9;
  const Gap below = gap(ready, {0.3, 0.3 - h});
  const Gap above = gap(ready, {0.3 - h, 0.3});
  CHECK(below.face == 0);
  CHECK(above.face == 3);
  CHECK(std::fabs(below.distance - above.distance) < 3 * h);
  CHECK(gap(ready, {0.3, 0.3}).face == 0);  // both as near: the lower one
  // Along any path the distance changes by no more than the way.
  for (double s = 0; s < 1; s += 1e-3) {
    const auto at = [&](double t) { return gap(ready, {-0.5 + 3 * t, 1.4 - 1.7 * t}).distance; };
    CHECK(std::fabs(at(s + 1e-3) - at(s)) <= 1e-3 * std::hypot(3, 1.7) * (1 + 1e-9));
  }
}

TEST_CASE("a point on a corner has a normal") {
  const PreparedShape ready = prepare(stop);
  for (const Vec2 corner : stop.points) {
    const Gap found = gap(ready, corner);
    CHECK(std::fabs(found.distance) < 1e-14);
    CHECK(length(found.normal) == doctest::Approx(1));
  }
  const Gap beyond = gap(ready, {4, 1});  // 45 degrees, between the normals of the two faces
  CHECK(beyond.distance == doctest::Approx(std::sqrt(2)));
  CHECK(length(beyond.normal - std::sqrt(0.5) * Vec2{1, 1}) < 1e-15);
}

TEST_CASE("the centre of a circle has a normal too") {
  const Gap found = gap(prepare(Circle{.centre = {1, 1}, .radius = 3}), {1, 1});
  CHECK(found.distance == -3);
  CHECK(length(found.normal) == 1);
}

TEST_CASE("outlines lie in their bounds; that of a half-plane ends at the view") {
  for (const Shape& shape : shapes) {
    const PreparedShape ready = prepare(shape);
    const auto lines = outline(ready, view);
    REQUIRE(lines.size() == 1);
    for (const Vec2 p : lines[0]) {
      CHECK(bounds(ready).grown(1e-9).holds(p));
      CHECK(view.grown(1e-9).holds(p));
    }
    if (!std::holds_alternative<HalfPlane>(shape)) CHECK(lines[0].front() == lines[0].back());
  }
  const auto level = outline(prepare(HalfPlane{.point = {5, 1}}), view);
  CHECK(level[0] == Polyline{{-40, 1}, {40, 1}});
  CHECK(outline(prepare(HalfPlane{.point = {5, 100}}), view).empty());
  CHECK(outline(prepare(HalfPlane{.point = {100, 5}, .normal = {-1, 0}}), view).empty());
  CHECK(bounds(prepare(HalfPlane{.point = {5, 1}})).high.y == 1);
  CHECK(bounds(prepare(HalfPlane{.point = {5, 1}, .normal = {-2, 0}})).low.x == 5);
}

TEST_CASE("shapes that make no sense are refused") {
  const double nan = std::nan("");
  check_refused(HalfPlane{.normal = {0, 0}}, "direction");
  check_refused(HalfPlane{.normal = {nan, 1}}, "direction");
  check_refused(Circle{.radius = 0}, "radius");
  check_refused(Circle{.centre = {nan, 0}, .radius = 1}, "finite");
  check_refused(Rectangle{.size = {1, -1}}, "above 0");
  check_refused(Rectangle{.at = {nan, 0}, .size = {1, 1}}, "finite");
  check_refused(Polygon{.points = {{0, 0}, {1, 1}}}, "three corners");
  check_refused(Polygon{.points = {{0, 0}, {1, 0}, {1, 0}, {0, 1}}}, "corners 2 and 3");
  check_refused(Polygon{.points = {{0, 0}, {1, 0}, {nan, 1}}}, "finite");
  check_refused(Polygon{.points = {{0, 0}, {4, 0}, {1, 1}, {0, 4}}}, "not convex");
  check_refused(Polygon{.points = {{0, 0}, {1, 1}, {1, 0}, {0, 1}}}, "not convex");  // crossing itself
  check_refused(Polygon{.points = {{0, 1}, {0.6, -0.8}, {-1, 0.3}, {1, 0.3}, {-0.6, -0.8}}}, "not convex");  // a star
  check_refused(Polygon{.points = {{0, 0}, {1, 0}, {2, 0}}}, "no area");
}

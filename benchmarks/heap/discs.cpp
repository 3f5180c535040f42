#include "discs.hpp"

#include <fmt/core.h>

#include <cmath>
#include <cstdint>

#include "udar/mesh/cells.hpp"

namespace udar::heap {
namespace {

/// Numbers from -1 to 1, the same everywhere (Lehmer 1951, with the constants of Park and Miller 1988).
class Scatter {
 public:
  double next() {
    seed_ = seed_ * 48271 % 2147483647;
    return 2 * static_cast<double>(seed_) / 2147483647 - 1;
  }

 private:
  std::uint64_t seed_ = 1;
};

}  // namespace

Case case_of(int discs, Layout layout) {
  constexpr double gap = 1e-5;               // m, between neighbours: closed within some tens of steps
  constexpr double speed = 2;                // m/s
  constexpr double row = 0.866025403784439;  // height of a row over the distance of neighbours
  const int columns = static_cast<int>(std::lround(std::sqrt(discs)));
  const double pitch = layout == Layout::heap ? 2 * radius + gap : 4 * radius;
  Case c{
      .run = {.end_time = 1, .gravity = {0, -9.81}},
      .contact = {.damping = 0.2, .friction = 0.3},
      .materials = {{.name = "plastic", .density = 1200, .law = Elastic{.young_modulus = 1e9, .poisson_ratio = 0.3}}}};
  Scatter scatter;
  for (int n = 0; n < discs; ++n) {
    const int line = n / columns;
    const double x = pitch * (n % columns + 0.5 * (line % 2)) + 0.25 * gap * scatter.next();
    const double y = pitch * row * line + 0.25 * gap * scatter.next();
    const Vec2 velocity{speed * scatter.next(), speed * (scatter.next() - 1)};
    c.bodies.push_back(
        {.name = fmt::format("disc_{}", n + 1),
         .material = "plastic",
         .velocity = velocity,
         .mesh = DiscMesh{.radius = radius, .at = {x, y}, .turn = scatter.next(), .element_size = radius / rings}});
  }
  if (layout != Layout::heap) return c;
  const double side = radius + gap;
  const double width = pitch * (columns - 0.5);
  c.obstacles = {{.name = "bottom", .shape = HalfPlane{.point = {0, -side}, .normal = {0, 1}}, .friction = 0.3},
                 {.name = "left", .shape = HalfPlane{.point = {-side, 0}, .normal = {1, 0}}, .friction = 0.3},
                 {.name = "right", .shape = HalfPlane{.point = {width + side, 0}, .normal = {-1, 0}}, .friction = 0.3}};
  return c;
}

OneBody one_body(int discs) {
  OneBody one;
  one.input = case_of(discs, Layout::apart);
  for (const BodyCase& disc : one.input.bodies) {
    const Mesh part = generate(disc.mesh);
    const auto first = static_cast<Index>(one.mesh.nodes.size());
    one.mesh.nodes.insert(one.mesh.nodes.end(), part.nodes.begin(), part.nodes.end());
    for (const auto& t : part.triangles) one.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  number_as_generated(one.mesh);
  one.input.bodies.resize(1);
  one.input.contact_pairs = {
      {.body = one.input.bodies[0].name, .other = one.input.bodies[0].name, .touch = ContactPairCase::Touch::no}};
  return one;
}

}  // namespace udar::heap

#pragma once

#include "udar/case/case.hpp"

namespace udar {

inline const MaterialCase plastic_steel{
    .name = "steel",
    .density = 7850,
    .law = Tresca{.young_modulus = 196e9, .poisson_ratio = 0.25, .yield_stress = 235e6}};
inline const MaterialCase aluminium{
    .name = "aluminium", .density = 2700, .law = Elastic{.young_modulus = 70e9, .poisson_ratio = 0.33}};

/// A beam that falls on the corner of a polygon off its middle, flows and rubs.
inline Case impact() {
  return {.run = {.end_time = 1, .gravity = {0, -9.81}},
          .materials = {plastic_steel},
          .bodies = {{.name = "beam",
                      .material = "steel",
                      .thickness = 0.01,
                      .velocity = {5, -80},
                      .mesh = RectangleMesh{.size = {0.4, 0.1}, .at = {-0.2, 0}, .element_size = 0.005}}},
          .obstacles = {{.name = "stop",
                         .shape = Polygon{.points = {{-0.0137, 0}, {-0.02, -0.1}, {0.06, -0.1}, {0.0463, 0}}},
                         .friction = 0.35}}};
}

/// A spinning ring with a side that is carried along, under pressure and against damping.
inline Case spinning_ring() {
  const double spin = 300;
  return {.run = {.end_time = 1,
                  .integrator = Integrator::adams,
                  .damping = {.rate = 500, .against = MassDamping::Against::mean_motion}},
          .materials = {aluminium},
          .bodies = {{.name = "ring",
                      .material = "aluminium",
                      .velocity = {3, 0},
                      .spin = spin,
                      .mesh = RingMesh{.outer_radius = 0.2, .inner_radius = 0.1, .element_size = 0.006}}},
          .supports = {{.name = "shaft",
                        .nodes = {.body = "ring", .side = "inner"},
                        .turn = TimeTable{.times = {0, 1}, .values = {0, spin}}}},
          .loads = {{.name = "blast",
                     .kind = LoadCase::Kind::pressure,
                     .where = {.body = "ring", .box = {{0, -0.3}, {0.3, 0.3}}},
                     .pressure = 2e7,
                     .factor = {.times = {0, 2e-5}, .values = {0, 1}, .shape = TimeTable::Shape::smooth}}}};
}

/// A turned plastic block, an elastic disc and a coarse ring meet three obstacles with dashpots, one of which moves.
inline Case crowd() {
  return {
      .run = {.end_time = 1, .gravity = {0, -9.81}},
      .contact = {.damping = 0.2},
      .materials = {plastic_steel, aluminium},
      .bodies = {{.name = "block",
                  .material = "steel",
                  .thickness = 0.02,
                  .velocity = {0, -60},
                  .mesh = RectangleMesh{.size = {0.1, 0.07}, .at = {0, 0.002}, .turn = 0.02, .element_size = 0.003}},
                 {.name = "disc",
                  .material = "aluminium",
                  .velocity = {-30, -40},
                  .spin = 900,
                  .mesh = DiscMesh{.radius = 0.05, .at = {0.171, 0.0505}, .element_size = 0.003}},
                 {.name = "ring",
                  .material = "steel",
                  .velocity = {20, 0},
                  .mesh =
                      RingMesh{.outer_radius = 0.05, .inner_radius = 0.03, .at = {-0.2, 0.1}, .element_size = 0.01}}},
      .obstacles = {{.name = "floor", .shape = HalfPlane{}, .friction = 0.2},
                    {.name = "ball",
                     .shape = Circle{.centre = {-0.3, 0.1}, .radius = 0.0497},
                     .friction = 0.5,
                     .velocity = {60, 0}},
                    {.name = "edge", .shape = Rectangle{.at = {0.11, 0}, .size = {0.01, 0.06}}}}};
}

/// A mesh of many blocks, cut by both diagonals.
inline Case many_blocks() {
  Case input = impact();
  input.bodies[0].mesh = RectangleMesh{
      .size = {0.4, 0.1}, .at = {-0.2, 0}, .element_size = 0.0025, .diagonals = RectangleMesh::Diagonals::crossed};
  return input;
}

}  // namespace udar

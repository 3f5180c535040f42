#pragma once

#include <algorithm>
#include <cmath>

#include "udar/mesh/boundary.hpp"
#include "udar/mesh/generators.hpp"
#include "udar/mesh/neighbours.hpp"
#include "udar/mesh/renumber.hpp"
#include "udar/model/model.hpp"

namespace udar {

/// A model put together by hand, so that the step is tested without the case file: a steel beam of 40 cm x 10 cm that
/// falls on a block off its middle, flows and rubs. A weight hangs on its left side; what `held` names is held.
struct SmallModel {
  double element_size = 0.01;  ///< m
  Integrator integrator = Integrator::central_difference;
  std::string held;        ///< a side of the beam, or nothing
  double end_time = 1e-3;  ///< s
};

inline void add_beam(Model& m, Mesh mesh, const Tresca& law) {
  constexpr double density = 7850;
  const auto nodes = static_cast<Index>(mesh.nodes.size());
  const auto elements = static_cast<Index>(mesh.triangles.size());
  Body body{
      .name = "beam", .law = law, .density = density, .thickness = 0.01, .node_end = nodes, .element_end = elements};
  body.padded_end = (elements + lanes - 1) / lanes * lanes;
  body.boundary = boundary_edges(mesh);
  body.sides = mesh.sides;
  m.node_count = nodes;
  m.element_count = elements;
  m.rest = mesh.nodes;
  m.node_numbers = mesh.node_numbers;
  const MeshBlocks cut = cut_blocks(mesh);
  m.quads = cut.quads;
  m.element_blocks = cut.blocks;
  m.element_numbers = mesh.triangle_numbers;
  m.element_numbers.resize(body.padded_end);
  m.mass.assign(nodes, 0);
  for (const auto& t : mesh.triangles) {
    const double area = 0.5 * twice_area(mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]]);
    m.corners.push_back(t);
    m.area_density.push_back(density * area);
    body.mass += density * area * body.thickness;
    for (const Index corner : t) m.mass[corner] += density * area * body.thickness / 3;
  }
  m.start_velocity.assign(nodes, {5, -80});

  m.rest.insert(m.rest.end(), {{0, 0}, {1, 0}, {0, 1}});
  m.start_velocity.resize(nodes + padding_nodes);
  m.mass.resize(nodes + padding_nodes, 1);
  m.corners.resize(body.padded_end, {nodes, nodes + 1, nodes + 2});
  for (Quad& quad : m.quads) {
    if (quad[0] == none) quad = {nodes, nodes + 1, nodes + 2, nodes};
  }
  m.area_density.resize(body.padded_end, density * 0.5);
  m.contact_spring.resize(body.padded_end);
  for (const double mass : m.mass) m.inverse_mass.push_back(1 / mass);
  for (Index i = 0; i < nodes; i += nodes_per_block)
    m.node_blocks.push_back({i, std::min(i + nodes_per_block, nodes), 0});
  m.bodies.push_back(std::move(body));
}

inline void add_stop(Model& m, double stiffness) {
  for (const Edge& edge : m.bodies[0].boundary) m.contact_nodes.push_back(edge.a);
  std::sort(m.contact_nodes.begin(), m.contact_nodes.end());
  const std::size_t count = m.contact_nodes.size();
  m.contact_bodies.assign(count, 0);
  m.contact_node_sizes.assign(count, 0.01);
  const Shape shape = Rectangle{.at = {-0.0137, -0.1}, .size = {0.06, 0.1}};
  const PreparedShape prepared = prepare(shape);
  m.obstacles.push_back({.name = "stop",
                         .shape = shape,
                         .prepared = prepared,
                         .bounds = bounds(prepared),
                         .friction = 0.35,
                         .velocity = {},
                         .normal_stiffness = std::vector<double>(count, stiffness),
                         .tangential_stiffness = std::vector<double>(count, stiffness)});
  for (Index e = 0; e < m.element_count; ++e) {
    for (const Index corner : m.corners[e]) {
      if (std::binary_search(m.contact_nodes.begin(), m.contact_nodes.end(), corner)) {
        m.contact_spring[e] = std::max(m.contact_spring[e], stiffness * m.inverse_mass[corner]);
      }
    }
  }
}

inline std::vector<Index> nodes_of(const Model& m, const std::string& side) {
  std::vector<Index> nodes;
  for (const NamedEdges& s : m.bodies[0].sides) {
    if (s.name != side) continue;
    for (const Edge& e : s.edges) nodes.insert(nodes.end(), {e.a, e.b});
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

inline Model build(const SmallModel& from = {}) {
  const Tresca steel{.young_modulus = 200e9, .poisson_ratio = 0.3, .yield_stress = 400e6};
  Model m;
  m.run.end_time = from.end_time;
  m.run.integrator = from.integrator;
  m.run.gravity = {0, -9.81};
  if (from.integrator == Integrator::adams2) {
    m.run.time_step = 0.1e-6;
    m.run.when_unstable = WhenUnstable::carry_on;
  }
  add_beam(m, renumber(generate(RectangleMesh{.size = {0.4, 0.1}, .at = {-0.2, 0}, .element_size = from.element_size})),
           steel);
  add_stop(m, 2e9);
  const std::vector<Index> left = nodes_of(m, "left");
  m.loads.push_back({.name = "weight",
                     .nodes = left,
                     .shares = std::vector<double>(left.size(), 1),
                     .edges = {},
                     .value = {0, -1000},
                     .factor = TimeTable::constant(1)});
  if (!from.held.empty()) {
    m.supports.push_back(
        {.name = "held", .nodes = nodes_of(m, from.held), .holds_x = true, .move_x = {}, .move_y = {}, .turn = {}});
  }
  return m;
}

}  // namespace udar

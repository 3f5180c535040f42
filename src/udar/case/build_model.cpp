#include "udar/case/build_model.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "udar/base/error.hpp"
#include "udar/case/build_parts.hpp"
#include "udar/case/memory.hpp"
#include "udar/mesh/boundary.hpp"
#include "udar/mesh/neighbours.hpp"
#include "udar/mesh/renumber.hpp"

namespace udar {
namespace {

const MaterialCase& material_of(const Case& input, const BodyCase& body) {
  const auto found = std::find_if(input.materials.begin(), input.materials.end(),
                                  [&](const MaterialCase& m) { return m.name == body.material; });
  if (found != input.materials.end()) return *found;
  throw UserError(ExitCode::bad_case,
                  fmt::format("body `{}` asks for material `{}`, which is not there", body.name, body.material));
}

/// Arrays that grow by themselves end up to twice as large as they need to be.
void reserve(Model& model, const std::vector<Mesh>& meshes) {
  std::size_t nodes = padding_nodes;
  std::size_t elements = 0;
  for (const Mesh& mesh : meshes) {
    nodes += mesh.nodes.size();
    elements += (mesh.triangles.size() + lanes - 1) / lanes * lanes;
  }
  model.rest.reserve(nodes);
  model.start_velocity.reserve(nodes);
  model.mass.reserve(nodes);
  model.inverse_mass.reserve(nodes);
  model.node_numbers.reserve(nodes);
  model.corners.reserve(elements);
  model.area_density.reserve(elements);
  model.element_numbers.reserve(elements);
}

/// Appends the blocks in which a body's elements are deformed.
void append_blocks(Model& model, const Body& body, const MeshBlocks& cut) {
  const auto first_quad = static_cast<Index>(model.quads.size());
  model.quads.reserve(first_quad + cut.quads.size());
  for (Quad quad : cut.quads) {
    for (Index& node : quad) node = node == none ? none : node + body.node_begin;
    model.quads.push_back(quad);
  }
  for (ElementBlock block : cut.blocks) {
    block.begin += body.element_begin;
    block.end += body.element_begin;
    block.quads += first_quad;
    block.body = static_cast<Index>(model.bodies.size());
    model.element_blocks.push_back(block);
  }
}

/// Appends a body's mesh to the model's arrays, block by block. Elements are padded to whole vectors with the padding
/// triangle, whose corners are set when the number of nodes is known.
void append_body(Model& model, const BodyCase& from, const MaterialCase& material, Mesh& mesh) {
  const auto nodes = static_cast<Index>(mesh.nodes.size());
  const auto elements = static_cast<Index>(mesh.triangles.size());
  Body body{.name = from.name,
            .law = material.law,
            .density = material.density,
            .thickness = from.thickness,
            .node_begin = model.node_count,
            .node_end = model.node_count + nodes,
            .element_begin = static_cast<Index>(model.corners.size()),
            .rigid = from.rigid};
  body.element_end = body.element_begin + elements;
  body.padded_end = (body.element_end + lanes - 1) / lanes * lanes;
  const MeshBlocks cut = cut_blocks(mesh);
  const auto shifted = [&](Edge e) { return Edge{e.a + body.node_begin, e.b + body.node_begin}; };
  for (const Edge& e : mesh.boundary) body.boundary.push_back(shifted(e));
  for (const NamedEdges& side : mesh.sides) {
    body.sides.push_back({side.name, {}});
    for (const Edge& e : side.edges) body.sides.back().edges.push_back(shifted(e));
  }

  model.rest.insert(model.rest.end(), mesh.nodes.begin(), mesh.nodes.end());
  model.node_numbers.insert(model.node_numbers.end(), mesh.node_numbers.begin(), mesh.node_numbers.end());
  model.mass.resize(body.node_end);
  for (const auto& t : mesh.triangles) {
    const double area = 0.5 * twice_area(mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]]);
    const double mass = body.density * area * body.thickness;
    body.mass += mass;
    model.corners.push_back({t[0] + body.node_begin, t[1] + body.node_begin, t[2] + body.node_begin});
    model.area_density.push_back(body.density * area);
    for (const Index corner : model.corners.back()) model.mass[corner] += mass / 3;
  }
  model.element_numbers.insert(model.element_numbers.end(), mesh.triangle_numbers.begin(), mesh.triangle_numbers.end());
  if (!body.rigid) append_blocks(model, body, cut);

  model.element_numbers.resize(body.padded_end);
  model.area_density.resize(body.padded_end, body.density);
  model.corners.resize(body.padded_end, {none, none, none});
  model.node_count += nodes;
  model.element_count += elements;
  model.bodies.push_back(std::move(body));
}

Vec2 centre_of_mass(const Model& model, const Body& body) {
  Vec2 moment;
  for (Index i = body.node_begin; i < body.node_end; ++i) moment += model.mass[i] * model.rest[i];
  return (1 / body.mass) * moment;
}

void set_start_velocity(Model& model, const BodyCase& from, const Body& body) {
  const Vec2 centre = centre_of_mass(model, body);
  model.start_velocity.resize(body.node_end);
  for (Index i = body.node_begin; i < body.node_end; ++i) {
    Vec2 v = from.velocity + from.spin * perpendicular(model.rest[i] - centre);
    if (from.cosine_mode) {
      v += turn_by(dot(from.cosine_mode->wave_vector, model.rest[i])).cos * from.cosine_mode->amplitude;
    }
    model.start_velocity[i] = v;
  }
}

/// Three nodes that never move carry the triangle that pads the element arrays: large, so that it never limits the
/// step.
void add_padding(Model& model) {
  double size = 1;
  for (const Vec2 p : model.rest) size = std::max({size, std::fabs(p.x), std::fabs(p.y)});
  const Index first = model.node_count;
  model.rest.insert(model.rest.end(), {{0, 0}, {size, 0}, {0, size}});
  model.start_velocity.resize(model.rest.size());
  model.mass.resize(model.rest.size(), 1);
  for (auto& corners : model.corners) {
    if (corners[0] == none) corners = {first, first + 1, first + 2};
  }
  for (Quad& quad : model.quads) {
    if (quad[0] == none) quad = {first, first + 1, first + 2, first};
  }
  for (const Body& body : model.bodies) {
    for (Index e = body.element_end; e < body.padded_end; ++e) {
      model.area_density[e] = body.density * 0.5 * size * size;
    }
  }
}

void cut_node_blocks(Model& model) {
  for (Index b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    for (Index i = body.node_begin; i < body.node_end; i += nodes_per_block) {
      model.node_blocks.push_back({i, std::min(i + nodes_per_block, body.node_end), b});
    }
  }
}

/// Bodies that move as one piece. Their masses are those of their triangles, not of points at the nodes: what a rigid
/// body does depends on its outline and not on its mesh.
void add_rigid_bodies(Model& model, const Case& input) {
  std::size_t block = 0;
  for (Index b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const std::size_t begin = block;
    while (block < model.node_blocks.size() && model.node_blocks[block].body == b) ++block;
    if (!body.rigid) continue;
    RigidBody rigid{.body = b,
                    .block_begin = begin,
                    .block_end = block,
                    .centre = centre_of_mass(model, body),
                    .mass = body.mass,
                    .start_velocity = input.bodies[b].velocity,
                    .start_spin = input.bodies[b].spin};
    for (Index e = body.element_begin; e < body.element_end; ++e) {
      // The integral of r . r over a triangle is area / 12 times sum r_i . r_i + (sum r_i) . (sum r_i).
      Vec2 sum;
      double squares = 0;
      for (const Index corner : model.corners[e]) {
        const Vec2 arm = model.rest[corner] - rigid.centre;
        sum += arm;
        squares += dot(arm, arm);
      }
      rigid.inertia += model.area_density[e] * body.thickness / 12 * (squares + dot(sum, sum));
    }
    model.rigid_bodies.push_back(rigid);
  }
}

}  // namespace

Model build_model(const Case& input) {
  check_memory(input);
  std::vector<Mesh> meshes;
  for (const BodyCase& body : input.bodies) meshes.push_back(generate(body.mesh));
  return build_model(input, std::move(meshes));
}

Model build_model(const Case& input, std::vector<Mesh> meshes) {
  Model model;
  model.run = input.run;
  model.contact = input.contact;
  for (Mesh& mesh : meshes) mesh = renumber(mesh, check_mesh(mesh));
  reserve(model, meshes);
  for (std::size_t b = 0; b < meshes.size(); ++b) {
    append_body(model, input.bodies[b], material_of(input, input.bodies[b]), meshes[b]);
    set_start_velocity(model, input.bodies[b], model.bodies.back());
  }
  add_padding(model);
  for (const double mass : model.mass) model.inverse_mass.push_back(1 / mass);
  cut_node_blocks(model);
  add_rigid_bodies(model, input);

  add_contact_nodes(model);
  add_obstacles(model, input);
  add_body_pairs(model, input);
  add_ties(model);
  limit_contact_steps(model);
  add_supports(model, input, meshes);
  add_loads(model, input, meshes);
  add_observers(model, input, meshes);
  model.output = {.fields_every = input.output.fields_every.value_or(0),
                  .fields_at = input.output.fields_at,
                  .histories_every = input.output.histories_every.value_or(input.run.end_time / 1000)};
  std::sort(model.output.fields_at.begin(), model.output.fields_at.end());
  return model;
}

}  // namespace udar

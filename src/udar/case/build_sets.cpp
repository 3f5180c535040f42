#include <fmt/core.h>

#include <algorithm>

#include "udar/base/error.hpp"
#include "udar/case/build_parts.hpp"
#include "udar/mesh/select.hpp"

namespace udar {
namespace {

Index body_index(const Case& input, const std::string& name, const std::string& who) {
  for (Index b = 0; b < input.bodies.size(); ++b) {
    if (input.bodies[b].name == name) return b;
  }
  throw UserError(ExitCode::bad_case, fmt::format("{} asks for body `{}`, which is not there", who, name));
}

/// Nodes within a hundredth of the shortest side count as on a line.
double line_tolerance(const Mesh& mesh) { return 0.01 * shortest_side(mesh); }

std::vector<Index> chosen_nodes(const Mesh& mesh, const Selection& by) {
  if (!by.side.empty()) return nodes_of_side(mesh, by.side);
  if (by.box.size() == 2) return nodes_in_box(mesh, by.box[0], by.box[1]);
  if (by.line.size() == 2) return nodes_near_line(mesh, by.line[0], by.line[1], line_tolerance(mesh));
  if (by.point) return {nearest_node(mesh, *by.point)};
  return {};
}

std::vector<Edge> chosen_edges(const Mesh& mesh, const Selection& by) {
  if (!by.side.empty()) return edges_of_side(mesh, by.side);
  if (by.box.size() == 2) return edges_in_box(mesh, by.box[0], by.box[1]);
  if (by.line.size() == 2) return edges_near_line(mesh, by.line[0], by.line[1], line_tolerance(mesh));
  return {};
}

/// The longest side of the triangles at a node, m: what is farther from it than that is not meant by it.
double longest_side(const Mesh& mesh, Index node) {
  double longest = 0;
  for (const auto& t : mesh.triangles) {
    if (std::find(t.begin(), t.end(), node) == t.end()) continue;
    for (const Index corner : t) longest = std::max(longest, length(mesh.nodes[corner] - mesh.nodes[node]));
  }
  return longest;
}

template <class Found>
Found not_empty(Found found, const std::string& who, const std::string& body, const char* what) {
  if (!found.empty()) return found;
  throw UserError(ExitCode::bad_case, fmt::format("{} picks no {} of body `{}`", who, what, body),
                  "choose a place on the undeformed body: side, box, line or point");
}

}  // namespace

void add_supports(Model& model, const Case& input, const std::vector<Mesh>& meshes) {
  for (const SupportCase& from : input.supports) {
    const std::string who = fmt::format("support `{}`", from.name);
    const Index b = body_index(input, from.nodes.body, who);
    Support support{.name = from.name,
                    .body = b,
                    .nodes = not_empty(chosen_nodes(meshes[b], from.nodes), who, from.nodes.body, "node"),
                    .holds_x = from.move_x.has_value() || from.turn.has_value(),
                    .holds_y = from.move_y.has_value() || from.turn.has_value(),
                    .turns = from.turn.has_value(),
                    .move_x = from.move_x.value_or(TimeTable{}),
                    .move_y = from.move_y.value_or(TimeTable{}),
                    .turn = from.turn.value_or(TimeTable{}),
                    .centre = from.turn_about};
    for (Index& node : support.nodes) node += model.bodies[b].node_begin;
    model.supports.push_back(std::move(support));
  }
}

void add_loads(Model& model, const Case& input, const std::vector<Mesh>& meshes) {
  for (const LoadCase& from : input.loads) {
    const std::string who = fmt::format("load `{}`", from.name);
    const Index b = body_index(input, from.where.body, who);
    const Body& body = model.bodies[b];
    Load load{.name = from.name,
              .nodes = {},
              .shares = {},
              .edges = {},
              .value = from.value,
              .pressure = from.pressure,
              .thickness = body.thickness,
              .factor = from.factor};
    if (from.kind == LoadCase::Kind::force) {
      load.nodes = not_empty(chosen_nodes(meshes[b], from.where), who, body.name, "node");
      load.shares.assign(load.nodes.size(), 1);
    } else {
      for (const Edge& e : not_empty(chosen_edges(meshes[b], from.where), who, body.name, "edge of the boundary")) {
        const double share = 0.5 * body.thickness * length(meshes[b].nodes[e.b] - meshes[b].nodes[e.a]);
        load.nodes.insert(load.nodes.end(), {e.a, e.b});
        load.shares.insert(load.shares.end(), {share, share});
        if (from.kind == LoadCase::Kind::pressure) load.edges.push_back({e.a + body.node_begin, e.b + body.node_begin});
      }
    }
    for (Index& node : load.nodes) node += body.node_begin;
    model.loads.push_back(std::move(load));
  }
}

void add_observers(Model& model, const Case& input, const std::vector<Mesh>& meshes) {
  for (const NodeObserverCase& from : input.observed_nodes) {
    const Index b = body_index(input, from.body, fmt::format("observer `{}`", from.name));
    const Index node = nearest_node(meshes[b], from.at);
    if (length(meshes[b].nodes[node] - from.at) > longest_side(meshes[b], node)) {
      throw UserError(
          ExitCode::bad_case,
          fmt::format("observer `{}`: body `{}` has no node near ({:.5g}, {:.5g}) m", from.name, from.body, from.at.x,
                      from.at.y),
          fmt::format("the nearest is at ({:.5g}, {:.5g}) m", meshes[b].nodes[node].x, meshes[b].nodes[node].y));
    }
    model.observed_nodes.push_back(
        {from.name, model.bodies[b].node_begin + node, {from.window.begin, from.window.end}});
  }
  for (const ElementObserverCase& from : input.observed_elements) {
    const Index b = body_index(input, from.body, fmt::format("observer `{}`", from.name));
    model.observed_elements.push_back({from.name,
                                       model.bodies[b].element_begin + element_at(meshes[b], from.at),
                                       {from.window.begin, from.window.end}});
  }
  for (const RegionObserverCase& from : input.observed_regions) {
    const std::string who = fmt::format("observer `{}`", from.name);
    const Index b = body_index(input, from.body, who);
    RegionObserver region{.name = from.name,
                          .nodes = not_empty(nodes_in_polygon(meshes[b], from.polygon), who, from.body, "node"),
                          .window = {from.window.begin, from.window.end}};
    for (Index& node : region.nodes) {
      node += model.bodies[b].node_begin;
      region.mass += model.mass[node];
    }
    model.observed_regions.push_back(std::move(region));
  }
}

}  // namespace udar

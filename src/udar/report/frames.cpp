#include "udar/report/frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "udar/base/error.hpp"

namespace udar {
namespace {

void check(bool right, const std::filesystem::path& file, std::string_view what) {
  if (!right) throw OutputError(fmt::format("cannot read {}: {}", file.string(), what));
}

const VtuArray* find(const std::vector<VtuArray>& fields, std::string_view name) {
  const auto at = std::find_if(fields.begin(), fields.end(), [&](const VtuArray& f) { return f.name == name; });
  return at == fields.end() ? nullptr : &*at;
}

/// Whole numbers of a field, or 0, 1, 2, ... where the frame has none.
std::vector<std::uint32_t> numbers_of(const std::vector<VtuArray>& fields, std::string_view name, std::size_t count) {
  std::vector<std::uint32_t> out(count);
  const VtuArray* field = find(fields, name);
  const auto* values = field == nullptr ? nullptr : std::get_if<std::vector<std::int32_t>>(&field->values);
  for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<std::uint32_t>(values == nullptr ? i : (*values)[i]);
  return out;
}

/// Begins and ends of the runs of each body; where the frame does not tell, all is one body.
std::vector<std::size_t> ends_of_bodies(const std::vector<VtuArray>& fields, std::size_t count,
                                        const std::filesystem::path& file) {
  const VtuArray* field = find(fields, "body");
  const auto* bodies = field == nullptr ? nullptr : std::get_if<std::vector<std::int32_t>>(&field->values);
  if (bodies == nullptr) return {count};
  std::vector<std::size_t> ends;
  for (std::size_t i = 0; i < count; ++i) {
    const auto body = static_cast<std::size_t>((*bodies)[i]);
    const bool goes_on = !ends.empty() && body + 1 == ends.size();
    check(goes_on || body == ends.size(), file, "nodes or elements of the bodies are not in order");
    if (!goes_on) ends.push_back(i);
    ends.back() = i + 1;
  }
  return ends;
}

/// One component of a field as 32-bit numbers, put behind `out`.
void add_component(const VtuArray& field, int component, std::vector<float>& out) {
  const auto step = static_cast<std::size_t>(field.components);
  std::visit(
      [&](const auto& values) {
        for (auto i = static_cast<std::size_t>(component); i < values.size(); i += step) {
          out.push_back(static_cast<float>(values[i]));
        }
      },
      field.values);
}

/// The share of each node in the mass of its body: a third of the areas of its triangles over the area of the body. A
/// body is of one density and thickness, so these are the lumped masses of the run, where the frame is that of its
/// start.
std::vector<double> mass_shares(const ReportMesh& mesh, std::span<const Vec2> points) {
  std::vector<double> shares(mesh.nodes);
  for (const MeshBody& body : mesh.bodies) {
    double total = 0;
    for (std::size_t e = body.element_begin; e < body.element_end; ++e) {
      const std::array corners{mesh.corners[e], mesh.corners[mesh.elements + e], mesh.corners[2 * mesh.elements + e]};
      const Vec2 a = points[corners[0]];
      const double area = 0.5 * std::fabs(cross(points[corners[1]] - a, points[corners[2]] - a));
      if (!std::isfinite(area)) continue;
      for (const std::uint32_t corner : corners) shares[corner] += area / 3;
      total += area;
    }
    for (std::size_t i = body.node_begin; i < body.node_end; ++i) {
      shares[i] = total > 0 ? shares[i] / total : 1 / static_cast<double>(body.node_end - body.node_begin);
    }
  }
  return shares;
}

/// Centre of mass; nodes that are nowhere do not count.
Vec2 centre_of_mass(std::span<const Vec2> points, std::span<const double> shares) {
  Vec2 sum{};
  double known = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y)) continue;
    sum += shares[i] * points[i];
    known += shares[i];
  }
  return known > 0 ? (1 / known) * sum : Vec2{};
}

constexpr std::string_view force_field = "contact_force_N";

void add_forces(const VtuArray& field, NodeForces& forces) {
  const auto* values = std::get_if<std::vector<float>>(&field.values);
  if (values == nullptr || field.components != 3) return forces.counts.push_back(0);
  std::uint32_t count = 0;
  for (std::size_t i = 0; i + 2 < values->size(); i += 3) {
    if ((*values)[i] == 0 && (*values)[i + 1] == 0) continue;
    forces.nodes.push_back(static_cast<std::uint32_t>(i / 3));
    forces.x.push_back((*values)[i]);
    forces.y.push_back((*values)[i + 1]);
    ++count;
  }
  forces.counts.push_back(count);
}

void add_places(const VtuGrid& grid, const ReportMesh& mesh, const Wanted& wanted, Chunk& chunk) {
  for (const MeshBody& body : mesh.bodies) {
    const auto points = std::span(grid.points).subspan(body.node_begin, body.node_end - body.node_begin);
    const Vec2 centre =
        centre_of_mass(points, std::span(mesh.shares).subspan(body.node_begin, body.node_end - body.node_begin));
    chunk.centre_x.push_back(centre.x);
    chunk.centre_y.push_back(centre.y);
    for (std::size_t q = 0; q < wanted.quantities.size(); ++q) {
      if (!wanted.quantities[q].field.empty()) continue;
      const bool is_x = wanted.quantities[q].component == 0;
      for (const Vec2& p : points) {
        chunk.values[q].push_back(static_cast<float>(is_x ? p.x - centre.x : p.y - centre.y));
      }
    }
  }
}

}  // namespace

ReportMesh read_mesh(const FrameFiles& frame) {
  const VtuGrid grid = read_vtu(frame.bodies, {.fields = {"node_number", "element_number", "body"}, .cells = true});
  ReportMesh mesh{.nodes = grid.points.size(), .elements = grid.ends.size()};
  check(grid.corners.size() == 3 * mesh.elements, frame.bodies, "not all cells are triangles");
  mesh.corners.resize(grid.corners.size());
  for (std::size_t e = 0; e < mesh.elements; ++e) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto corner = static_cast<std::size_t>(grid.corners[3 * e + c]);
      check(corner < mesh.nodes, frame.bodies, "a triangle has a corner that is no node");
      mesh.corners[c * mesh.elements + e] = static_cast<std::uint32_t>(corner);
    }
  }
  mesh.node_numbers = numbers_of(grid.point_fields, "node_number", mesh.nodes);
  mesh.element_numbers = numbers_of(grid.cell_fields, "element_number", mesh.elements);
  const auto nodes = ends_of_bodies(grid.point_fields, mesh.nodes, frame.bodies);
  const auto elements = ends_of_bodies(grid.cell_fields, mesh.elements, frame.bodies);
  check(nodes.size() == elements.size(), frame.bodies, "nodes and elements are of different bodies");
  MeshBody body;
  for (std::size_t b = 0; b < nodes.size(); ++b) {
    body = {body.node_end, nodes[b], body.element_end, elements[b]};
    mesh.bodies.push_back(body);
  }
  mesh.shares = mass_shares(mesh, grid.points);
  mesh.fields = vtu_fields(frame.bodies);
  return mesh;
}

void add_frame(const FrameFiles& frame, const ReportMesh& mesh, const Wanted& wanted, Chunk& chunk) {
  VtuPart part{.fields = {}, .places = wanted.places};
  for (const Quantity& q : wanted.quantities) part.fields.emplace_back(q.field);
  if (wanted.forces) part.fields.emplace_back(force_field);
  const VtuGrid grid = read_vtu(frame.bodies, part);
  chunk.values.resize(wanted.quantities.size());
  if (wanted.places) {
    check(grid.points.size() == mesh.nodes, frame.bodies, "it has other nodes than the first frame");
    add_places(grid, mesh, wanted, chunk);
  }
  for (std::size_t q = 0; q < wanted.quantities.size(); ++q) {
    const Quantity& quantity = wanted.quantities[q];
    if (quantity.field.empty()) continue;
    const VtuArray* field = find(quantity.on_nodes ? grid.point_fields : grid.cell_fields, quantity.field);
    check(field != nullptr && quantity.component < field->components, frame.bodies,
          fmt::format("it has no field `{}`", quantity.field));
    const std::size_t before = chunk.values[q].size();
    add_component(*field, quantity.component, chunk.values[q]);
    check(chunk.values[q].size() - before == (quantity.on_nodes ? mesh.nodes : mesh.elements), frame.bodies,
          "it has other nodes or elements than the first frame");
  }
  if (!wanted.forces) return;
  const VtuArray* field = find(grid.point_fields, force_field);
  if (field != nullptr) {
    add_forces(*field, chunk.forces);
  } else {
    chunk.forces.counts.push_back(0);
  }
}

}  // namespace udar

#include "udar/output/frame_writer.hpp"

#include <algorithm>

#include "udar/output/observer.hpp"

namespace udar {
namespace {

Box box_of_bodies(const Model& model, const State& state) {
  Box box;
  for (Index i = 0; i < model.node_count; ++i) box.include({state.nodes[i].x, state.nodes[i].y});
  return box;
}

/// One number for each element of all bodies, without padding.
template <class Value, class F>
std::vector<Value> for_elements(const Model& model, F&& value) {
  std::vector<Value> out;
  out.reserve(model.element_count);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    for (Index e = model.bodies[b].element_begin; e < model.bodies[b].element_end; ++e) out.push_back(value(b, e));
  }
  return out;
}

template <class Value, class F>
std::vector<Value> for_nodes(const Model& model, F&& value) {
  std::vector<Value> out(model.node_count);
  for (Index i = 0; i < model.node_count; ++i) out[i] = value(i);
  return out;
}

std::vector<Vec2> contact_forces(const Model& model, const State& state) {
  std::vector<Vec2> force(model.node_count);
  const std::size_t count = model.contact_nodes.size();
  for (std::size_t k = 0; k < state.contacts.size(); ++k) {
    const SpringState& s = state.contacts[k];
    force[model.contact_nodes[k % count]] += s.normal_force + s.friction_force + s.damping_force;
  }
  return force;
}

std::vector<std::int32_t> bodies_of_nodes(const Model& model) {
  std::vector<std::int32_t> number(model.node_count);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    for (Index i = model.bodies[b].node_begin; i < model.bodies[b].node_end; ++i) {
      number[i] = static_cast<std::int32_t>(b);
    }
  }
  return number;
}

void add_point_fields(const Model& model, const State& state, VtuGrid& grid) {
  auto& out = grid.point_fields;
  out.push_back(vector_field("displacement", "m",
                             for_nodes<Vec2>(model, [&](Index i) { return grid.points[i] - model.rest[i]; })));
  out.push_back(vector_field("velocity", "m/s", for_nodes<Vec2>(model, [&](Index i) { return velocity(state, i); })));
  out.push_back(
      vector_field("acceleration", "m/s^2", for_nodes<Vec2>(model, [&](Index i) { return state.acceleration[i]; })));
  out.push_back(vector_field("contact_force", "N", contact_forces(model, state)));
  out.push_back(number_field("node_number", for_nodes<std::int32_t>(model, [&](Index i) {
                               return static_cast<std::int32_t>(model.node_numbers[i]);
                             })));
  out.push_back(number_field("body", bodies_of_nodes(model)));
}

void add_cell_fields(const Model& model, const State& state, VtuGrid& grid) {
  auto& out = grid.cell_fields;
  const auto scalar = [&](const char* name, const char* unit, auto&& value) {
    out.push_back(
        scalar_field(name, unit, for_elements<double>(model, [&](std::size_t, Index e) { return value(e); })));
  };
  scalar("stress_x", "Pa", [&](Index e) { return state.stress_xx[e]; });
  scalar("stress_y", "Pa", [&](Index e) { return state.stress_yy[e]; });
  scalar("stress_xy", "Pa", [&](Index e) { return state.stress_xy[e]; });
  scalar("stress_z", "Pa", [&](Index e) { return state.stress_zz[e]; });
  std::vector<std::array<double, 3>> principal(model.corners.size());
  for (Index e = 0; e < principal.size(); ++e) principal[e] = principal_stresses(state, e);
  scalar("principal_1", "Pa", [&](Index e) { return principal[e][0]; });
  scalar("principal_2", "Pa", [&](Index e) { return principal[e][1]; });
  scalar("principal_3", "Pa", [&](Index e) { return principal[e][2]; });
  scalar("max_shear", "Pa", [&](Index e) { return 0.5 * (principal[e][0] - principal[e][2]); });
  scalar("pressure", "Pa",
         [&](Index e) { return -(state.stress_xx[e] + state.stress_yy[e] + state.stress_zz[e]) / 3; });
  scalar("plastic_strain", "", [&](Index e) { return state.plastic_strain[e]; });
  out.push_back(flag_field("flows_now", for_elements<std::uint8_t>(model, [&](std::size_t, Index e) {
                             return static_cast<std::uint8_t>(flows(state, e));
                           })));
  out.push_back(number_field("element_number", for_elements<std::int32_t>(model, [&](std::size_t, Index e) {
                               return static_cast<std::int32_t>(model.element_numbers[e]);
                             })));
  out.push_back(number_field(
      "body", for_elements<std::int32_t>(model, [](std::size_t b, Index) { return static_cast<std::int32_t>(b); })));
}

/// The edge of something endless with a part of it, so that it can be seen which side is full.
std::vector<Vec2> strip(const PreparedShape& shape, const Polyline& edge, double depth) {
  const Vec2 inward = -depth * gap(shape, 0.5 * (edge[0] + edge[1])).normal;
  return {edge[0], edge[1], edge[1] + inward, edge[0] + inward};
}

}  // namespace

VtuGrid body_grid(const Model& model, const State& state) {
  auto points = for_nodes<Vec2>(model, [&](Index i) { return Vec2{state.nodes[i].x, state.nodes[i].y}; });
  const auto triangles = for_elements<std::array<std::int32_t, 3>>(model, [&](std::size_t, Index e) {
    const auto& c = model.corners[e];
    return std::array{static_cast<std::int32_t>(c[0]), static_cast<std::int32_t>(c[1]),
                      static_cast<std::int32_t>(c[2])};
  });
  VtuGrid grid = triangle_grid(state.clock.time.value(), std::move(points), triangles);
  add_point_fields(model, state, grid);
  add_cell_fields(model, state, grid);
  return grid;
}

std::vector<std::vector<Vec2>> obstacle_outlines(const Model& model, const State& state) {
  const Box bodies = box_of_bodies(model, state);
  const double margin = 0.5 * std::max(bodies.size().x, bodies.size().y);
  std::vector<std::vector<Vec2>> all;
  for (const Obstacle& obstacle : model.obstacles) {
    const Vec2 moved = state.clock.time.value() * obstacle.velocity;
    const Box view{bodies.low - moved, bodies.high - moved};
    for (const Polyline& line : outline(obstacle.prepared, view.grown(margin))) {
      all.push_back(line.size() == 2 ? strip(obstacle.prepared, line, 0.4 * margin) : line);
      if (all.back().front() == all.back().back()) all.back().pop_back();
      for (Vec2& p : all.back()) p += moved;
    }
  }
  return all;
}

VtuGrid obstacle_grid(const Model& model, const State& state) {
  VtuGrid grid;
  grid.time = state.clock.time.value();
  for (const auto& outline : obstacle_outlines(model, state)) {
    if (outline.size() >= 3) grid.add_polygon(outline);
  }
  return grid;
}

FrameWriter::FrameWriter(const Model& model, const RunFolder& folder)
    : model_(model), folder_(folder), index_(folder / RunFolder::fields_index), intervals_(model.output.fields_every) {}

void FrameWriter::record(const State& state) {
  const double time = state.clock.time.value();
  bool due = intervals_.reached(time);
  // Here too a hair early counts.
  while (times_ < model_.output.fields_at.size() && model_.output.fields_at[times_] <= time * (1 + 1e-12)) {
    due = true;
    ++times_;
  }
  if (due) write(state);
}

void FrameWriter::close(const State& state) {
  const bool wanted = model_.output.fields_every > 0 || !model_.output.fields_at.empty();
  if (wanted && (frames_ == 0 || last_step_ != state.clock.step)) write(state);
}

void FrameWriter::write(const State& state) {
  const double time = state.clock.time.value();
  std::vector<PvdEntry> frame{{time, 0, RunFolder::frame_name("bodies", frames_)}};
  write_vtu(folder_ / frame[0].file, body_grid(model_, state));
  const VtuGrid obstacles = obstacle_grid(model_, state);
  if (!obstacles.points.empty()) {
    frame.push_back({time, 1, RunFolder::frame_name("obstacles", frames_)});
    write_vtu(folder_ / frame[1].file, obstacles);
  }
  index_.add(frame);
  ++frames_;
  last_step_ = state.clock.step;
}

}  // namespace udar

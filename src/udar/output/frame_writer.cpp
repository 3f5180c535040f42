#include "udar/output/frame_writer.hpp"

#include <algorithm>
#include <memory>

#include "udar/output/observer.hpp"

namespace udar {
namespace {

Box box_of_bodies(const Model& model, const State& state) {
  Box box;
  for (Index i = 0; i < model.node_count; ++i) box.include({state.nodes[i].x, state.nodes[i].y});
  return box;
}

/// Calls f(k, body, e) for the elements that are number `first` + k of all bodies, padding left out, k < count.
template <class F>
void for_elements(const Model& model, std::size_t first, std::size_t count, F&& f) {
  std::size_t before = 0;  // elements of the bodies passed
  for (std::size_t b = 0; b < model.bodies.size() && before < first + count; ++b) {
    const Body& body = model.bodies[b];
    const std::size_t after = before + body.element_end - body.element_begin;
    for (std::size_t k = std::max(before, first); k < std::min(after, first + count); ++k) {
      f(k - first, b, static_cast<Index>(body.element_begin + (k - before)));
    }
    before = after;
  }
}

/// A field with value(body, e) for each element.
template <class Number, class Value>
VtuField element_field(const Model& model, std::string name, Value value) {
  return {std::move(name), 1, model.element_count,
          VtuSource<Number>([&model, value](std::size_t first, std::span<Number> out) {
            for_elements(model, first, out.size(),
                         [&](std::size_t k, std::size_t b, Index e) { out[k] = value(b, e); });
          })};
}

/// A field with value(i) for each node.
template <class Number, class Value>
VtuField node_field(const Model& model, std::string name, Value value) {
  return {std::move(name), 1, model.node_count, VtuSource<Number>([value](std::size_t first, std::span<Number> out) {
            for (std::size_t k = 0; k < out.size(); ++k) out[k] = value(static_cast<Index>(first + k));
          })};
}

VtuField node_numbers(const Model& model) {
  return node_field<std::int32_t>(model, "node_number",
                                  [&model](Index i) { return static_cast<std::int32_t>(model.node_numbers[i]); });
}

VtuField bodies_of_nodes(const Model& model) {
  return {"body", 1, model.node_count,
          VtuSource<std::int32_t>([&model](std::size_t first, std::span<std::int32_t> out) {
            const Body* body = model.bodies.data();
            for (std::size_t k = 0; k < out.size(); ++k) {
              while (first + k >= body->node_end) ++body;
              out[k] = static_cast<std::int32_t>(body - model.bodies.data());
            }
          })};
}

template <class Value>
VtuField node_vectors(const Model& model, const char* quantity, const char* unit, Value value) {
  return vectors<float>(field_name(quantity, unit), model.node_count,
                        [value](std::size_t i) { return value(static_cast<Index>(i)); });
}

/// What happens to a contact node.
struct NodeTouch {
  Vec2 force{};  ///< N, of all that touch it
  // Of what it has sunk into, the deepest where there are several.
  double depth = 0;  ///< m
  Vec2 normal{};
  std::uint8_t state = 0;     ///< 0 none, 1 sticks, 2 slides
  std::int32_t partner = -1;  ///< body, or number of bodies + obstacle
};

/// Touches of the contact nodes, with all obstacles, their corners, and bodies.
std::vector<NodeTouch> node_touches(const Model& model, const State& state) {
  std::vector<NodeTouch> touches(model.contact_nodes.size());
  const auto enter = [&](std::size_t point, const SpringState& springs, bool rubs, std::size_t partner) {
    NodeTouch& touch = touches[point];
    if (springs.penetration <= touch.depth) return;
    touch.depth = springs.penetration;
    touch.normal = springs.normal;
    touch.state = rubs && springs.slides == 0 ? 1 : 2;
    touch.partner = static_cast<std::int32_t>(partner);
  };
  for (std::size_t k = 0; k < state.contacts.size(); ++k) {
    const SpringState& s = state.contacts[k];
    const std::size_t point = k % touches.size();
    const std::size_t obstacle = k / touches.size();
    touches[point].force += s.normal_force + s.friction_force + s.damping_force;
    enter(point, s, model.obstacles[obstacle].friction > 0, model.bodies.size() + obstacle);
  }
  for (const BodyTouch& t : state.touches) {
    for_each_force(model.segments, t,
                   [&](std::uint32_t point, const TouchForces& f) { touches[point].force += f.total(); });
    enter(t.point, t.springs, t.lever > 0 && model.body_pair(t.point, t.body).friction > 0, t.body);
  }
  for (const CornerTouch& t : state.corner_touches) {
    const bool rubs = t.lever > 0 && model.obstacle_of(t.point).friction > 0;
    SpringState of_end = t.springs;  // seen from the ends of the segment that the corner is in
    of_end.normal = -t.springs.normal;
    for_each_force(model.segments, t, [&](std::uint32_t point, const TouchForces& f) {
      touches[point].force += f.total();
      if (f.normal == Vec2{}) return;
      enter(point, of_end, rubs, model.bodies.size() + model.corner_of(t.point).obstacle);
    });
  }
  return touches;
}

/// Fields of the contact nodes; other nodes have what a node has that nothing touches.
void add_contact_fields(const Model& model, const State& state, std::vector<VtuField>& out) {
  const auto touches = std::make_shared<const std::vector<NodeTouch>>(node_touches(model, state));
  const auto touch = [&model, touches](std::size_t node) {
    const auto at = std::lower_bound(model.contact_nodes.begin(), model.contact_nodes.end(), node);
    if (at == model.contact_nodes.end() || *at != node) return NodeTouch{};
    return (*touches)[static_cast<std::size_t>(at - model.contact_nodes.begin())];
  };
  out.push_back(node_vectors(model, "contact_force", "N", [touch](Index i) { return touch(i).force; }));
  out.push_back(node_vectors(model, "contact_normal", "", [touch](Index i) { return touch(i).normal; }));
  out.push_back(node_field<float>(model, field_name("contact_penetration", "m"),
                                  [touch](Index i) { return as_float(touch(i).depth); }));
  out.push_back(node_field<std::uint8_t>(model, "contact_state", [touch](Index i) { return touch(i).state; }));
  out.push_back(node_field<std::int32_t>(model, "contact_partner", [touch](Index i) { return touch(i).partner; }));
}

void add_point_fields(const Model& model, const State& state, std::vector<VtuField>& out) {
  out.push_back(node_vectors(model, "displacement", "m", [&](Index i) { return place(state, i) - model.rest[i]; }));
  out.push_back(node_vectors(model, "velocity", "m/s", [&](Index i) { return velocity(state, i); }));
  out.push_back(node_vectors(model, "acceleration", "m/s^2", [&](Index i) { return state.acceleration[i]; }));
  add_contact_fields(model, state, out);
  out.push_back(node_numbers(model));
  out.push_back(bodies_of_nodes(model));
}

void add_cell_fields(const Model& model, const State& state, std::vector<VtuField>& out) {
  const auto scalar = [&](const char* name, const char* unit, auto&& value) {
    out.push_back(element_field<float>(model, field_name(name, unit),
                                       [value](std::size_t, Index e) { return as_float(value(e)); }));
  };
  scalar("stress_x", "Pa", [&](Index e) { return state.stress_xx[e]; });
  scalar("stress_y", "Pa", [&](Index e) { return state.stress_yy[e]; });
  scalar("stress_xy", "Pa", [&](Index e) { return state.stress_xy[e]; });
  scalar("stress_z", "Pa", [&](Index e) { return state.stress_zz[e]; });
  // Computed anew for each of them: that takes less time than packing, and an array would take 24 bytes an element.
  scalar("principal_1", "Pa", [&](Index e) { return principal_stresses(state, e)[0]; });
  scalar("principal_2", "Pa", [&](Index e) { return principal_stresses(state, e)[1]; });
  scalar("principal_3", "Pa", [&](Index e) { return principal_stresses(state, e)[2]; });
  scalar("max_shear", "Pa", [&](Index e) {
    const auto p = principal_stresses(state, e);
    return 0.5 * (p[0] - p[2]);
  });
  scalar("pressure", "Pa",
         [&](Index e) { return -(state.stress_xx[e] + state.stress_yy[e] + state.stress_zz[e]) / 3; });
  scalar("plastic_strain", "", [&](Index e) { return state.plastic_strain[e]; });
  out.push_back(element_field<std::uint8_t>(
      model, "flows_now", [&](std::size_t, Index e) { return static_cast<std::uint8_t>(flows(state, e)); }));
  out.push_back(element_field<std::int32_t>(model, "element_number", [&](std::size_t, Index e) {
    return static_cast<std::int32_t>(model.element_numbers[e]);
  }));
  out.push_back(
      element_field<std::int32_t>(model, "body", [](std::size_t b, Index) { return static_cast<std::int32_t>(b); }));
}

/// Points and triangles of all bodies.
VtuFrame bare_frame(const Model& model, const State& state) {
  VtuFrame frame{.time = state.clock.time.value(),
                 .points = model.node_count,
                 .cells = model.element_count,
                 .places = vectors<double>("Points", model.node_count,
                                           [&](std::size_t i) { return place(state, static_cast<Index>(i)); }),
                 .corners = {},
                 .ends = {},
                 .kinds = {},
                 .point_fields = {},
                 .cell_fields = {}};
  frame.corners = {"connectivity", 1, 3 * frame.cells,
                   VtuSource<std::int32_t>([&model](std::size_t first, std::span<std::int32_t> out) {
                     for_elements(model, first / 3, out.size() / 3, [&](std::size_t k, std::size_t, Index e) {
                       for (std::size_t c = 0; c < 3; ++c) {
                         out[3 * k + c] = static_cast<std::int32_t>(model.corners[e][c]);
                       }
                     });
                   })};
  frame.ends = {"offsets", 1, frame.cells, VtuSource<std::int32_t>([](std::size_t first, std::span<std::int32_t> out) {
                  for (std::size_t k = 0; k < out.size(); ++k) out[k] = static_cast<std::int32_t>(3 * (first + k + 1));
                })};
  frame.kinds = {"types", 1, frame.cells, VtuSource<std::uint8_t>([](std::size_t, std::span<std::uint8_t> out) {
                   std::fill(out.begin(), out.end(), static_cast<std::uint8_t>(VtuCell::triangle));
                 })};
  return frame;
}

/// The edge of something endless with a part of it, so that it can be seen which side is full.
std::vector<Vec2> strip(const PreparedShape& shape, const Polyline& edge, double depth) {
  const Vec2 inward = -depth * gap(shape, 0.5 * (edge[0] + edge[1])).normal;
  return {edge[0], edge[1], edge[1] + inward, edge[0] + inward};
}

}  // namespace

VtuFrame body_frame(const Model& model, const State& state) {
  VtuFrame frame = bare_frame(model, state);
  add_point_fields(model, state, frame.point_fields);
  add_cell_fields(model, state, frame.cell_fields);
  return frame;
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
  write_vtu(folder_ / frame[0].file, body_frame(model_, state));
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

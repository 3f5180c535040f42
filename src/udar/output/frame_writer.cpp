#include "udar/output/frame_writer.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "udar/base/archive.hpp"
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
      f(k - first, b, body.element_begin + (k - before));  // 64 bits: with 32, which may wrap, no vectors are made
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
                         [&](std::size_t k, std::size_t b, std::size_t e) { out[k] = value(b, e); });
          })};
}

/// A field with value(i) for each node.
template <class Number, class Value>
VtuField node_field(const Model& model, std::string name, Value value) {
  return {std::move(name), 1, model.node_count, VtuSource<Number>([value](std::size_t first, std::span<Number> out) {
            for (std::size_t k = 0; k < out.size(); ++k) out[k] = value(static_cast<Index>(first + k));
          })};
}

VtuField constant(VtuField field) {
  field.constant = true;
  return field;
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

/// A field of the contact nodes, value(touch, number of the component); of other nodes what a node has that nothing
/// touches.
template <class Number, class Value>
VtuField contact_field(const Model& model, const std::shared_ptr<const std::vector<NodeTouch>>& touches,
                       std::string name, int components, Value value) {
  const auto each = static_cast<std::size_t>(components);
  return {std::move(name), components, each * model.node_count,
          VtuSource<Number>([&model, touches, each, value](std::size_t first, std::span<Number> out) {
            std::fill(out.begin(), out.end(), value(NodeTouch{}, 0));
            const auto nodes = std::span(model.contact_nodes);
            const std::size_t end = (first + out.size()) / each;
            auto at = static_cast<std::size_t>(std::ranges::lower_bound(nodes, first / each) - nodes.begin());
            for (; at < nodes.size() && nodes[at] < end; ++at) {
              Number* const numbers = out.data() + (each * nodes[at] - first);
              for (std::size_t k = 0; k < each; ++k) numbers[k] = value((*touches)[at], k);
            }
          })};
}

void add_contact_fields(const Model& model, const State& state, std::vector<VtuField>& out) {
  const auto touches = std::make_shared<const std::vector<NodeTouch>>(node_touches(model, state));
  const auto component = [](Vec2 v, std::size_t k) { return k == 0 ? as_float(v.x) : k == 1 ? as_float(v.y) : 0.0F; };
  out.push_back(contact_field<float>(model, touches, field_name("contact_force", "N"), 3,
                                     [=](const NodeTouch& t, std::size_t k) { return component(t.force, k); }));
  out.push_back(contact_field<float>(model, touches, field_name("contact_normal", ""), 3,
                                     [=](const NodeTouch& t, std::size_t k) { return component(t.normal, k); }));
  out.push_back(contact_field<float>(model, touches, field_name("contact_penetration", "m"), 1,
                                     [](const NodeTouch& t, std::size_t) { return as_float(t.depth); }));
  out.push_back(contact_field<std::uint8_t>(model, touches, "contact_state", 1,
                                            [](const NodeTouch& t, std::size_t) { return t.state; }));
  out.push_back(contact_field<std::int32_t>(model, touches, "contact_partner", 1,
                                            [](const NodeTouch& t, std::size_t) { return t.partner; }));
}

void add_point_fields(const Model& model, const State& state, std::vector<VtuField>& out) {
  out.push_back(node_vectors(model, "displacement", "m", [&](Index i) { return place(state, i) - model.rest[i]; }));
  out.push_back(node_vectors(model, "velocity", "m/s", [&](Index i) { return velocity(state, i); }));
  out.push_back(node_vectors(model, "acceleration", "m/s^2", [&](Index i) { return state.acceleration[i]; }));
  add_contact_fields(model, state, out);
  out.push_back(constant(node_numbers(model)));
  out.push_back(constant(bodies_of_nodes(model)));
}

void add_cell_fields(const Model& model, const State& state, std::vector<VtuField>& out) {
  const auto scalar = [&](const char* name, const char* unit, auto&& value) {
    out.push_back(element_field<float>(model, field_name(name, unit),
                                       [value](std::size_t, std::size_t e) { return as_float(value(e)); }));
  };
  scalar("stress_x", "Pa", [&](std::size_t e) { return state.stress_xx[e]; });
  scalar("stress_y", "Pa", [&](std::size_t e) { return state.stress_yy[e]; });
  scalar("stress_xy", "Pa", [&](std::size_t e) { return state.stress_xy[e]; });
  scalar("stress_z", "Pa", [&](std::size_t e) { return state.stress_zz[e]; });
  // Computed anew for each of them: that takes less time than packing, and an array would take 24 bytes an element.
  scalar("principal_1", "Pa", [&](std::size_t e) { return principal_stresses(state, e)[0]; });
  scalar("principal_2", "Pa", [&](std::size_t e) { return principal_stresses(state, e)[1]; });
  scalar("principal_3", "Pa", [&](std::size_t e) { return principal_stresses(state, e)[2]; });
  scalar("max_shear", "Pa", [&](std::size_t e) {
    const auto p = principal_stresses(state, e);
    return 0.5 * (p[0] - p[2]);
  });
  scalar("pressure", "Pa",
         [&](std::size_t e) { return -(state.stress_xx[e] + state.stress_yy[e] + state.stress_zz[e]) / 3; });
  scalar("plastic_strain", "", [&](std::size_t e) { return state.plastic_strain[e]; });
  out.push_back(element_field<std::uint8_t>(model, "flows_now", [&](std::size_t, std::size_t e) {
    return static_cast<std::uint8_t>(flows(state, static_cast<Index>(e)));
  }));
  out.push_back(constant(element_field<std::int32_t>(model, "element_number", [&](std::size_t, std::size_t e) {
    return static_cast<std::int32_t>(model.element_numbers[e]);
  })));
  out.push_back(constant(element_field<std::int32_t>(
      model, "body", [](std::size_t b, std::size_t) { return static_cast<std::int32_t>(b); })));
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
                     for_elements(model, first / 3, out.size() / 3, [&](std::size_t k, std::size_t, std::size_t e) {
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
  for (VtuField* field : {&frame.corners, &frame.ends, &frame.kinds}) field->constant = true;
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

std::vector<ObstacleOutline> named_obstacle_outlines(const Model& model, const State& state) {
  const Box bodies = box_of_bodies(model, state);
  const double margin = 0.5 * std::max(bodies.size().x, bodies.size().y);
  std::vector<ObstacleOutline> all;
  for (std::size_t o = 0; o < model.obstacles.size(); ++o) {
    const Obstacle& obstacle = model.obstacles[o];
    const Vec2 moved = state.clock.time.value() * obstacle.velocity;
    const Box view{bodies.low - moved, bodies.high - moved};
    for (const Polyline& line : outline(obstacle.prepared, view.grown(margin))) {
      std::vector<Vec2> points = line.size() == 2 ? strip(obstacle.prepared, line, 0.4 * margin) : line;
      if (points.front() == points.back()) points.pop_back();
      for (Vec2& p : points) p += moved;
      all.push_back({o, std::move(points)});
    }
  }
  return all;
}

std::vector<std::vector<Vec2>> obstacle_outlines(const Model& model, const State& state) {
  std::vector<std::vector<Vec2>> all;
  for (ObstacleOutline& outline : named_obstacle_outlines(model, state)) all.push_back(std::move(outline.points));
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

namespace {

/// How long a frame may be there before the index names it, where others follow.
constexpr std::chrono::milliseconds between_renewals{250};

/// Of frames that take so many bytes each as many wait for the disk.
std::size_t frames_that_wait(std::size_t bytes) {
  constexpr std::size_t most_bytes = std::size_t{64} << 20;
  return std::clamp<std::size_t>(most_bytes / std::max<std::size_t>(bytes, 1), 1, most_frames_waiting);
}

}  // namespace

std::size_t memory_of_frames(const Model& model, const State& state) {
  if (!(model.output.fields_every > 0) && model.output.fields_at.empty()) return 0;
  VtuPacker packer;
  PackedVtu frame;
  packer.pack(body_frame(model, state), frame);
  return (frames_that_wait(frame.memory()) - 1) * frame.memory();
}

FrameWriter::FrameWriter(const Model& model, const RunFolder& folder, Pool& pool)
    : model_(model),
      folder_(folder),
      intervals_(model.output.fields_every),
      body_packer_(
          [&pool](std::size_t jobs, const std::function<void(std::size_t)>& job) { pool.for_each_job(jobs, job); }),
      index_(folder / RunFolder::fields_index),
      background_([this] { renew_index(); }, between_renewals) {}

void FrameWriter::record(const State& state) {
  background_.rethrow();
  const double time = state.clock.time.value();
  bool due = intervals_.reached(time);
  // Here too a hair early counts.
  while (times_ < model_.output.fields_at.size() && model_.output.fields_at[times_] <= time * (1 + 1e-12)) {
    due = true;
    ++times_;
  }
  if (due) take(state);
}

void FrameWriter::close(const State& state) {
  const bool wanted = model_.output.fields_every > 0 || !model_.output.fields_at.empty();
  if (wanted && (taken_ == 0 || last_step_ != state.clock.step)) take(state);
  background_.finish();
}

std::vector<std::filesystem::path> FrameWriter::settle() {
  background_.finish();
  std::vector<std::filesystem::path> files;
  for (; settled_ < index_.entries().size(); ++settled_) files.push_back(folder_ / index_.entries()[settled_].file);
  if (!files.empty()) files.push_back(folder_ / RunFolder::fields_index);
  return files;
}

template <class Archive>
void FrameWriter::carry(Archive& archive) {
  std::vector<double> times;        // s, one for each frame
  std::vector<std::uint8_t> kinds;  // 1 where there are obstacles, too
  for (const PvdEntry& entry : index_.entries()) {
    if (entry.part == 0) {
      times.push_back(entry.time);
      kinds.push_back(0);
    } else {
      kinds.back() = 1;
    }
  }
  archive(intervals_, times_, taken_, last_step_, times, kinds);
  if constexpr (Archive::reads) {
    if (kinds.size() != times.size()) throw OutputError("its list of frames is not whole");
    for (std::size_t k = 0; k < times.size(); ++k) add_to_index(times[k], kinds[k] != 0);
    settled_ = index_.entries().size();
  }
}
template void FrameWriter::carry(BytesOut&);
template void FrameWriter::carry(BytesIn&);

void FrameWriter::take(const State& state) {
  background_.wait(room_ - 1);
  Waiting& frame = waiting_[packed_ % room_];
  frame.time = state.clock.time.value();
  body_packer_.pack(body_frame(model_, state), frame.bodies);
  const VtuGrid obstacles = obstacle_grid(model_, state);
  frame.has_obstacles = !obstacles.points.empty();
  if (frame.has_obstacles) obstacle_packer_.pack(obstacles, frame.obstacles);
  background_.add([this, &frame] { put_on_disk(frame); });
  if (packed_++ == 0) room_ = frames_that_wait(frame.bodies.memory());
  ++taken_;
  last_step_ = state.clock.step;
}

void FrameWriter::put_on_disk(const Waiting& frame) {
  put_file(RunFolder::frame_name("bodies", frames_), frame.bodies);
  if (frame.has_obstacles) put_file(RunFolder::frame_name("obstacles", frames_), frame.obstacles);
  add_to_index(frame.time, frame.has_obstacles);
  if (std::chrono::steady_clock::now() - renewed_ >= between_renewals) renew_index();
}

void FrameWriter::put_file(const std::string& file, const PackedVtu& frame) {
  FileReplacement replacement(folder_ / file);
  write_vtu(replacement, frame);
  replacement.commit_unsynced();
}

/// The next frame, whose files are on the disk.
void FrameWriter::add_to_index(double time, bool has_obstacles) {
  std::vector<PvdEntry> entries{{time, 0, RunFolder::frame_name("bodies", frames_)}};
  if (has_obstacles) entries.push_back({time, 1, RunFolder::frame_name("obstacles", frames_)});
  index_.add(entries);
  ++frames_;
}

void FrameWriter::renew_index() {
  renewed_ = std::chrono::steady_clock::now();
  index_.write();
}

}  // namespace udar

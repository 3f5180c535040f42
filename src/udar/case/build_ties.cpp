#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "udar/base/error.hpp"
#include "udar/case/build_parts.hpp"
#include "udar/contact/search.hpp"

namespace udar {
namespace {

/// A node is tied when it lies within this part of the coarser of the two boundaries: chords of one circle, cut
/// differently, are a sixteenth apart where they span 30 degrees.
constexpr double reach_of_tie = 0.1;

/// Normals of the two boundaries at a tie are opposite to each other, so that the side of a body next to a tied edge is
/// not taken along.
constexpr double facing = -0.5;

/// The boundaries of two bodies as they are at rest.
class TwoBoundaries {
 public:
  explicit TwoBoundaries(const Model& model) : model_(model) {}

  /// The tie of a point to the boundary of a body; `stiffness` is 0 where it is too far away. Notes the smallest
  /// distance of any point.
  Tie tie(std::uint32_t point, Index body) {
    const Vec2 p = place(point);
    const Segment& from = model_.segments[model_.segment_from[point]];
    const auto where = [this](std::uint32_t c) { return place(c); };
    const Vec2 normal = unit(normal_between(model_.segments[from.before], from, where), {});
    Foot nearest{.distance = std::numeric_limits<double>::infinity()};
    for (std::uint32_t s = 0; s < model_.segments.size(); ++s) {
      if (model_.segments[s].body != body) continue;
      const Foot foot = foot_on(model_.segments, s, p, where);
      smallest_ = std::min(smallest_, std::fabs(foot.distance));
      if (std::fabs(foot.distance) >= std::fabs(nearest.distance)) continue;
      if (dot(unit(edge_normal(s), {}), normal) < facing) nearest = foot;
    }
    if (!std::isfinite(nearest.distance)) return {};
    const Segment& s = model_.segments[nearest.segment];
    const Vec2 a = place(s.a);
    const Vec2 along = place(s.b) - a;
    const double coarser = std::max(model_.contact_node_sizes[point], length(along));
    if (std::fabs(nearest.distance) > reach_of_tie * coarser) return {};
    return {.point = point,
            .segment = nearest.segment,
            .along = dot(p - a, along) / dot(along, along),
            .gap = dot(outward(along), p - a) / length(along),
            .stiffness = stiffness(point, nearest)};
  }
  [[nodiscard]] double smallest() const { return smallest_; }

 private:
  /// That of a touch, N/m; an automatic one of the edges that face the other body alone: at the end of a tied side the
  /// point has another edge, round its corner.
  [[nodiscard]] double stiffness(std::uint32_t point, const Foot& foot) const {
    const double all = model_.touch_stiffness(point, foot.segment, foot.along).normal;
    if (model_.body_pair(point, model_.segments[foot.segment].body).stiffness) return all;
    const std::uint32_t from = model_.segment_from[point];
    const Vec2 across = unit(edge_normal(foot.segment), {});
    double facing_edges = 0;  // m, half of them
    for (const std::uint32_t own : {model_.segments[from].before, from}) {
      const Vec2 out = edge_normal(own);
      if (dot(unit(out, {}), across) < facing) facing_edges += 0.5 * length(out);
    }
    // A point with a corner for a normal may have no edge that faces the other one enough.
    return facing_edges > 0 ? all * facing_edges / model_.contact_node_sizes[point] : all;
  }
  [[nodiscard]] Vec2 edge_normal(std::uint32_t segment) const {
    const Segment& s = model_.segments[segment];
    return outward(place(s.b) - place(s.a));
  }
  [[nodiscard]] Vec2 place(std::uint32_t point) const { return model_.rest[model_.contact_nodes[point]]; }

  const Model& model_;
  double smallest_ = std::numeric_limits<double>::infinity();
};

}  // namespace

void add_ties(Model& model) {
  std::vector<Tie> ties;
  for (const BodyPairs::Exception& pair : model.body_pairs.exceptions) {
    if (!pair.pair.tied) continue;
    TwoBoundaries boundaries(model);
    const std::size_t before = ties.size();
    for (std::uint32_t point = 0; point < model.contact_nodes.size(); ++point) {
      const Index own = model.contact_bodies[point];
      if (own != pair.first && own != pair.second) continue;
      const Tie tie = boundaries.tie(point, own == pair.first ? pair.second : pair.first);
      if (tie.stiffness > 0) ties.push_back(tie);
    }
    if (ties.size() > before) continue;
    throw UserError(
        ExitCode::bad_case,
        fmt::format("bodies `{}` and `{}` are to be tied, but they do not touch: their boundaries are {:.4g} "
                    "m apart",
                    model.bodies[pair.first].name, model.bodies[pair.second].name, boundaries.smallest()),
        "move one of them (`at` of its mesh) so that their boundaries lie on each other");
  }
  std::stable_sort(ties.begin(), ties.end(), [](const Tie& a, const Tie& b) { return a.point < b.point; });
  model.ties = std::move(ties);
}

}  // namespace udar

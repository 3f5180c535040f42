#include "udar/study/field_difference.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"

namespace udar {
namespace {

/// By name, where both runs tell names.
bool same_body(const FrameBody& a, const FrameBody& b) {
  return a.name.empty() || b.name.empty() ? a.number == b.number : a.name == b.name;
}

std::string called(const FrameBody& body) {
  return body.name.empty() ? fmt::format("number {}", body.number) : fmt::format("`{}`", body.name);
}

std::string folder_of(const RunFrames& run) { return run.files().folder.string(); }

const FrameBody& partner_of(const FrameBody& body, const std::vector<FrameBody>& others, const RunFrames& with,
                            const RunFrames& without) {
  const auto at = std::find_if(others.begin(), others.end(), [&](const FrameBody& b) { return same_body(body, b); });
  if (at != others.end()) return *at;
  throw UserError(ExitCode::usage,
                  fmt::format("the run `{}` has no body {}, which the run `{}` has", folder_of(without), called(body),
                              folder_of(with)),
                  "compare runs of one case, with other meshes or time steps");
}

/// Meshes of one shape may differ by the sagitta of their outermost sides: a disc of six nodes is 7 % of its diameter
/// lower on either side. More is another shape, or another place.
void check_boxes(const FrameBody& coarse, const FrameBody& fine, const RunFrames& a, const RunFrames& b) {
  const Vec2 size = fine.box.size();
  const double off =
      std::max({std::fabs(coarse.box.low.x - fine.box.low.x), std::fabs(coarse.box.low.y - fine.box.low.y),
                std::fabs(coarse.box.high.x - fine.box.high.x), std::fabs(coarse.box.high.y - fine.box.high.y)});
  if (off <= 0.1 * std::max(size.x, size.y)) return;
  throw UserError(ExitCode::usage,
                  fmt::format("the body {} has another shape or place in the run `{}` than in the run `{}`",
                              called(fine), folder_of(a), folder_of(b)),
                  "compare runs of one case, with other meshes or time steps");
}

/// The longest step of a run, s: a frame stands at the first step that is not before its time. Of a run that was killed
/// it is not known; then a small part of the way to the next frame.
double step_of(const RunFrames& run, std::size_t number) {
  const auto& summary = run.files().summary;
  if (summary && summary->time_step.max > 0) return summary->time_step.max;
  double interval = number > 0 ? run.time(number) - run.time(number - 1) : 0;
  if (number + 1 < run.count()) {
    const double next = run.time(number + 1) - run.time(number);
    interval = number > 0 ? std::min(interval, next) : next;
  }
  return 0.01 * interval;
}

/// A frame, whose mesh must be that of the first one.
Frame read_frame(const RunFrames& run, std::size_t number, const std::vector<Triangle>& triangles) {
  Frame frame = run.read(number);
  if (frame.triangles == triangles) return frame;
  throw OutputError(fmt::format("the frame of `{}` at {} s has another mesh than the first one\n  = run the case again",
                                folder_of(run), frame.time));
}

FieldDifference difference_of(FrameField field, const DifferenceSums& sums, double time, double apart) {
  return {.name = std::move(field.name),
          .unit = std::move(field.unit),
          .time = time,
          .l2 = sums.l2(),
          .size = sums.fine_l2(),
          .max = sums.max(),
          .largest = sums.largest(),
          .outside = sums.outside,
          .apart = apart};
}

}  // namespace

FramePair frames_at(const RunFrames& coarse, const RunFrames& fine, double time) {
  const FramePair pair{coarse.nearest(time), fine.nearest(time)};
  const double step = std::max(step_of(coarse, pair.coarse), step_of(fine, pair.fine));
  const double rounding = 1e-6 * fine.time(fine.count() - 1);
  const double tolerance = std::max(rounding, (1 + 1e-9) * step);
  const auto check = [&](const RunFrames& run, double found) {
    if (std::fabs(found - time) <= tolerance) return;
    throw UserError(
        ExitCode::usage,
        fmt::format("the run `{}` has no frame at {}; the nearest one is at {}", folder_of(run), in_units(time, "s"),
                    in_units(found, "s")),
        fmt::format("name the time of a frame, or run the case again with --set output.fields_at='[\"{} s\"]'",
                    shortest(time)));
  };
  check(coarse, coarse.time(pair.coarse));
  check(fine, fine.time(pair.fine));
  if (std::fabs(coarse.time(pair.coarse) - fine.time(pair.fine)) <= tolerance) return pair;
  throw UserError(ExitCode::usage,
                  fmt::format("the frames of `{}` and `{}` nearest to {} are more than a step apart", folder_of(coarse),
                              folder_of(fine), in_units(time, "s")),
                  fmt::format("run both cases again with --set output.fields_at='[\"{} s\"]'", shortest(time)));
}

FieldComparison::FieldComparison(RunFrames coarse, RunFrames fine)
    : coarse_(std::move(coarse)), fine_(std::move(fine)) {
  // The first frames: displacements are smallest there, so undeformed places are known best. And what is found does not
  // depend on which time is asked for first.
  Frame first_coarse = coarse_.read(0);
  Frame first_fine = fine_.read(0);
  const std::vector<FrameBody> coarse_bodies = bodies_of(coarse_, first_coarse);
  const std::vector<FrameBody> fine_bodies = bodies_of(fine_, first_fine);
  for (const FrameBody& body : coarse_bodies) partner_of(body, fine_bodies, coarse_, fine_);
  for (const FrameBody& body : fine_bodies) {
    const FrameBody& partner = partner_of(body, coarse_bodies, fine_, coarse_);
    check_boxes(partner, body, coarse_, fine_);
    bodies_.push_back(
        {body.rigid || partner.rigid, project(partner.mesh, body.mesh, std::max(body.blur, partner.blur))});
  }
  coarse_triangles_ = std::move(first_coarse.triangles);
  fine_triangles_ = std::move(first_fine.triangles);
}

std::vector<FieldDifference> FieldComparison::at(double time) const {
  const FramePair pair = frames_at(coarse_, fine_, time);
  const Frame a = read_frame(coarse_, pair.coarse, coarse_triangles_);
  const Frame b = read_frame(fine_, pair.fine, fine_triangles_);
  std::vector<FieldDifference> all;
  const auto compare = [&](const VtuArray& of_fine, const std::vector<VtuArray>& of_coarse, bool on_nodes) {
    const VtuArray* const of_other = find_array(of_coarse, of_fine.name);
    if (of_other == nullptr || of_other->components != of_fine.components) return;
    std::optional<FrameField> field = area_field(of_fine);
    const std::optional<FrameField> other = area_field(*of_other);
    if (!field || !other || (!on_nodes && field->components != 1)) return;
    DifferenceSums sums;
    for (const Body& body : bodies_) {
      if (on_nodes) add_nodes(body.projection, field->components, other->values, field->values, sums);
      if (!on_nodes && !body.rigid) add_elements(body.projection, other->values, field->values, sums);
    }
    if (sums.area.value() > 0) all.push_back(difference_of(*std::move(field), sums, b.time, a.time - b.time));
  };
  for (const VtuArray& array : b.bodies.point_fields) compare(array, a.bodies.point_fields, true);
  for (const VtuArray& array : b.bodies.cell_fields) compare(array, a.bodies.cell_fields, false);
  return all;
}

std::vector<FieldDifference> field_differences(const RunFrames& coarse, const RunFrames& fine, double time) {
  return FieldComparison(coarse, fine).at(time);
}

}  // namespace udar

#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "udar/base/vec2.hpp"

namespace udar {

/// A side of an element on the boundary of a body, from point a to point b with the body on its left. Points are
/// counted as the contact nodes of the model.
struct Segment {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t before = 0;  ///< the segment that ends in a
  std::uint32_t after = 0;   ///< the segment that begins in b
  std::uint32_t body = 0;
};

/// The nearest point of a boundary to a point.
struct Foot {
  std::uint32_t segment = 0;
  double along = 0;     ///< where on the segment: 0 in a, 1 in b
  double distance = 0;  ///< m, of the point; negative inside the body
  Vec2 normal{};        ///< unit vector out of the body: the gradient of the distance
};

/// Vector out of the body across a segment, as long as the segment.
constexpr Vec2 outward(Vec2 along) { return {along.y, -along.x}; }

/// Direction out of the body in the end that two segments share: the sum of their normals, not of unit length.
template <class Place>
Vec2 normal_between(const Segment& one, const Segment& two, Place&& place) {
  Vec2 sum;
  for (const Segment* s : {&one, &two}) {
    const Vec2 along = place(s->b) - place(s->a);
    const double size = length(along);
    if (size > 0) sum += (1 / size) * outward(along);
  }
  return sum;
}

/// `v` of length 1; `otherwise` where it has none.
inline Vec2 unit(Vec2 v, Vec2 otherwise) {
  const double size = length(v);
  return size > 0 ? (1 / size) * v : otherwise;
}

/// The nearest point of one segment. In an end of it, which two segments share, the mean of their normals tells inside
/// from outside (Baerentzen and Aanaes 2005). `place(point)` is where a point is, m.
template <class Place>
Foot foot_on(const std::vector<Segment>& segments, std::uint32_t number, Vec2 p, Place&& place) {
  const Segment& segment = segments[number];
  const Vec2 a = place(segment.a);
  const Vec2 b = place(segment.b);
  const Vec2 along = b - a;
  const double square = dot(along, along);
  const double part = square > 0 ? dot(p - a, along) / square : 0;
  if (part > 0 && part < 1) {
    const Vec2 normal = (1 / std::sqrt(square)) * outward(along);
    return {number, part, dot(normal, p - a), normal};
  }
  const bool at_b = part >= 1;
  const Vec2 mean = normal_between(segment, segments[at_b ? segment.after : segment.before], place);
  const Vec2 away = p - (at_b ? b : a);
  const double distance = length(away);
  const double end = at_b ? 1.0 : 0.0;
  if (!(distance > 0)) return {number, end, 0, unit(mean, {0, 1})};
  const double sign = dot(mean, away) < 0 ? -1 : 1;
  return {number, end, sign * distance, (sign / distance) * away};
}

/// Can a segment push a point whose body has this normal there? Not one that looks the same way: where the corners of
/// two bodies lie on each other, the side of one lies on the side of the other, and nothing would hold the corners
/// apart.
template <class Place>
bool faces(const Segment& segment, Vec2 normal, Place&& place) {
  constexpr double same_way = 0.5;
  const Vec2 along = place(segment.b) - place(segment.a);
  return dot(outward(along), normal) < same_way * length(along);
}

/// Where two segments that meet are equally near, inside a corner that points outwards, their common end counts, and
/// the way to it. Else rounding would choose between two forces, and what is symmetric would not stay so.
template <class Place>
Foot settle_tie(const std::vector<Segment>& segments, const Foot& foot, Vec2 p, Place&& place) {
  constexpr double near_end = 0.01;
  constexpr double rounding = 1e-7;
  if (!(foot.distance < 0) || !(foot.along < near_end || foot.along > 1 - near_end)) return foot;
  const bool at_b = foot.along > 0.5;
  const Segment& here = segments[foot.segment];
  const Foot other = foot_on(segments, at_b ? here.after : here.before, p, place);
  if (!(std::fabs(other.distance - foot.distance) <= -rounding * foot.distance)) return foot;
  const Vec2 way = place(at_b ? here.b : here.a) - p;
  const double distance = length(way);
  return {foot.segment, at_b ? 1.0 : 0.0, -distance, (1 / distance) * way};
}

/// The nearest point when the one on `number` was nearest a moment ago: from there to neighbours as long as they are
/// nearer, so that a point deep in a thin body is not handed over to its other side. `normal` is that of its own body.
template <class Place>
Foot follow_foot(const std::vector<Segment>& segments, std::uint32_t number, Vec2 p, Vec2 normal, Place&& place) {
  constexpr int most_segments = 16;
  Foot foot = foot_on(segments, number, p, place);
  for (int k = 0; k < most_segments; ++k) {
    const Foot last = foot;
    for (const std::uint32_t next : {segments[last.segment].before, segments[last.segment].after}) {
      const Foot there = foot_on(segments, next, p, place);
      if (std::fabs(there.distance) < std::fabs(foot.distance) && faces(segments[next], normal, place)) foot = there;
    }
    if (foot.segment == last.segment) break;
  }
  return settle_tie(segments, foot, p, place);
}

}  // namespace udar

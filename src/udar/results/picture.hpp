#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "udar/base/vec2.hpp"

namespace udar {

/// A number for each triangle, shown in colour with a bar that tells the scale.
struct PictureField {
  std::string name;            ///< "plastic strain"
  std::string unit;            ///< "MPa"; empty for plain numbers
  std::vector<double> values;  ///< one for each triangle; NaN is grey
  std::optional<double> min;   ///< colours begin here; none: at the smallest value
  std::optional<double> max;   ///< colours end here, larger values take the last; none: at the largest value
};

/// Triangles that stand out in a light colour, for example those that flow now.
struct PictureHighlight {
  std::string name;
  std::vector<std::uint8_t> flags;  ///< one for each triangle
};

/// A vector drawn around its place; the longest of a picture is as long as an arrow may be.
struct PictureArrow {
  Vec2 at{};     ///< m, its middle
  Vec2 value{};  ///< any unit, the same for all arrows
  std::string label;
};

struct PictureMarker {
  Vec2 at{};  ///< m
  std::string label;
};

struct PictureSupport {
  Vec2 at{};  ///< m
  bool holds_x = false;
  bool holds_y = false;
};

/// What a picture shows. Places are those of the deformed bodies, in m.
struct Picture {
  std::string title;
  std::string subtitle;
  std::vector<Vec2> points;
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< counter-clockwise
  /// Edges round the triangles, end to end, the triangles on their left; where there are none they are looked for.
  std::vector<std::array<std::int32_t, 2>> boundary;
  std::optional<PictureField> field;
  std::optional<PictureHighlight> highlight;  ///< not shown together with a field
  std::vector<std::vector<Vec2>> obstacles;   ///< closed outlines; may be far larger than the bodies, which are shown
  std::vector<PictureArrow> arrows;
  std::vector<PictureMarker> markers;
  std::vector<PictureSupport> supports;
};

/// The picture as an SVG file, 1000 px wide. Triangles of one colour are merged, so that 12 800 of them with their mesh
/// take less than 1 MB. Where mesh lines would be closer than 3 px they are left out, and colours become an image: no
/// number of triangles makes more than some MB. Time is linear in their number.
std::string to_svg(const Picture& picture);

}  // namespace udar

#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "udar/base/vec2.hpp"
#include "udar/results/outline.hpp"

namespace udar {

/// Which colours stand for the values of a field.
enum class ColourMap : std::uint8_t {
  rising,     ///< from dark to light
  two_sided,  ///< light in the middle, blue below, red above; for values of both signs about zero
};

/// A number for each triangle, shown in colour with a bar that tells the scale.
struct PictureField {
  std::string name;            ///< "plastic strain"
  std::string unit;            ///< "MPa"; empty for plain numbers
  std::vector<double> values;  ///< one for each triangle; NaN is grey
  std::optional<double> min;   ///< colours begin here; none: at the smallest value
  std::optional<double> max;   ///< colours end here, larger values take the last; none: at the largest value
  ColourMap colours = ColourMap::rising;
  bool at_points = false;  ///< `values` has one for each point; colours run evenly between them
};

/// Triangles that stand out in a light colour, for example those that flow now.
struct PictureHighlight {
  std::string name;
  std::vector<std::uint8_t> flags;  ///< one for each triangle: 1 stands out, 2 somewhat less, 0 not
  std::string second_name{};        ///< of those with 2
  std::string rest_name{};          ///< of those with 0
};

/// A vector drawn around its place; the longest of a picture is as long as an arrow may be.
struct PictureArrow {
  Vec2 at{};     ///< m, its middle
  Vec2 value{};  ///< any unit, the same for all arrows
  std::string label;
};

/// Thin arrows that begin at their places: forces of contact.
struct PictureForces {
  std::vector<Vec2> at;     ///< m
  std::vector<Vec2> value;  ///< N
  double longest = 0;       ///< N, as long as an arrow may be; 0: the largest of them
};

/// A load: arrows that end where it acts, or along the edges on which it is spread.
struct PictureLoad {
  std::vector<Vec2> at;     ///< m
  std::vector<Vec2> value;  ///< any unit, the same for all arrows of one load
  std::string label;
};

/// A turning about a place.
struct PictureSpin {
  Vec2 at{};         ///< m
  double value = 0;  ///< rad/s, counter-clockwise
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
  std::vector<std::string> obstacle_names;    ///< of the outlines, in their order; or none at all
  std::vector<PictureArrow> arrows;
  std::vector<PictureMarker> markers;
  std::vector<PictureSupport> supports;
  std::vector<PictureLoad> loads;
  std::vector<PictureSpin> spins;
  std::optional<PictureForces> forces;
  std::vector<PictureMarker> labels;  ///< words without a mark
  Vec2 gravity{};                     ///< m/s2, shown below the plot
  bool dimensions = false;            ///< tells how wide and high the bodies are together
  bool mesh = true;                   ///< draws the sides of the triangles, where they are not too close
  std::optional<Extent> view;         ///< m, what is shown; none: all bodies and what is near them
};

/// What a picture shows that says nothing itself: the bodies, whole obstacles where they are not much larger, and the
/// nearest part of larger ones; m.
Extent view_of(const Picture& picture);

/// "20 mm" for a length in m.
std::string length_text(double metres);
/// Three digits, without an exponent where that is short: "-1230", "0.15", "5e+06".
std::string number_text(double value);

/// The picture as an SVG file, 1000 px wide. Triangles of one colour are merged, so that 12 800 of them with their mesh
/// take less than 1 MB. Where mesh lines would be closer than 3 px they are left out, and colours become an image: no
/// number of triangles makes more than some MB. Time is linear in their number.
std::string to_svg(const Picture& picture);

}  // namespace udar

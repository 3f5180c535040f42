#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "udar/results/outline.hpp"
#include "udar/results/picture.hpp"
#include "udar/results/svg.hpp"

namespace udar {

constexpr std::string_view picture_ink = "#1d2733";
constexpr std::string_view picture_grey = "#5b6672";
constexpr std::string_view picture_highlight = "#f9e7b0";
constexpr std::string_view picture_second = "#c98a4b";
constexpr std::string_view picture_rest = "#3f5a78";  ///< of bodies of which something stands out
constexpr std::string_view picture_accent = "#c2371c";
constexpr std::string_view picture_force = "#6f2da8";
constexpr double picture_font_size = 14;

/// Where things are on the page, px; y points down there.
struct PicturePage {
  Extent view;       ///< m
  double scale = 1;  ///< px per m
  Vec2 corner{};     ///< upper left of the plot
  Vec2 size{};       ///< of the plot
  double left = 0;   ///< of everything
  double right = 0;
  bool is_fine = false;            ///< the mesh is too fine for its lines
  std::string_view clip = "plot";  ///< what nothing is drawn outside of
  std::vector<Extent> taken{};     ///< where no further label may go

  [[nodiscard]] Vec2 place(Vec2 point) const {
    return {corner.x + (point.x - view.low.x) * scale, corner.y + (view.high.y - point.y) * scale};
  }
  [[nodiscard]] Extent plot() const { return {corner, corner + size}; }
};

/// What the colours of a field stand for.
struct ColourRange {
  double min = 0;
  double max = 1;
  bool below = false;  ///< some values lie below `min`
  bool above = false;
};
ColourRange colour_range(const PictureField& field);
/// The colours from low to high.
std::span<const std::string_view> picture_colours(ColourMap map);

/// True where the triangles' sides are 3 px long on average, or less: lines and colours of single triangles would run
/// into each other.
bool is_fine_mesh(const PicturePage& page, const Picture& picture);

/// The first lines of an SVG file of this size, px, up to where things are drawn.
std::string picture_head(double width, double height);
/// That nothing is drawn outside of the plot: what `page.clip` names.
std::string clip_of(const PicturePage& page);

void draw_obstacles(Svg& svg, const PicturePage& page, const Picture& picture);
/// Fills and mesh lines, or, of a fine mesh, an image; then the outline.
void draw_bodies(Svg& svg, const PicturePage& page, const Picture& picture);
void draw_supports(Svg& svg, const PicturePage& page, const Picture& picture);
/// Markers first, so that arrows and labels keep clear of them.
void draw_markers(Svg& svg, PicturePage& page, const Picture& picture);
void draw_arrows(Svg& svg, PicturePage& page, const Picture& picture);
void draw_spins(Svg& svg, PicturePage& page, const Picture& picture);
/// Arrows; the box of the tails of each load, px, beside which its label goes.
std::vector<Extent> draw_loads(Svg& svg, PicturePage& page, const Picture& picture);
void draw_load_labels(Svg& svg, PicturePage& page, const Picture& picture, const std::vector<Extent>& tails);
void draw_forces(Svg& svg, const PicturePage& page, const Picture& picture);
void draw_dimensions(Svg& svg, PicturePage& page, const Picture& picture);
void draw_marker_labels(Svg& svg, PicturePage& page, const Picture& picture);
void draw_obstacle_names(Svg& svg, PicturePage& page, const Picture& picture);
/// Below `top`, px: how long a length is, what the colours mean.
void draw_legend(Svg& svg, const PicturePage& page, const Picture& picture, double top);

/// Which sides of its place a label tries, in this order: x right (1) or left (-1), y down (1), level (0) or up (-1).
using LabelSides = std::array<std::array<int, 2>, 6>;
constexpr LabelSides level_first{{{1, 0}, {-1, 0}, {1, -1}, {1, 1}, {-1, -1}, {-1, 1}}};
constexpr LabelSides above_first{{{1, -1}, {-1, -1}, {1, 0}, {-1, 0}, {1, 1}, {-1, 1}}};
/// Puts `words` near `at` where nothing lies yet, further out if need be; where all is taken, nowhere.
void place_label(Svg& svg, PicturePage& page, Vec2 at, double clearance, const LabelSides& sides,
                 std::string_view words);
/// An arrow from `tail` to `tip`, px, with a white rim.
void draw_arrow(Svg& svg, Vec2 tail, Vec2 tip, double line, std::string_view colour);

}  // namespace udar

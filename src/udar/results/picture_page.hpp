#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "udar/results/outline.hpp"
#include "udar/results/picture.hpp"
#include "udar/results/svg.hpp"

namespace udar {

constexpr std::string_view picture_ink = "#1d2733";
constexpr std::string_view picture_grey = "#5b6672";
constexpr std::string_view picture_highlight = "#f9e7b0";
constexpr std::string_view picture_accent = "#c2371c";
constexpr double picture_font_size = 13;

/// Where things are on the page, px; y points down there.
struct PicturePage {
  Extent view;       ///< m
  double scale = 1;  ///< px per m
  Vec2 corner{};     ///< upper left of the plot
  Vec2 size{};       ///< of the plot
  double left = 0;   ///< of everything
  double right = 0;
  bool is_fine = false;         ///< the mesh is too fine for its lines
  std::vector<Extent> taken{};  ///< where no further label may go

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
std::span<const std::string_view> picture_colours();

/// True where the triangles' sides are 3 px long on average, or less: lines and colours of single triangles would run
/// into each other.
bool is_fine_mesh(const PicturePage& page, const Picture& picture);

/// Fills and mesh lines, or, of a fine mesh, an image; then the outline.
void draw_bodies(Svg& svg, const PicturePage& page, const Picture& picture);
void draw_supports(Svg& svg, const PicturePage& page, const Picture& picture);
/// Markers first, so that arrows and labels keep clear of them.
void draw_markers(Svg& svg, PicturePage& page, const Picture& picture);
void draw_arrows(Svg& svg, PicturePage& page, const Picture& picture);
void draw_marker_labels(Svg& svg, PicturePage& page, const Picture& picture);
/// Below the plot: how long a length is, what the colours mean.
void draw_legend(Svg& svg, const PicturePage& page, const Picture& picture);

}  // namespace udar

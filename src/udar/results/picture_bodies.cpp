#include <algorithm>
#include <array>
#include <cmath>

#include "udar/results/picture_page.hpp"
#include "udar/results/png.hpp"

namespace udar {
namespace {

// Lightness in even steps of OKLab from dark blue over green to pale yellow: it grows with the value for every eye, in
// grey print too. Low values are dark so that what flows stands out light.
constexpr std::array<std::string_view, 24> rising_colours{
    "#2b1f64", "#282970", "#22347b", "#153f85", "#004b8a", "#045788", "#026189", "#016c8c",
    "#04768e", "#018091", "#008a93", "#049594", "#02a094", "#0daa92", "#02b68d", "#38bf87",
    "#5dc681", "#7bcc7c", "#95d279", "#aed778", "#c5dc7a", "#dbe17e", "#f0e685", "#ffeba1"};
// The same steps of lightness both ways from near white, with as much blue on one side as red on the other.
constexpr std::array<std::string_view, 25> two_sided_colours{
    "#004175", "#004e8a", "#115c9c", "#206bad", "#3879b8", "#4f88c2", "#6797c9", "#7ea6d0", "#94b5d7",
    "#abc3dd", "#c2d2e4", "#d9e1ea", "#f0f0f0", "#eaddda", "#e3cac4", "#dcb7ae", "#d5a499", "#cd9183",
    "#c47e6f", "#bb6b5a", "#b05947", "#a44734", "#923a29", "#812d1d", "#702111"};

// What stands for no value; then there come the colours of the field.
enum Paint : std::size_t { no_value_paint, body_paint, dark_body_paint, highlight_paint, second_paint, field_paint };
constexpr std::array<std::string_view, field_paint> plain_paints{"#9aa3ab", "#7d9cbb", picture_rest, picture_highlight,
                                                                 picture_second};

/// The colour of every paint of a picture.
std::vector<std::string_view> paints_of(const Picture& picture) {
  std::vector<std::string_view> paints(plain_paints.begin(), plain_paints.end());
  const auto colours = picture_colours(picture.field ? picture.field->colours : ColourMap::rising);
  paints.insert(paints.end(), colours.begin(), colours.end());
  return paints;
}

constexpr double closest_lines = 3;  ///< px, between lines of the mesh that are told from each other

/// What each triangle is filled with.
class Painter {
 public:
  explicit Painter(const Picture& picture)
      : picture_(picture),
        range_(picture.field ? colour_range(*picture.field) : ColourRange{}),
        colours_(picture_colours(picture.field ? picture.field->colours : ColourMap::rising).size()) {}

  /// Are all triangles filled alike?
  [[nodiscard]] bool is_plain() const { return !picture_.field && !picture_.highlight; }
  [[nodiscard]] std::size_t paint_of(std::size_t triangle) const {
    if (picture_.field && triangle < picture_.field->values.size()) return of_value(picture_.field->values[triangle]);
    if (!picture_.highlight || triangle >= picture_.highlight->flags.size()) return body_paint;
    const std::uint8_t flag = picture_.highlight->flags[triangle];
    return flag == 0 ? dark_body_paint : flag == 1 ? highlight_paint : second_paint;
  }
  [[nodiscard]] std::size_t of_value(double value) const {
    if (std::isnan(value)) return no_value_paint;
    const double part = std::clamp((value - range_.min) / (range_.max - range_.min), 0.0, 1.0);
    return field_paint + std::min(static_cast<std::size_t>(part * static_cast<double>(colours_)), colours_ - 1);
  }

 private:
  const Picture& picture_;
  ColourRange range_;
  std::size_t colours_;
};

/// Do colours change within a triangle?
bool is_smooth(const Picture& picture) {
  return picture.field && picture.field->at_points && picture.field->values.size() == picture.points.size();
}

/// Not of a failed run's points that are nowhere.
bool can_be_drawn(const Picture& picture, const Triangle& triangle) {
  return std::all_of(triangle.begin(), triangle.end(), [&](std::int32_t corner) {
    if (corner < 0 || static_cast<std::size_t>(corner) >= picture.points.size()) return false;
    const Vec2 point = picture.points[static_cast<std::size_t>(corner)];
    return std::isfinite(point.x) && std::isfinite(point.y);
  });
}

std::vector<Triangle> drawn_triangles(const Picture& picture) {
  std::vector<Triangle> drawn;
  std::copy_if(picture.triangles.begin(), picture.triangles.end(), std::back_inserter(drawn),
               [&](const Triangle& t) { return can_be_drawn(picture, t); });
  return drawn;
}

Vec2 place(const PicturePage& page, const Picture& picture, std::int32_t point) {
  return page.place(picture.points[static_cast<std::size_t>(point)]);
}

/// Closed polygons through `loops`. Of a fine mesh a corner less than half a px from the last one is left out.
std::string loops_path(const PicturePage& page, const Picture& picture, const std::vector<Loop>& loops) {
  const double closest = page.is_fine ? 0.5 : 0;
  PathData path;
  for (const Loop& loop : loops) {
    Vec2 last = place(page, picture, loop.front());
    path.move_to(last);
    for (std::size_t k = 1; k < loop.size(); ++k) {
      const Vec2 at = place(page, picture, loop[k]);
      if (length(at - last) < closest) continue;
      path.line_to(at);
      last = at;
    }
    path.close();
  }
  return path.text();
}

std::vector<Loop> outline_of_bodies(const Picture& picture) {
  const bool whole = std::all_of(picture.triangles.begin(), picture.triangles.end(),
                                 [&](const Triangle& t) { return can_be_drawn(picture, t); });
  if (whole && !picture.boundary.empty()) return loops_of(picture.boundary);
  return outline(whole ? picture.triangles : drawn_triangles(picture));
}

struct Shading {
  std::size_t paint;
  std::vector<Triangle> triangles;
};

/// The triangles that can be drawn, by colour.
std::vector<Shading> shade(const Picture& picture) {
  const Painter painter(picture);
  std::vector<Shading> shadings;
  for (std::size_t t = 0; t < picture.triangles.size(); ++t) {
    if (!can_be_drawn(picture, picture.triangles[t])) continue;
    const std::size_t paint = painter.paint_of(t);
    auto at = std::find_if(shadings.begin(), shadings.end(), [&](const Shading& s) { return s.paint == paint; });
    if (at == shadings.end()) at = shadings.insert(at, {paint, {}});
    at->triangles.push_back(picture.triangles[t]);
  }
  return shadings;
}

void fill_paths(Svg& svg, const PicturePage& page, const Picture& picture) {
  const std::vector<std::string_view> paints = paints_of(picture);
  for (const auto& [paint, triangles] : shade(picture)) {
    // The thin line of the same colour hides the seam that smoothing leaves between neighbours.
    svg.add(R"(<path d="{}" fill="{}" stroke="{}" stroke-width="0.6"/>)", loops_path(page, picture, outline(triangles)),
            paints[paint], paints[paint]);
  }
}

/// The dots whose middles lie from `low` to `high`, of `count`: from the first to before the second number.
std::array<std::size_t, 2> dots_between(double low, double high, std::size_t count) {
  const auto end = static_cast<double>(count);
  return {static_cast<std::size_t>(std::ceil(std::clamp(low - 0.5, 0.0, end))),
          static_cast<std::size_t>(std::floor(std::clamp(high + 0.5, 0.0, end)))};
}

/// Gives every dot whose middle lies in the triangle, corners in dots, the paint for its shares of the three corners.
template <class PaintAt>
void fill_triangle(DotImage& image, const std::array<Vec2, 3>& corners, PaintAt paint_at) {
  const auto [a, b, c] = corners;
  const auto [left, right] = dots_between(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), image.width);
  const auto [top, bottom] = dots_between(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), image.height);
  const double side = cross(b - a, c - a) < 0 ? -1 : 1;  // a crushed triangle may run the other way round
  for (std::size_t y = top; y < bottom; ++y) {
    for (std::size_t x = left; x < right; ++x) {
      const Vec2 p{static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5};
      const std::array shares{side * cross(c - b, p - b), side * cross(a - c, p - c), side * cross(b - a, p - a)};
      if (shares[0] < 0 || shares[1] < 0 || shares[2] < 0) continue;
      image.dots[y * image.width + x] = static_cast<std::uint8_t>(paint_at(shares) + 1);
    }
  }
}

/// The colours as an image, where paths round millions of dots of colour would make a file that no program opens. Its
/// size does not depend on the number of triangles. A dot shows the triangle in its middle.
void fill_image(Svg& svg, const PicturePage& page, const Picture& picture) {
  constexpr double dots_per_px = 2;  // sharp on fine screens and in print
  const Extent bodies = bounds(picture.points).common_with(page.view);
  if (bodies.empty()) return;
  const Vec2 corner = page.place({bodies.low.x, bodies.high.y});
  const Vec2 size = page.scale * bodies.size();
  DotImage image{.width = static_cast<std::size_t>(std::ceil(dots_per_px * size.x)) + 1,
                 .height = static_cast<std::size_t>(std::ceil(dots_per_px * size.y)) + 1,
                 .dots = {}};
  image.dots.resize(image.width * image.height);
  const Painter painter(picture);
  const bool smooth = is_smooth(picture);
  for (std::size_t t = 0; t < picture.triangles.size(); ++t) {
    if (!can_be_drawn(picture, picture.triangles[t])) continue;
    std::array<Vec2, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = dots_per_px * (place(page, picture, picture.triangles[t][k]) - corner);
    }
    if (smooth) {
      const auto value = [&](std::size_t k) {
        return picture.field->values[static_cast<std::size_t>(picture.triangles[t][k])];
      };
      const std::array values{value(0), value(1), value(2)};
      fill_triangle(image, corners, [&](const std::array<double, 3>& shares) {
        const double all = shares[0] + shares[1] + shares[2];
        if (!(all > 0)) return painter.of_value(values[0]);
        return painter.of_value((shares[0] * values[0] + shares[1] * values[1] + shares[2] * values[2]) / all);
      });
    } else {
      const std::size_t paint = painter.paint_of(t);
      fill_triangle(image, corners, [paint](const auto&) { return paint; });
    }
  }
  // The longer name of href, which older programs ask for.
  svg.add(R"(<image xmlns:xlink="http://www.w3.org/1999/xlink" x="{:.2f}" y="{:.2f}" width="{}" height="{}" )"
          R"(xlink:href="data:image/png;base64,{}"/>)",
          corner.x, corner.y, static_cast<double>(image.width) / dots_per_px,
          static_cast<double>(image.height) / dots_per_px, to_base64(to_png(image, paints_of(picture))));
}

void draw_mesh(Svg& svg, const PicturePage& page, const Picture& picture) {
  const auto edges = mesh_edges(drawn_triangles(picture));
  double total = 0;
  PathData path;
  for (const auto& [a, b] : edges) {
    const Vec2 from = place(page, picture, a);
    const Vec2 to = place(page, picture, b);
    total += length(to - from);
    path.move_to(from);
    path.line_to(to);
  }
  const double mean = total / std::max(1.0, static_cast<double>(edges.size()));
  if (mean <= closest_lines) return;
  const std::string_view colour =
      picture.field || picture.highlight ? "#8794a3" : picture_ink;  // seen on dark and on light fields
  svg.add(R"(<path d="{}" fill="none" stroke="{}" stroke-opacity="0.4" stroke-width="{:.2f}"/>)", path.text(), colour,
          std::clamp(0.04 * mean, 0.25, 0.8));
}

}  // namespace

std::span<const std::string_view> picture_colours(ColourMap map) {
  if (map == ColourMap::two_sided) return two_sided_colours;
  return rising_colours;
}

bool is_fine_mesh(const PicturePage& page, const Picture& picture) {
  double total = 0;
  double sides = 0;
  for (const Triangle& triangle : picture.triangles) {
    if (!can_be_drawn(picture, triangle)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto point = [&](std::size_t corner) { return picture.points[static_cast<std::size_t>(triangle[corner])]; };
      total += length(point((k + 1) % 3) - point(k));
    }
    sides += 3;
  }
  return sides > 0 && page.scale * total <= closest_lines * sides;
}

void draw_bodies(Svg& svg, const PicturePage& page, const Picture& picture) {
  const std::vector<Loop> loops = outline_of_bodies(picture);
  if (loops.empty()) return;
  const std::string path = loops_path(page, picture, loops);
  const bool as_image = page.is_fine || is_smooth(picture);
  if (Painter(picture).is_plain() && page.is_fine) {
    svg.add(R"(<path d="{}" fill="{}"/>)", path, plain_paints[body_paint]);
  } else if (as_image) {
    fill_image(svg, page, picture);
  } else {
    fill_paths(svg, page, picture);
  }
  if (!page.is_fine && picture.mesh) draw_mesh(svg, page, picture);
  svg.add(R"(<path d="{}" fill="none" stroke="{}" stroke-width="1.2" stroke-linejoin="round"/>)", path, picture_ink);
}

}  // namespace udar

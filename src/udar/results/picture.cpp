#include "udar/results/picture.hpp"

#include <algorithm>
#include <cmath>

#include "udar/results/outline.hpp"
#include "udar/results/picture_page.hpp"
#include "udar/results/svg.hpp"
#include "udar/results/xml.hpp"

namespace udar {
namespace {

constexpr double page_width = 1000;
constexpr double margin = 28;
constexpr double largest_plot_height = 640;
constexpr double footer_height = 66;

PicturePage lay_out(const Picture& picture) {
  PicturePage page{
      .view = picture.view ? *picture.view : view_of(picture), .left = margin, .right = page_width - margin};
  const double plot_width = page.right - page.left;
  const Vec2 size = page.view.size();
  page.scale = std::min(plot_width / size.x, largest_plot_height / size.y);
  page.size = page.scale * size;
  page.corner = {margin + 0.5 * (plot_width - page.size.x), picture.subtitle.empty() ? 56.0 : 78.0};
  page.is_fine = is_fine_mesh(page, picture);
  return page;
}

std::string polygon_path(const PicturePage& page, std::span<const Vec2> polygon) {
  PathData path;
  path.move_to(page.place(polygon.front()));
  for (const Vec2 point : polygon.subspan(1)) path.line_to(page.place(point));
  path.close();
  return path.text();
}

}  // namespace

Extent view_of(const Picture& picture) {
  Extent bodies = bounds(picture.points);
  for (const PictureMarker& marker : picture.markers) bodies.add(bounds({&marker.at, 1}));
  for (const PictureMarker& label : picture.labels) bodies.add(bounds({&label.at, 1}));
  if (bodies.empty()) {
    for (const auto& polygon : picture.obstacles) bodies.add(bounds(polygon));
  }
  if (bodies.empty()) return {{-1, -0.5}, {1, 0.5}};
  double extent = std::max(bodies.size().x, bodies.size().y);
  if (!(extent > 0)) extent = 1;
  const Extent near = bodies.grown(0.3 * extent);
  Extent view = bodies;
  for (const auto& polygon : picture.obstacles) {
    const Extent box = bounds(polygon);
    if (box.empty()) continue;
    if (bodies.grown(0.75 * extent).contains(box)) {
      view.add(box);
    } else if (near.overlaps(box)) {
      view.add(near.common_with(box));
    }
  }
  return view.grown((picture.dimensions ? 0.09 : 0.05) * extent);
}

void draw_obstacles(Svg& svg, const PicturePage& page, const Picture& picture) {
  const Extent around = page.view.grown(6 / page.scale);  // what is cut off is cut outside the plot
  for (const auto& outline_of_obstacle : picture.obstacles) {
    if (bounds(outline_of_obstacle).empty()) continue;
    const std::vector<Vec2> polygon = clipped(outline_of_obstacle, around);
    if (polygon.size() < 3) continue;
    const std::string path = polygon_path(page, polygon);
    svg.add(
        R"svg(<path d="{}" fill="#edf0f2"/><path d="{}" fill="url(#hatch)" stroke="#4d5863" stroke-width="1.4"/>)svg",
        path, path);
  }
}

std::string picture_head(double width, double height) {
  return fmt::format(
      R"svg(<svg xmlns="http://www.w3.org/2000/svg" width="{0:.0f}" height="{1:.0f}" viewBox="0 0 {0:.0f} {1:.0f}"
 font-family="Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif" font-size="{2}" fill="{3}">
<defs>
<pattern id="hatch" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">
<line x1="0" y1="0" x2="0" y2="7" stroke="#aab3bc" stroke-width="1.6"/>
</pattern>
</defs>
<rect width="100%" height="100%" fill="#ffffff"/>
)svg",
      width, height, picture_font_size, picture_ink);
}

std::string clip_of(const PicturePage& page) {
  return fmt::format(
      R"svg(<clipPath id="{}"><rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"/></clipPath>)svg", page.clip,
      page.corner.x, page.corner.y, page.size.x, page.size.y);
}

ColourRange colour_range(const PictureField& field) {
  double min = std::numeric_limits<double>::infinity();
  double max = -min;
  for (const double value : field.values) {
    if (!std::isfinite(value)) continue;
    min = std::min(min, value);
    max = std::max(max, value);
  }
  if (min > max) min = max = 0;
  if (min > 0 && min < 0.05 * max) min = 0;  // a bar from 0 reads more easily than one from 5.29e-06
  ColourRange range{.min = field.min.value_or(min), .max = field.max.value_or(max)};
  range.below = min < range.min;
  range.above = max > range.max;
  if (!(range.max > range.min)) range.max = range.min + (range.min == 0 ? 1 : std::fabs(range.min));
  return range;
}

std::string to_svg(const Picture& picture) {
  PicturePage page = lay_out(picture);
  Svg svg;
  const auto fitting = [&](const std::string& words, double size) {
    return std::min(size, (page.right - page.left) / std::max(1.0, text_width(words, 1)));
  };
  svg.text({page.left, 38}, picture.title, "start",
           fmt::format(R"(font-size="{:.1f}" font-weight="bold")", fitting(picture.title, 19)));
  std::string subtitle = picture.subtitle;
  if (page.is_fine && !picture.field && !subtitle.empty()) subtitle += "; the mesh is too fine to be drawn";
  svg.text({page.left, 60}, subtitle, "start",
           fmt::format(R"(font-size="{:.1f}" fill="{}")", fitting(subtitle, picture_font_size), picture_grey));
  svg.add("{}", clip_of(page));
  svg.add(R"svg(<g clip-path="url(#{})">)svg", page.clip);
  draw_obstacles(svg, page, picture);
  draw_bodies(svg, page, picture);
  draw_forces(svg, page, picture);
  svg.add("</g>");
  draw_supports(svg, page, picture);
  draw_markers(svg, page, picture);
  draw_dimensions(svg, page, picture);
  const std::vector<Extent> tails = draw_loads(svg, page, picture);
  draw_arrows(svg, page, picture);
  draw_spins(svg, page, picture);
  draw_load_labels(svg, page, picture, tails);
  draw_marker_labels(svg, page, picture);
  draw_obstacle_names(svg, page, picture);
  draw_legend(svg, page, picture, page.plot().high.y);
  return picture_head(page_width, page.plot().high.y + footer_height) + svg.body + "</svg>\n";
}

}  // namespace udar

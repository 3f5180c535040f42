#include "udar/report/strip.hpp"

#include <algorithm>
#include <cmath>

#include "udar/results/picture_page.hpp"

namespace udar {
namespace {

constexpr double width = 1000;
constexpr double margin = 28;
constexpr double between = 18;
constexpr double label_height = 24;
constexpr double footer_height = 66;
constexpr double largest_pane_height = 640;

/// The picture's own legend knows only its own values: what lies outside of the colours in any pane is told of all.
Picture legend_of(const PictureStrip& strip) {
  Picture legend = strip.pictures.front();
  if (!legend.field) return legend;
  for (const Picture& picture : strip.pictures) {
    const auto& values = picture.field->values;
    legend.field->values.insert(legend.field->values.end(), values.begin(), values.end());
  }
  return legend;
}

}  // namespace

std::string to_svg(const PictureStrip& strip) {
  const auto columns =
      static_cast<std::size_t>(std::clamp<int>(strip.columns, 1, static_cast<int>(strip.pictures.size())));
  const std::size_t rows = (strip.pictures.size() + columns - 1) / columns;
  const double pane_width =
      (width - 2 * margin - between * static_cast<double>(columns - 1)) / static_cast<double>(columns);
  const double top = strip.subtitle.empty() ? 56 : 78;

  Svg svg;
  svg.text({margin, 38}, strip.title, "start", R"(font-size="19" font-weight="bold")");
  svg.text({margin, 60}, strip.subtitle, "start", fmt::format(R"(fill="{}")", picture_grey));
  PicturePage page;
  double row_height = 0;
  for (std::size_t k = 0; k < strip.pictures.size(); ++k) {
    const Picture& picture = strip.pictures[k];
    const std::string clip = fmt::format("plot{}", k);
    page = {.view = picture.view ? *picture.view : view_of(picture), .left = margin, .right = width - margin};
    const Vec2 size = page.view.size();
    page.scale = std::min(pane_width / size.x, largest_pane_height / size.y);
    page.size = page.scale * size;
    page.clip = clip;
    const double left = margin + static_cast<double>(k % columns) * (pane_width + between);
    row_height = label_height + page.size.y + between;
    const std::size_t row = k / columns;
    page.corner = {left + 0.5 * (pane_width - page.size.x), top + static_cast<double>(row) * row_height + label_height};
    page.is_fine = is_fine_mesh(page, picture);
    svg.text({page.corner.x, page.corner.y - 7}, picture.title, "start", R"(font-weight="bold")");
    svg.add("{}", clip_of(page));
    svg.add(R"svg(<g clip-path="url(#{})">)svg", clip);
    draw_obstacles(svg, page, picture);
    draw_bodies(svg, page, picture);
    draw_forces(svg, page, picture);
    svg.add("</g>");
    svg.add(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="none" stroke="#c3cad1"/>)",
            page.corner.x, page.corner.y, page.size.x, page.size.y);
  }
  const double bottom = top + static_cast<double>(rows) * row_height - 0.5 * between;
  draw_legend(svg, page, legend_of(strip), bottom);
  return picture_head(width, bottom + footer_height) + svg.body + "</svg>\n";
}

}  // namespace udar

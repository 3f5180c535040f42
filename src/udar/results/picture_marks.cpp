#include <algorithm>
#include <array>
#include <cmath>

#include "udar/results/picture_page.hpp"

namespace udar {
namespace {

constexpr double marker_radius = 4;
constexpr std::string_view halo = R"(stroke="#ffffff" stroke-width="4" stroke-linejoin="round" paint-order="stroke")";

bool is_finite(Vec2 v) { return std::isfinite(v.x) && std::isfinite(v.y); }

/// The box of `words` whose middle left is at `at`.
Extent text_box(Vec2 at, double words_width) {
  return {at - Vec2{0, 0.6 * picture_font_size}, at + Vec2{words_width, 0.6 * picture_font_size}};
}

/// Which sides of its place a label tries, in this order: x right (1) or left (-1), y down (1), level (0) or up (-1).
using Sides = std::array<std::array<int, 2>, 6>;
constexpr Sides level_first{{{1, 0}, {-1, 0}, {1, -1}, {1, 1}, {-1, -1}, {-1, 1}}};
constexpr Sides above_first{{{1, -1}, {-1, -1}, {1, 0}, {-1, 0}, {1, 1}, {-1, 1}}};

/// Puts `words` near `at` where nothing lies yet, further out if need be.
void place_label(Svg& svg, PicturePage& page, Vec2 at, double clearance, const Sides& sides, std::string_view words) {
  if (words.empty()) return;
  const double words_width = text_width(words, picture_font_size);
  const auto box_at = [&](std::array<int, 2> side, double distance) {
    const double beside = side[1] == 0 ? distance : 0.5 * distance;
    const double x = side[0] > 0 ? at.x + beside : at.x - beside - words_width;
    return text_box({x, at.y + side[1] * 1.6 * distance}, words_width);
  };
  const auto is_free = [&](const Extent& box) {
    return page.plot().contains(box) &&
           std::none_of(page.taken.begin(), page.taken.end(), [&](const Extent& other) { return other.overlaps(box); });
  };
  Extent best = box_at(sides.front(), clearance);
  for (std::size_t i = 0; i < 3 * sides.size(); ++i) {
    const std::size_t round = i / sides.size();
    const Extent box = box_at(sides[i % sides.size()], clearance + 12.0 * static_cast<double>(round));
    if (!is_free(box)) continue;
    best = box;
    break;
  }
  page.taken.push_back(best);
  svg.text({best.low.x, best.centre().y + 0.36 * picture_font_size}, words, "start", halo);
}

/// "20 mm" for a length in m that is 1, 2 or 5 times a power of ten.
std::string length_text(double metres) {
  struct Unit {
    double size;
    std::string_view name;
  };
  for (const Unit unit : {Unit{1e3, "km"}, Unit{1, "m"}, Unit{1e-2, "cm"}, Unit{1e-3, "mm"}, Unit{1e-6, "µm"}}) {
    if (metres >= 0.999 * unit.size) return fmt::format("{:.4g} {}", metres / unit.size, unit.name);
  }
  return fmt::format("{:.4g} m", metres);
}

/// The largest of 1, 2 or 5 times a power of ten that is not above `value`.
double round_down(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= value) return digit * power;
  }
  return power;
}

void draw_scale_bar(Svg& svg, const PicturePage& page, double top) {
  const double metres = round_down(170 / page.scale);
  const double x = page.left;
  const double y = top + 30;
  svg.add(R"(<path d="M{0:.1f} {1:.1f}v8m0 -4h{2:.1f}m0 -4v8" fill="none" stroke="{3}" stroke-width="1.4"/>)", x, y - 4,
          metres * page.scale, picture_ink);
  svg.text({x + 0.5 * metres * page.scale, y - 10}, length_text(metres), "middle");
}

/// Three digits, without an exponent where that is short: "-1230", "0.15", "5e+06".
std::string number_text(double value) {
  const double size = std::fabs(value);
  if (size < 1e3 || size >= 1e6) return fmt::format("{:.3g}", value);
  const double last_digit = size < 1e4 ? 10 : size < 1e5 ? 100 : 1000;
  return fmt::format("{:.0f}", last_digit * std::round(value / last_digit));
}

void draw_colour_bar(Svg& svg, const PicturePage& page, const PictureField& field, double top) {
  constexpr double bar_width = 288;
  constexpr double bar_height = 11;
  const ColourRange range = colour_range(field);
  const auto colours = picture_colours();
  const double step = bar_width / static_cast<double>(colours.size());
  const double left = page.right - bar_width;
  const double y = top + 24;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    svg.add(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{}" fill="{}"/>)",
            left + step * static_cast<double>(i), y, step + 0.3, bar_height, colours[i]);
  }
  svg.add(R"(<rect x="{:.1f}" y="{:.1f}" width="{}" height="{}" fill="none" stroke="{}" stroke-width="0.8"/>)", left, y,
          bar_width, bar_height, picture_ink);
  const std::string unit = field.unit.empty() ? "" : " [" + field.unit + "]";
  svg.text({left, y - 8}, field.name + unit);
  const double middle = 0.5 * (range.min + range.max);
  const double under = y + bar_height + 16;
  svg.text({left, under}, (range.below ? "≤ " : "") + number_text(range.min));
  svg.text({left + 0.5 * bar_width, under}, number_text(middle), "middle");
  svg.text({page.right, under}, (range.above ? "≥ " : "") + number_text(range.max), "end");
}

void draw_swatch(Svg& svg, const PicturePage& page, std::string_view name, double top) {
  constexpr double side = 14;
  const double y = top + 22;
  svg.add(R"(<rect x="{:.1f}" y="{:.1f}" width="{}" height="{}" fill="{}" stroke="{}" stroke-width="0.8"/>)",
          page.right - side, y, side, side, picture_highlight, picture_ink);
  svg.text({page.right - side - 7, y + 0.85 * side}, name, "end");
}

/// The middle of an arrow moved aside until no marker lies on it.
Vec2 beside_markers(const PicturePage& page, const Picture& picture, Vec2 middle, double half, Vec2 direction) {
  constexpr double step = 45;
  const auto is_on_marker = [&](Vec2 place) {
    return std::any_of(picture.markers.begin(), picture.markers.end(), [&](const PictureMarker& marker) {
      const Vec2 off = page.place(marker.at) - place;
      return std::fabs(dot(off, direction)) < half + 8 && std::fabs(cross(off, direction)) < 12;
    });
  };
  for (const int steps : {0, 1, -1, 2, -2}) {
    const Vec2 place = middle + steps * step * perpendicular(direction);
    if (!is_on_marker(place)) return place;
  }
  return middle;
}

/// How far to turn the symbol of a support, which points up, so that it stands outside the body; degrees.
double support_turn(const PictureSupport& support, const Extent& bodies) {
  const Vec2 off = support.at - bodies.centre();
  const bool nearer_to_a_side = std::fabs(off.x) * bodies.size().y > std::fabs(off.y) * bodies.size().x;
  if (support.holds_x && (!support.holds_y || nearer_to_a_side)) return off.x <= 0 ? 90 : -90;
  return off.y <= 0 ? 0 : 180;
}

}  // namespace

void draw_supports(Svg& svg, const PicturePage& page, const Picture& picture) {
  constexpr double closest = 17;
  const Extent bodies = bounds(picture.points);
  std::vector<Vec2> drawn;
  for (const PictureSupport& support : picture.supports) {
    if (!is_finite(support.at)) continue;
    const Vec2 at = page.place(support.at);
    const auto is_near = [&](Vec2 other) { return length(other - at) < closest; };
    if (std::any_of(drawn.begin(), drawn.end(), is_near)) continue;
    drawn.push_back(at);
    const bool both = support.holds_x && support.holds_y;
    svg.add(R"svg(<path transform="translate({:.1f} {:.1f}) rotate({})" d="M0 0l5.5 9.5h-11zM-8 12h16" fill="{}" )svg"
            R"svg(stroke="{}" stroke-width="1.3" stroke-linejoin="round"/>)svg",
            at.x, at.y, support_turn(support, bodies), both ? picture_ink : "#ffffff", picture_ink);
  }
}

void draw_arrows(Svg& svg, PicturePage& page, const Picture& picture) {
  constexpr double longest = 72;
  double largest = 0;
  for (const PictureArrow& arrow : picture.arrows) {
    if (is_finite(arrow.value)) largest = std::max(largest, length(arrow.value));
  }
  for (const PictureArrow& arrow : picture.arrows) {
    const double size = length(arrow.value);
    if (!is_finite(arrow.at) || !is_finite(arrow.value) || !(size > 0)) continue;
    const double half = 0.5 * std::max(24.0, longest * size / largest);
    const Vec2 direction = {arrow.value.x / size, -arrow.value.y / size};
    const Vec2 middle = beside_markers(page, picture, page.place(arrow.at), half, direction);
    const Vec2 tip = middle + half * direction;
    const Vec2 tail = middle - half * direction;
    const Vec2 neck = tip - 11 * direction;
    const Vec2 side = 5 * perpendicular(direction);
    const auto draw = [&](std::string_view colour, double line, double edge) {
      svg.add(R"(<path d="M{:.1f} {:.1f}L{:.1f} {:.1f}" stroke="{}" stroke-width="{}"/>)"
              R"(<path d="M{:.1f} {:.1f}L{:.1f} {:.1f} {:.1f} {:.1f}z" fill="{}" stroke="{}" stroke-width="{}"/>)",
              tail.x, tail.y, neck.x, neck.y, colour, line, tip.x, tip.y, neck.x + side.x, neck.y + side.y,
              neck.x - side.x, neck.y - side.y, colour, colour, edge);
    };
    draw("#ffffff", 6, 4);
    draw(picture_accent, 2.6, 0.5);
    Extent box;
    for (const Vec2 point : {tip, tail, neck + side, neck - side}) box.add(point);
    page.taken.push_back(box.grown(3));
    place_label(svg, page, middle, 10 + 0.5 * box.size().x, level_first, arrow.label);
  }
}

void draw_markers(Svg& svg, PicturePage& page, const Picture& picture) {
  for (const PictureMarker& marker : picture.markers) {
    if (!is_finite(marker.at)) continue;
    const Vec2 at = page.place(marker.at);
    svg.add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{}" fill="#ffffff" stroke="{}" stroke-width="2"/>)", at.x, at.y,
            marker_radius, picture_accent);
    page.taken.push_back(Extent{at, at}.grown(marker_radius + 2));
  }
}

void draw_marker_labels(Svg& svg, PicturePage& page, const Picture& picture) {
  for (const PictureMarker& marker : picture.markers) {
    if (!is_finite(marker.at)) continue;
    place_label(svg, page, page.place(marker.at), marker_radius + 6, above_first, marker.label);
  }
}

void draw_legend(Svg& svg, const PicturePage& page, const Picture& picture) {
  const double top = page.plot().high.y;
  draw_scale_bar(svg, page, top);
  if (picture.field) {
    draw_colour_bar(svg, page, *picture.field, top);
  } else if (picture.highlight) {
    draw_swatch(svg, page, picture.highlight->name, top);
  }
}

}  // namespace udar

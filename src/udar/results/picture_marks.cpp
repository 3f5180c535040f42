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

void draw_colour_bar(Svg& svg, const PicturePage& page, const PictureField& field, double top) {
  constexpr double bar_width = 288;
  constexpr double bar_height = 11;
  const ColourRange range = colour_range(field);
  const auto colours = picture_colours(field.colours);
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

/// What the light colours mean, from the right edge to the left.
void draw_swatches(Svg& svg, const PicturePage& page, const PictureHighlight& highlight, double top) {
  constexpr double side = 14;
  const double y = top + 22;
  double right = page.right;
  for (const auto& [name, colour] :
       {std::pair<std::string_view, std::string_view>{highlight.name, picture_highlight},
        std::pair<std::string_view, std::string_view>{highlight.second_name, picture_second},
        std::pair<std::string_view, std::string_view>{highlight.rest_name, picture_rest}}) {
    if (name.empty()) continue;
    svg.add(R"(<rect x="{:.1f}" y="{:.1f}" width="{}" height="{}" fill="{}" stroke="{}" stroke-width="0.8"/>)",
            right - side, y, side, side, colour, picture_ink);
    svg.text({right - side - 7, y + 0.85 * side}, name, "end");
    right -= side + 34 + text_width(name, picture_font_size);
  }
}

/// The largest size of the forces.
double longest_force(const PictureForces& forces) {
  double longest = forces.longest;
  for (const Vec2 f : forces.value) {
    if (forces.longest == 0 && is_finite(f)) longest = std::max(longest, length(f));
  }
  return longest;
}

constexpr double longest_force_arrow = 56;  ///< px

void draw_force_legend(Svg& svg, const PicturePage& page, const PictureForces& forces, double top) {
  const double y = top + 29;
  const double longest = longest_force(forces);
  if (!(longest > 0)) {
    svg.text({page.right, y + 5}, "no contact", "end");
    return;
  }
  const auto [factor, prefix] = longest >= 1e6   ? std::pair{1e-6, "M"}
                                : longest >= 1e3 ? std::pair{1e-3, "k"}
                                                 : std::pair{1.0, ""};
  const std::string words = fmt::format("{} {}N, contact force on the bodies", number_text(factor * longest), prefix);
  const double tip = page.right - text_width(words, picture_font_size) - 12;
  svg.text({tip + 10, y + 5}, words);
  draw_arrow(svg, {tip - longest_force_arrow, y}, {tip, y}, 1.4, picture_force);
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

std::string number_text(double value) {
  const double size = std::fabs(value);
  std::string text = fmt::format("{:.3g}", size);
  if (size >= 1e3 && size < 1e6) {
    const double last_digit = size < 1e4 ? 10 : size < 1e5 ? 100 : 1000;
    text = fmt::format("{:.0f}", last_digit * std::round(size / last_digit));
  }
  return value < 0 ? "−" + text : text;
}

void place_label(Svg& svg, PicturePage& page, Vec2 at, double clearance, const LabelSides& sides,
                 std::string_view words) {
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
  for (std::size_t i = 0; i < 3 * sides.size(); ++i) {
    const std::size_t round = i / sides.size();
    const Extent box = box_at(sides[i % sides.size()], clearance + 12.0 * static_cast<double>(round));
    if (!is_free(box)) continue;
    page.taken.push_back(box);
    svg.text({box.low.x, box.centre().y + 0.36 * picture_font_size}, words, "start", halo);
    return;
  }
}

void draw_arrow(Svg& svg, Vec2 tail, Vec2 tip, double line, std::string_view colour) {
  const double size = length(tip - tail);
  if (!(size > 0)) return;
  const Vec2 direction = (1 / size) * (tip - tail);
  const double head = std::min(4.2 * line, 0.6 * size);  // a short arrow must not be all head
  const Vec2 neck = tip - head * direction;
  const Vec2 side = 0.45 * head * perpendicular(direction);
  const auto draw = [&](std::string_view paint, double width, double edge) {
    svg.add(R"(<path d="M{:.1f} {:.1f}L{:.1f} {:.1f}" stroke="{}" stroke-width="{:.1f}"/>)"
            R"(<path d="M{:.1f} {:.1f}L{:.1f} {:.1f} {:.1f} {:.1f}z" fill="{}" stroke="{}" stroke-width="{:.1f}"/>)",
            tail.x, tail.y, neck.x, neck.y, paint, width, tip.x, tip.y, neck.x + side.x, neck.y + side.y,
            neck.x - side.x, neck.y - side.y, paint, paint, edge);
  };
  draw("#ffffff", line + 2, 3);
  draw(colour, line, 0.5);
}

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
    draw_arrow(svg, tail, tip, 2.6, picture_accent);
    const Vec2 side = 5 * perpendicular(direction);
    Extent box;
    for (const Vec2 point : {tip + side, tail, tip - side}) box.add(point);
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
  for (const PictureMarker& label : picture.labels) {
    if (is_finite(label.at)) place_label(svg, page, page.place(label.at), 9, above_first, label.label);
  }
}

void draw_forces(Svg& svg, const PicturePage& page, const Picture& picture) {
  if (!picture.forces) return;
  const double longest = longest_force(*picture.forces);
  if (!(longest > 0)) return;
  for (std::size_t k = 0; k < picture.forces->at.size(); ++k) {
    const Vec2 force = picture.forces->value[k];
    const Vec2 arrow = longest_force_arrow / longest * Vec2{force.x, -force.y};
    if (!is_finite(picture.forces->at[k]) || !is_finite(force) || length(arrow) < 1) continue;
    const Vec2 tail = page.place(picture.forces->at[k]);
    draw_arrow(svg, tail, tail + arrow, 1.4, picture_force);
  }
}

void draw_legend(Svg& svg, const PicturePage& page, const Picture& picture, double top) {
  draw_scale_bar(svg, page, top);
  if (picture.field) {
    draw_colour_bar(svg, page, *picture.field, top);
  } else if (picture.highlight) {
    draw_swatches(svg, page, *picture.highlight, top);
  } else if (picture.forces) {
    draw_force_legend(svg, page, *picture.forces, top);
  }
  if (length(picture.gravity) > 0) {
    const Vec2 direction = (1 / length(picture.gravity)) * Vec2{picture.gravity.x, -picture.gravity.y};
    const Vec2 middle{page.left + 240, top + 28};
    draw_arrow(svg, middle - 13 * direction, middle + 13 * direction, 1.8, picture_grey);
    svg.text(middle + Vec2{22, 5}, fmt::format("gravity {} m/s²", number_text(length(picture.gravity))));
  }
}

}  // namespace udar

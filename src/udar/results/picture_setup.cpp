#include <algorithm>
#include <cmath>

#include "udar/results/picture_page.hpp"

// What the picture of a set-up has beside bodies and velocities: loads, spins, dimensions, names of obstacles.

namespace udar {
namespace {

bool is_finite(Vec2 v) { return std::isfinite(v.x) && std::isfinite(v.y); }

/// A thin line with a stroke at each end and words in its middle; `from` and `to` in px.
void draw_dimension(Svg& svg, PicturePage& page, Vec2 from, Vec2 to, const std::string& words) {
  const Vec2 along = (1 / length(to - from)) * (to - from);
  const Vec2 across = 5 * perpendicular(along);
  svg.add(R"(<path d="M{:.1f} {:.1f}L{:.1f} {:.1f}M{:.1f} {:.1f}L{:.1f} {:.1f}M{:.1f} {:.1f}L{:.1f} {:.1f}" )"
          R"(fill="none" stroke="{}" stroke-width="1"/>)",
          from.x, from.y, to.x, to.y, from.x - across.x, from.y - across.y, from.x + across.x, from.y + across.y,
          to.x - across.x, to.y - across.y, to.x + across.x, to.y + across.y, picture_grey);
  const Vec2 middle = 0.5 * (from + to);
  const double half = 0.5 * text_width(words, picture_font_size);
  const bool upright = std::fabs(along.y) > 0.5;
  const Vec2 at = upright ? middle + Vec2{8, 5} : middle + Vec2{0, -7};
  svg.text(at, words, upright ? "start" : "middle", fmt::format(R"(fill="{}")", picture_grey));
  const Vec2 low = upright ? at - Vec2{0, 12} : at - Vec2{half, 12};
  page.taken.push_back({low, low + Vec2{2 * half, 16}});
  Extent line{from, from};
  line.add(to);
  page.taken.push_back(line.grown(3));
}

/// Arrows of a load, where they do not come too close; the box of their tails, px.
Extent draw_load(Svg& svg, PicturePage& page, const PictureLoad& load) {
  constexpr double longest = 34;  // px
  constexpr double closest = 22;
  Extent tails;
  double largest = 0;
  for (const Vec2 value : load.value) {
    if (is_finite(value)) largest = std::max(largest, length(value));
  }
  if (!(largest > 0)) return tails;
  std::vector<Vec2> tips;
  for (std::size_t k = 0; k < load.at.size(); ++k) {
    if (!is_finite(load.at[k]) || !is_finite(load.value[k])) continue;
    const Vec2 tip = page.place(load.at[k]);
    const auto is_near = [&](Vec2 other) { return length(other - tip) < closest; };
    if (std::any_of(tips.begin(), tips.end(), is_near)) continue;
    tips.push_back(tip);
    const Vec2 tail = tip - longest / largest * Vec2{load.value[k].x, -load.value[k].y};
    draw_arrow(svg, tail, tip, 1.8, picture_force);
    tails.add(tail);
    Extent box{tip, tip};
    box.add(tail);
    page.taken.push_back(box.grown(3));
  }
  return tails;
}

}  // namespace

void draw_dimensions(Svg& svg, PicturePage& page, const Picture& picture) {
  const Extent bodies = bounds(picture.points);
  if (!picture.dimensions || bodies.empty() || !(bodies.size().x > 0) || !(bodies.size().y > 0)) return;
  constexpr double beside = 18;  // px
  const Vec2 high_left = page.place({bodies.low.x, bodies.high.y});
  const Vec2 low_right = page.place({bodies.high.x, bodies.low.y});
  const Vec2 high_right{low_right.x, high_left.y};
  draw_dimension(svg, page, high_left - Vec2{0, beside}, high_right - Vec2{0, beside}, length_text(bodies.size().x));
  draw_dimension(svg, page, high_right + Vec2{beside, 0}, low_right + Vec2{beside, 0}, length_text(bodies.size().y));
}

std::vector<Extent> draw_loads(Svg& svg, PicturePage& page, const Picture& picture) {
  std::vector<Extent> tails;
  for (const PictureLoad& load : picture.loads) tails.push_back(draw_load(svg, page, load));
  return tails;
}

void draw_load_labels(Svg& svg, PicturePage& page, const Picture& picture, const std::vector<Extent>& tails) {
  constexpr LabelSides outside_first{{{-1, 0}, {1, 0}, {-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t k = 0; k < tails.size(); ++k) {
    if (tails[k].empty()) continue;
    place_label(svg, page, tails[k].centre(), 10 + 0.5 * tails[k].size().x, outside_first, picture.loads[k].label);
  }
}

void draw_spins(Svg& svg, PicturePage& page, const Picture& picture) {
  constexpr double radius = 24;  // px
  for (const PictureSpin& spin : picture.spins) {
    if (!is_finite(spin.at) || spin.value == 0 || !std::isfinite(spin.value)) continue;
    const Vec2 at = page.place(spin.at);
    // Three quarters of a circle from the right; y points down on the page.
    const double up = spin.value > 0 ? -1 : 1;
    const Vec2 end = at + radius * Vec2{0, -up};
    svg.add(R"(<path d="M{:.1f} {:.1f}A{} {} 0 1 {} {:.1f} {:.1f}" fill="none" stroke="#ffffff" stroke-width="4.5"/>)"
            R"(<path d="M{:.1f} {:.1f}A{} {} 0 1 {} {:.1f} {:.1f}" fill="none" stroke="{}" stroke-width="2.4"/>)",
            at.x + radius, at.y, radius, radius, spin.value > 0 ? 0 : 1, end.x, end.y, at.x + radius, at.y, radius,
            radius, spin.value > 0 ? 0 : 1, end.x, end.y, picture_accent);
    draw_arrow(svg, end, end + Vec2{12, 0}, 2.4, picture_accent);
    page.taken.push_back(Extent{at, at}.grown(radius + 3));
    place_label(svg, page, at, radius + 8, level_first, spin.label);
  }
}

void draw_obstacle_names(Svg& svg, PicturePage& page, const Picture& picture) {
  if (picture.obstacle_names.size() != picture.obstacles.size()) return;
  for (std::size_t k = 0; k < picture.obstacles.size(); ++k) {
    const Extent seen = bounds(clipped(picture.obstacles[k], page.view));
    if (seen.empty()) continue;
    // In the middle of what is seen of it, or beside that.
    const Vec2 at = page.place(seen.centre());
    const double half = 0.5 * text_width(picture.obstacle_names[k], picture_font_size);
    place_label(svg, page, at - Vec2{half, 0}, 0, level_first, picture.obstacle_names[k]);
  }
}

}  // namespace udar

#include "udar/results/svg.hpp"

#include <algorithm>
#include <cmath>

#include "udar/results/xml.hpp"

namespace udar {

void PathData::move_to(Vec2 point) {
  x_ = std::lround(10 * point.x);
  y_ = std::lround(10 * point.y);
  data_ += 'M';
  number(x_);
  data_ += ' ';
  number(y_);
}

void PathData::line_to(Vec2 point) {
  const long x = std::lround(10 * point.x);
  const long y = std::lround(10 * point.y);
  data_ += 'l';
  number(x - x_);
  if (y >= y_) data_ += ' ';  // a minus sign parts numbers by itself
  number(y - y_);
  x_ = x;
  y_ = y;
}

void PathData::number(long tenths) {
  fmt::format_to(std::back_inserter(data_), "{}", static_cast<double>(tenths) / 10);
}

void Svg::text(Vec2 at, std::string_view words, std::string_view anchor, std::string_view style) {
  if (words.empty()) return;
  add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" {}>{}</text>)", at.x, at.y, anchor, style, escape_xml(words));
}

double text_width(std::string_view words, double font_size) {
  const auto is_start = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
  return 0.62 * font_size * static_cast<double>(std::count_if(words.begin(), words.end(), is_start));
}

}  // namespace udar

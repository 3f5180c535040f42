#pragma once

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <string_view>

#include "udar/base/vec2.hpp"
#include "udar/results/outline.hpp"

namespace udar {

/// Path data in tenths of a pixel, each corner relative to the one before: half the size of plain numbers.
class PathData {
 public:
  void move_to(Vec2 point);
  void line_to(Vec2 point);
  void close() { data_ += 'z'; }
  [[nodiscard]] const std::string& text() const { return data_; }

 private:
  void number(long tenths);

  std::string data_;
  long x_ = 0;
  long y_ = 0;
};

/// The elements of an SVG file, one a line. Lengths in px, y downwards.
struct Svg {
  std::string body{};

  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(body), format, std::forward<Values>(values)...);
    body += '\n';
  }
  /// Words on one line, escaped; `anchor` is start, middle or end; `style`: further attributes.
  void text(Vec2 at, std::string_view words, std::string_view anchor = "start", std::string_view style = "");
};

/// About how wide `words` are, px; rather too wide than too narrow.
double text_width(std::string_view words, double font_size);

}  // namespace udar

#include "udar/report/page.hpp"

#include <fmt/format.h>

#include "udar/base/error.hpp"

namespace udar {
namespace {

constexpr std::string_view block_begin = "<script type=\"text/plain\" id=\"block-";
constexpr std::string_view block_middle = "\">";
constexpr std::string_view element_end = "</script>\n";

}  // namespace

std::size_t block_bytes(std::size_t text_bytes) {
  constexpr std::size_t digits = 6;
  return text_bytes + block_begin.size() + digits + block_middle.size() + element_end.size();
}

Json Blocks::add(PackedArray array) {
  Json out{{"block", texts_.size()}, {"rows", array.rows}, {"columns", array.columns}, {"bytes", array.bytes}};
  if (array.is_float) out["float"] = true;
  if (array.low) {
    out["low"] = *array.low;
    out["step"] = array.step;
  }
  if (array.none) out["none"] = *array.none;
  bytes_ += block_bytes(array.text.size());
  texts_.push_back(std::move(array.text));
  return out;
}

void Blocks::cut(std::size_t count) {
  for (; texts_.size() > count; texts_.pop_back()) bytes_ -= block_bytes(texts_.back().size());
}

std::string safe_json(const Json& json) {
  // Names that are not UTF-8 must not stop the report.
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size() + text.size() / 16);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    // U+2028 and U+2029 are E2 80 A8 and A9.
    const bool separator =
        c == '\xE2' && i + 2 < text.size() && text[i + 1] == '\x80' && (text[i + 2] == '\xA8' || text[i + 2] == '\xA9');
    if (separator) {
      out += text[i + 2] == '\xA8' ? "\\u2028" : "\\u2029";
      i += 2;
    } else if (c == '<' || c == '>' || c == '&') {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out;
}

void compose(std::string_view page, std::string_view run, const Blocks& blocks,
             const std::function<void(std::string_view)>& take) {
  constexpr std::string_view place = "<!-- the run -->";
  const std::size_t at = page.find(place);
  if (at == std::string_view::npos || page.find(place, at + 1) != std::string_view::npos) {
    throw OutputError("the viewer has not one place for the run; build it again");
  }
  take(page.substr(0, at));
  take("<script type=\"application/json\" id=\"run\">");
  take(run);
  take(element_end);
  for (std::size_t b = 0; b < blocks.count(); ++b) {
    take(block_begin);
    take(fmt::format("{}{}", b, block_middle));
    take(blocks.texts()[b]);
    take(element_end);
  }
  take(page.substr(at + place.size()));
}

}  // namespace udar

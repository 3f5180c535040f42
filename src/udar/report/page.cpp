#include "udar/report/page.hpp"

#include <fmt/format.h>

#include "udar/base/error.hpp"
#include "udar/results/file.hpp"

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

std::size_t Blocks::bytes_of(std::size_t block) const {
  return texts_[block].size() + block_begin.size() + std::to_string(block).size() + block_middle.size() +
         element_end.size();
}

Json Blocks::add(PackedArray array) {
  Json out{{"block", texts_.size()}, {"rows", array.rows}, {"columns", array.columns}, {"bytes", array.bytes}};
  if (array.is_float) out["float"] = true;
  if (array.low) {
    out["low"] = *array.low;
    out["step"] = array.step;
  }
  if (array.none) out["none"] = *array.none;
  texts_.push_back(std::move(array.text));
  bytes_ += bytes_of(texts_.size() - 1);
  return out;
}

void Blocks::cut(std::size_t count) {
  for (; texts_.size() > count; texts_.pop_back()) bytes_ -= bytes_of(texts_.size() - 1);
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

std::size_t page_bytes(std::string_view page) {
  std::size_t bytes = 0;
  compose(page, "", {}, [&](std::string_view piece) { bytes += piece.size(); });
  return bytes;
}

std::size_t write_page(const std::filesystem::path& path, std::string_view page, std::string_view run,
                       const Blocks& blocks) {
  std::size_t bytes = 0;
  FileReplacement file(path);
  compose(page, run, blocks, [&](std::string_view piece) {
    file.write(piece);
    bytes += piece.size();
  });
  file.commit();
  return bytes;
}

std::string megabytes(std::size_t bytes) { return fmt::format("{:.3g} MB", 1e-6 * static_cast<double>(bytes)); }

}  // namespace udar

#include "udar/results/xml.hpp"

#include <array>
#include <charconv>
#include <utility>

#include "udar/base/error.hpp"

namespace udar {
namespace {

constexpr std::array<std::pair<char, std::string_view>, 5> entities{
    {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&apos;"}}};

/// Bytes of the UTF-8 character that `text` begins with; 0 where it is not one that XML allows.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(i < text.size() ? text[i] : 0); };
  const unsigned char first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  const bool overlong = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
  const bool surrogate = first == 0xed && byte(1) >= 0xa0;
  const bool beyond_unicode = first == 0xf4 && byte(1) >= 0x90;
  const bool not_a_character = first == 0xef && byte(1) == 0xbf && byte(2) >= 0xbe;
  return overlong || surrogate || beyond_unicode || not_a_character ? 0 : length;
}

std::string unescape(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    std::size_t used = 1;
    char c = text.front();
    for (const auto& [plain, entity] : entities) {
      if (!text.starts_with(entity)) continue;
      c = plain;
      used = entity.size();
    }
    out += c;
    text.remove_prefix(used);
  }
  return out;
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

XmlTag parse_tag(std::string_view text) {
  XmlTag tag;
  tag.closing = text.starts_with('/');
  if (tag.closing) text.remove_prefix(1);
  if (text.ends_with('/')) text.remove_suffix(1);
  const std::size_t name_end = std::min(text.find_first_of(" \t\r\n"), text.size());
  tag.name = text.substr(0, name_end);
  for (text = trimmed(text.substr(name_end)); !text.empty(); text = trimmed(text)) {
    const std::size_t open = text.find("=\"");
    const std::size_t close = open == std::string_view::npos ? open : text.find('"', open + 2);
    if (close == std::string_view::npos) throw OutputError("broken attribute in <" + tag.name + ">");
    tag.attributes[std::string(trimmed(text.substr(0, open)))] = unescape(text.substr(open + 2, close - open - 2));
    text.remove_prefix(close + 1);
  }
  return tag;
}

}  // namespace

std::string escape_xml(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    std::string_view piece = length == 0 ? std::string_view("?") : text.substr(0, length);
    for (const auto& [plain, entity] : entities) {
      if (text.front() == plain) piece = entity;
    }
    out += piece;
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out;
}

std::string XmlTag::attribute(std::string_view key) const {
  const auto found = attributes.find(key);
  return found == attributes.end() ? "" : found->second;
}

std::optional<std::size_t> XmlTag::count(std::string_view key) const {
  const std::string text = attribute(key);
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<XmlTag> XmlScanner::next() {
  for (;;) {
    const std::size_t open = text_.find('<', position_);
    if (open == std::string_view::npos) return std::nullopt;
    const bool comment = text_.substr(open).starts_with("<!--");
    const std::size_t close = comment ? text_.find("-->", open) : text_.find('>', open);
    if (close == std::string_view::npos) throw OutputError("a tag is not closed");
    position_ = close + (comment ? 3 : 1);
    if (comment || text_[open + 1] == '?' || text_[open + 1] == '!') continue;
    return parse_tag(text_.substr(open + 1, close - open - 1));
  }
}

}  // namespace udar

#include "udar/case/document.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

#include "udar/case/ascii.hpp"
#include "udar/case/path.hpp"
#include "udar/units/quantity.hpp"

// The parser asserts on texts that it then refuses properly; see ascii.hpp for the rest of the guard.
#define TOML_ASSERT(condition) static_assert(true)
#define TOML_HEADER_ONLY 1
#define TOML_ENABLE_FORMATTERS 0
#define TOML_MAX_NESTED_VALUES 16
#include <toml++/toml.h>

namespace udar {
namespace {

/// Copies the parser's tree into ours, with places in the user's own text.
class Importer {
 public:
  explicit Importer(const AsciiText& ascii) : ascii_(ascii) {}

  Value value(const toml::node& node) const {
    Value out;
    out.place = place(node.source());
    if (const toml::table* table = node.as_table()) {
      for (const auto& [key, child] : *table) {
        out.entries.push_back({std::string(key.str()), place(key.source()), value(child)});
      }
      const auto position = [](const Entry& e) { return std::pair(e.place.line, e.place.column); };
      std::ranges::stable_sort(out.entries, {}, position);
    } else if (const toml::array* array = node.as_array()) {
      out.kind = Value::Kind::list;
      for (const toml::node& child : *array) out.items.push_back(value(child));
    } else if (const auto* text = node.as_string()) {
      out.kind = Value::Kind::text;
      out.text = text->get();
    } else if (node.is_boolean()) {
      out.kind = Value::Kind::boolean;
      out.number = node.value_or(false) ? 1 : 0;
    } else if (const auto number = node.value<double>(); number && node.is_number()) {
      out.kind = Value::Kind::number;
      out.number = *number;
    } else if (const auto* integer = node.as_integer()) {
      out.kind = Value::Kind::number;
      out.number = static_cast<double>(integer->get());
    } else {
      out.kind = Value::Kind::date;
    }
    return out;
  }

  Place place(const toml::source_region& region) const {
    const int line = static_cast<int>(region.begin.line);
    const int begin = ascii_.user_column(line, static_cast<int>(region.begin.column));
    const bool one_line = region.end.line == region.begin.line;
    const int end = one_line ? ascii_.user_column(line, static_cast<int>(region.end.column)) : begin + 1;
    return {0, line, begin, std::max(1, end - begin)};
  }

 private:
  const AsciiText& ascii_;
};

std::string_view line_of(std::string_view text, int line) {
  std::size_t begin = 0;
  for (int i = 1; i < line; ++i) {
    begin = text.find('\n', begin);
    if (begin == std::string_view::npos) return "";
    ++begin;
  }
  std::string_view out = text.substr(begin, text.find('\n', begin) - begin);
  if (out.ends_with('\r')) out.remove_suffix(1);
  if (line == 1 && out.starts_with("\xef\xbb\xbf")) out.remove_prefix(3);
  return out;
}

/// What the user most likely meant on a line that is no TOML: nearly always the quotes are missing.
std::string missing_quotes(std::string_view line) {
  const auto equals = line.find('=');
  if (equals == std::string_view::npos) return "";
  std::string_view value = line.substr(equals + 1);
  value = value.substr(0, value.find('#'));
  while (value.starts_with(' ')) value.remove_prefix(1);
  while (value.ends_with(' ')) value.remove_suffix(1);
  if (value.find_first_of("\"'[]{},") != std::string_view::npos || value.empty()) return "";
  const auto quantity = parse_quantity(value);
  const bool word =
      std::ranges::all_of(value, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; });
  if ((quantity && !quantity->bare) || (!quantity && word)) {
    return fmt::format("did you mean \"{}\", in double quotes?", shown(value));
  }
  return "";
}

/// The parser's words without their preamble; a key given twice is a mistake of its own.
std::pair<std::string, std::string> message_and_pointer(std::string_view description) {
  if (const auto at = description.find("cannot redefine existing "); at != std::string_view::npos) {
    const auto open = description.find('\'', at);
    const auto close = description.rfind('\'');
    if (open < close) {
      return {fmt::format("`{}` is given twice", shown(description.substr(open + 1, close - open - 1))),
              "the second one is here"};
    }
  }
  if (description.find("maximum nested value depth") != std::string_view::npos) {
    return {"values nested too deeply", fmt::format("at most {} levels are read", deepest_key)};
  }
  const auto colon = description.find(": ");
  std::string_view reason = colon == std::string_view::npos ? description : description.substr(colon + 2);
  return {"this is not TOML", printable(reason.substr(0, 160))};
}

}  // namespace

const Entry* Value::find(std::string_view key) const {
  for (const Entry& entry : entries) {
    if (entry.key == key) return &entry;
  }
  return nullptr;
}

std::string kind_name(Value::Kind kind) {
  switch (kind) {
    case Value::Kind::boolean:
      return "a truth value";
    case Value::Kind::number:
      return "a number";
    case Value::Kind::text:
      return "a text";
    case Value::Kind::list:
      return "a list";
    case Value::Kind::table:
      return "a table";
    default:
      return "a date or time";
  }
}

Place Document::place_of(std::string_view path) const {
  const Value* value = &root;
  Place place;
  for (const std::string_view part : parts_of(path)) {
    if (value->kind == Value::Kind::list) {
      std::size_t index = 0;
      std::from_chars(part.data(), part.data() + part.size(), index);
      if (index >= value->items.size()) return place;
      value = &value->items[index];
      place = value->place;
    } else {
      const Entry* entry = value->find(part);
      if (entry == nullptr) return place;
      value = &entry->value;
      place = value->place.line == 0 ? entry->place : value->place;
    }
  }
  return place;
}

Diagnostic diagnostic_at(std::span<const Source> sources, const Place& place, std::string message, std::string pointer,
                         std::string cure) {
  const Source& source = sources[static_cast<std::size_t>(place.source)];
  Diagnostic out{
      .file = source.name, .message = std::move(message), .pointer = std::move(pointer), .cure = std::move(cure)};
  if (place.line == 0) return out;
  const std::string_view line = line_of(source.text, place.line);
  constexpr std::size_t longest_line = 400;  // no caret is found in a longer one
  if (line.size() > longest_line) {
    out.file += fmt::format(":{}:{}", place.line, place.column);
    return out;
  }
  out.line = place.line;
  out.column = place.column;
  out.length = place.length;
  out.source = printable(line);
  return out;
}

tl::expected<Document, Diagnostic> parse_document(std::string_view text, std::string_view name) {
  Document document{{{std::string(name), ""}}, {}};
  const auto ascii = to_ascii(text);
  // An oversized text is not kept: no diagnostic points into it.
  if (text.size() <= largest_document) document.sources[0].text = text;
  if (!ascii) {
    const TextError& e = ascii.error();
    return tl::unexpected(diagnostic_at(document.sources, {0, e.line, e.column, 1}, e.message, e.pointer, e.cure));
  }
  const Importer importer(*ascii);
  try {
    document.root = importer.value(toml::parse(ascii->text));
    document.root.place = {};
    return document;
  } catch (const toml::parse_error& error) {
    const Place place = importer.place(error.source());
    const auto [message, pointer] = message_and_pointer(error.description());
    const std::string cure = missing_quotes(line_of(document.sources[0].text, place.line));
    return tl::unexpected(diagnostic_at(document.sources, place, message, pointer, cure));
  }
}

}  // namespace udar

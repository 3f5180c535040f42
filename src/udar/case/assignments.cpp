#include <fmt/core.h>

#include <algorithm>
#include <charconv>

#include "udar/case/ascii.hpp"
#include "udar/case/document.hpp"
#include "udar/case/path.hpp"

namespace udar {
namespace {

constexpr std::string_view usage = "write --set bodies.beam.mesh.element_size=\"0.25 cm\"";

bool is_key(std::string_view part) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !part.empty() && std::ranges::all_of(part, allowed);
}

void set_source(Value& value, int source) {
  value.place.source = source;
  for (Value& item : value.items) set_source(item, source);
  for (Entry& entry : value.entries) {
    entry.place.source = source;
    set_source(entry.value, source);
  }
}

/// The value right of the `=`. The text before it is replaced by spaces and a short key, so that places are right.
tl::expected<Value, Diagnostic> value_of(std::string_view assignment, std::size_t equals, int source) {
  const std::string_view text = assignment.substr(equals + 1);
  auto parsed = parse_document(std::string(equals - 1, ' ') + "v=" + std::string(text), "--set");
  const Entry* entry = parsed && parsed->root.entries.size() == 1 ? parsed->root.find("v") : nullptr;
  if (entry != nullptr) {
    Value value = entry->value;
    set_source(value, source);
    return value;
  }
  const bool meant_as_toml = text.starts_with('[') || text.starts_with('{') || text.starts_with('"');
  if (!parsed && meant_as_toml) {
    parsed.error().source = printable(assignment);
    return tl::unexpected(parsed.error());
  }
  Value value;
  value.kind = Value::Kind::text;
  value.text = text;
  value.place = {source, 1, static_cast<int>(equals) + 2, std::max(1, static_cast<int>(text.size()))};
  return value;
}

/// The value of one part of the path below `from`; made if it is missing from a table. Null where there can be none.
Value* step_into(Value& from, std::string_view part, const Place& place) {
  if (from.kind == Value::Kind::table) {
    const auto found = std::ranges::find(from.entries, part, &Entry::key);
    if (found != from.entries.end()) return &found->value;
    Entry made{std::string(part), place, {}};
    made.value.place = place;
    return &from.entries.emplace_back(std::move(made)).value;
  }
  if (from.kind != Value::Kind::list) return nullptr;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  const bool exists = error == std::errc{} && end == part.data() + part.size() && index < from.items.size();
  return exists ? &from.items[index] : nullptr;
}

std::string why_no_step(const Value& from) {
  if (from.kind != Value::Kind::list) return fmt::format("this is below {}, not below a table", kind_name(from.kind));
  return fmt::format("the list has {} items, counted from 0", from.items.size());
}

}  // namespace

tl::expected<void, Diagnostic> assign(Document& document, std::string_view assignment) {
  const int source = static_cast<int>(document.sources.size());
  document.sources.push_back({"--set", std::string(assignment)});
  const auto mistake = [&](int column, std::size_t length, std::string message, std::string pointer) {
    const Place place{source, 1, column, std::max(1, static_cast<int>(length))};
    return tl::unexpected(
        diagnostic_at(document.sources, place, std::move(message), std::move(pointer), std::string(usage)));
  };

  const auto equals = assignment.find('=');
  if (equals == std::string_view::npos || equals == 0 || assignment.size() > largest_document) {
    return mistake(1, std::min<std::size_t>(assignment.size(), 60), "unreadable assignment", "key=value is needed");
  }
  const auto parts = parts_of(assignment.substr(0, equals));
  if (parts.size() > deepest_key)
    return mistake(1, equals, "key with too many parts", fmt::format("at most {} are read", deepest_key));

  Value* value = &document.root;
  int column = 1;
  for (const std::string_view part : parts) {
    if (!is_key(part))
      return mistake(column, part.size(), "unreadable key", "letters, digits, `_` and `-` are read here");
    Value* next = step_into(*value, part, {source, 1, column, static_cast<int>(part.size())});
    if (next == nullptr)
      return mistake(column, part.size(), fmt::format("there is no `{}`", part), why_no_step(*value));
    value = next;
    column += static_cast<int>(part.size()) + 1;
  }
  const auto read = value_of(assignment, equals, source);
  if (!read) return tl::unexpected(read.error());
  *value = *read;
  return {};
}

}  // namespace udar

#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "udar/base/error.hpp"

namespace udar {

/// A piece of the text that a value or a key was read from.
struct Place {
  int source = 0;  ///< 0: the case file; n: the n-th assignment of the command line
  int line = 0;    ///< from 1; 0: nowhere in particular
  int column = 0;  ///< from 1, in characters
  int length = 1;  ///< characters, within the line
};

struct Entry;

/// A value of a TOML document. Dates and times are kept only to say that they are of no use.
struct Value {
  enum class Kind { boolean, number, text, list, table, date };
  Kind kind = Kind::table;
  double number = 0;  ///< of a boolean 1 or 0
  std::string text;
  std::vector<Value> items;    ///< of a list
  std::vector<Entry> entries;  ///< of a table, in the order of the file
  Place place;

  [[nodiscard]] const Entry* find(std::string_view key) const;
};

struct Entry {
  std::string key;
  Place place;  ///< of the key
  Value value;
};

/// What the user calls a kind of value: "a text", "a list".
std::string kind_name(Value::Kind kind);

struct Source {
  std::string name;
  std::string text;
};

struct Document {
  std::vector<Source> sources;
  Value root;

  /// The place of the value at `path` ("observe.nodes.0.at"); where there is none, of the innermost table around it.
  [[nodiscard]] Place place_of(std::string_view path) const;
};

/// A diagnostic at a place of one of the sources, with its line of text.
Diagnostic diagnostic_at(std::span<const Source> sources, const Place& place, std::string message, std::string pointer,
                         std::string cure);

/// Reads a TOML text. `name` is what diagnostics call the file.
tl::expected<Document, Diagnostic> parse_document(std::string_view text, std::string_view name);

/// Carries out `a.b.0.c=value` on the document. The value is read as TOML or else taken as a text; missing tables are
/// made.
tl::expected<void, Diagnostic> assign(Document& document, std::string_view assignment);

}  // namespace udar

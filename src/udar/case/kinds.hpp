#pragma once

#include <optional>
#include <string>
#include <vector>

#include "udar/base/time_table.hpp"
#include "udar/base/vec2.hpp"
#include "udar/case/case.hpp"
#include "udar/case/document.hpp"
#include "udar/case/mistakes.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// A kind of value that a key of a case file can have. Each knows four things:
///   describe  what the documentation says of it: "a velocity", "above 0"
///   read      from the document into the Case; mistakes in what is written
///   check     limits of the value, however it came into the Case
///   write     as TOML that reads back to the same bits; "" where leaving it out says the same
/// and `example` shows one. `path` is that of the value.

/// "1 m", or a number where no unit belongs: as TOML.
std::string toml_number(double value);
std::string toml_text(std::string_view text);

/// Adds "wrong kind of value".
void wrong_kind(const Value& value, const std::string& path, const std::string& needed, const std::string& example,
                Mistakes& mistakes);

/// true or false.
struct YesNoKind {
  [[nodiscard]] std::string describe() const { return "true or false"; }
  [[nodiscard]] std::string example() const { return "true"; }
  void read(const Value& value, const std::string& path, bool& out, Mistakes& mistakes) const;
  void check(bool, const std::string&, Mistakes&) const {}
  [[nodiscard]] std::string write(bool value) const { return value ? "true" : "false"; }
};

/// A number with unit: "80 m/s".
struct QuantityKind {
  Dimension dimension;
  Limits limits{};

  [[nodiscard]] std::string describe() const;
  [[nodiscard]] std::string example() const { return example_of(dimension); }
  void read(const Value& value, const std::string& path, double& out, Mistakes& mistakes) const;
  void check(double value, const std::string& path, Mistakes& mistakes) const;
  [[nodiscard]] std::string write(double value) const;
};

/// Two quantities, x and y.
struct VectorKind {
  QuantityKind each;

  [[nodiscard]] std::string describe() const { return "[x, y], each " + each.describe(); }
  [[nodiscard]] std::string example() const;
  void read(const Value& value, const std::string& path, Vec2& out, Mistakes& mistakes) const;
  void read(const Value& value, const std::string& path, std::optional<Vec2>& out, Mistakes& mistakes) const;
  void check(const Vec2& value, const std::string& path, Mistakes& mistakes) const;
  void check(const std::optional<Vec2>& value, const std::string& path, Mistakes& mistakes) const;
  [[nodiscard]] std::string write(const Vec2& value) const;
  [[nodiscard]] std::string write(const std::optional<Vec2>& value) const { return value ? write(*value) : ""; }
};

/// Points, as many as are allowed or, where the key may be left out, none.
struct PointsKind {
  QuantityKind each;
  std::size_t least = 1;
  std::size_t most = static_cast<std::size_t>(-1);
  bool may_be_empty = false;

  [[nodiscard]] std::string describe() const;
  [[nodiscard]] std::string example() const;
  void read(const Value& value, const std::string& path, std::vector<Vec2>& out, Mistakes& mistakes) const;
  void check(const std::vector<Vec2>& value, const std::string& path, Mistakes& mistakes) const;
  [[nodiscard]] std::string write(const std::vector<Vec2>& value) const;
};

/// A list of quantities.
struct ListKind {
  QuantityKind each;

  [[nodiscard]] std::string describe() const { return "list, each " + each.describe(); }
  [[nodiscard]] std::string example() const { return "[" + each.example() + "]"; }
  void read(const Value& value, const std::string& path, std::vector<double>& out, Mistakes& mistakes) const;
  void check(const std::vector<double>& value, const std::string& path, Mistakes& mistakes) const;
  [[nodiscard]] std::string write(const std::vector<double>& value) const;
};

/// A quantity, or a word that leaves the choice to the program: "auto".
struct QuantityOrWordKind {
  QuantityKind quantity;
  std::string word;

  [[nodiscard]] std::string describe() const { return "\"" + word + "\" or " + quantity.describe(); }
  [[nodiscard]] std::string example() const { return quantity.example(); }
  void read(const Value& value, const std::string& path, std::optional<double>& out, Mistakes& mistakes) const;
  void check(const std::optional<double>& value, const std::string& path, Mistakes& mistakes) const;
  [[nodiscard]] std::string write(const std::optional<double>& value) const;
};

/// One of some words, in the order of an enum.
struct WordKind {
  std::vector<std::string> words;

  [[nodiscard]] std::string describe() const;
  [[nodiscard]] std::string example() const { return toml_text(words.front()); }
  /// The number of the word; none where it is not one of them.
  std::optional<int> read_word(const Value& value, const std::string& path, Mistakes& mistakes) const;
  template <class Enum>
  void read(const Value& value, const std::string& path, Enum& out, Mistakes& mistakes) const {
    if (const auto word = read_word(value, path, mistakes)) out = static_cast<Enum>(*word);
  }
  template <class Enum>
  void check(Enum, const std::string&, Mistakes&) const {}
  template <class Enum>
  [[nodiscard]] std::string write(Enum value) const {
    return toml_text(words.at(static_cast<std::size_t>(value)));
  }
};

/// A name: letters, digits, `_` and `-` only, since files are called by it.
struct NameKind {
  std::string what;  ///< "name of a material"
  std::string instance = "a-name";
  bool may_be_empty = false;

  [[nodiscard]] std::string describe() const { return what; }
  [[nodiscard]] std::string example() const { return toml_text(instance); }
  void read(const Value& value, const std::string& path, std::string& out, Mistakes& mistakes) const;
  void check(const std::string& value, const std::string& path, Mistakes& mistakes) const;
  [[nodiscard]] std::string write(const std::string& value) const { return value.empty() ? "" : toml_text(value); }
};

/// A value that may change with time: a constant or { times, values, shape }.
struct TimeTableKind {
  QuantityKind each;

  [[nodiscard]] std::string describe() const { return each.describe() + ", or { times, values, shape } of it"; }
  [[nodiscard]] std::string example() const;
  void read(const Value& value, const std::string& path, TimeTable& out, Mistakes& mistakes) const;
  void read(const Value& value, const std::string& path, std::optional<TimeTable>& out, Mistakes& mistakes) const;
  void check(const TimeTable& value, const std::string& path, Mistakes& mistakes) const;
  void check(const std::optional<TimeTable>& value, const std::string& path, Mistakes& mistakes) const;
  [[nodiscard]] std::string write(const TimeTable& value) const;
  [[nodiscard]] std::string write(const std::optional<TimeTable>& value) const { return value ? write(*value) : ""; }
};

/// From when to when: two times, the second one possibly "end".
struct WindowKind {
  [[nodiscard]] std::string describe() const { return "[from, to]: two times; the second may be \"end\""; }
  [[nodiscard]] std::string example() const { return "[\"0 s\", \"0.5 ms\"]"; }
  void read(const Value& value, const std::string& path, Window& out, Mistakes& mistakes) const;
  void check(const Window& value, const std::string& path, Mistakes& mistakes) const;
  [[nodiscard]] std::string write(const Window& value) const;
};

/// Whether `name` can be the name of something; says so if not.
bool check_name(const std::string& name, const std::string& path, Mistakes& mistakes,
                std::optional<Place> place = std::nullopt);

}  // namespace udar

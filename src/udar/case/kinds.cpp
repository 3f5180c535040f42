#include "udar/case/kinds.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "udar/base/text.hpp"
#include "udar/case/ascii.hpp"
#include "udar/case/path.hpp"
#include "udar/units/quantity.hpp"

namespace udar {
namespace {

using Kind = Value::Kind;

constexpr double largest_sensible = 1e30;  // squares and products of four such values are still finite

std::string bound(double value, Dimension dimension) { return value == 0 ? "0" : si_text(value, dimension); }

/// "above 0 and below 0.5"; "" without limits.
std::string limits_text(const Limits& limits, Dimension dimension) {
  std::string low;
  std::string high;
  if (std::isfinite(limits.low)) {
    low = (limits.low_included ? "at least " : "above ") + bound(limits.low, dimension);
  }
  if (std::isfinite(limits.high)) {
    high = (limits.high_included ? "at most " : "below ") + bound(limits.high, dimension);
  }
  return low + (low.empty() || high.empty() ? "" : " and ") + high;
}

/// Reads the items of a list; the list must have between `least` and `most` of them.
template <class Read>
void read_items(const Value& list, const std::string& path, Read read) {
  for (std::size_t i = 0; i < list.items.size(); ++i) read(list.items[i], join(path, std::to_string(i)), i);
}

template <class Items, class Write>
std::string list_text(const Items& items, Write write) {
  std::string out;
  for (const auto& item : items) out += (out.empty() ? "" : ", ") + write(item);
  return "[" + out + "]";
}

}  // namespace

std::string toml_number(double value) {
  // -0 would be read as an integer, which has no sign at 0.
  return value == 0 && std::signbit(value) ? "-0.0" : shortest(value);
}

std::string toml_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04X}", static_cast<int>(c));
    } else {
      if (c == '"' || c == '\\') out += '\\';
      out += c;
    }
  }
  return out + "\"";
}

void wrong_kind(const Value& value, const std::string& path, const std::string& needed, const std::string& example,
                Mistakes& mistakes) {
  mistakes.add({path, fmt::format("wrong kind of value for `{}`", shown(key_of(path))),
                fmt::format("this is {}; {} is needed", kind_name(value.kind), needed),
                example.empty() ? "" : fmt::format("write it like {}", example), value.place});
}

// --- one quantity

std::string QuantityKind::describe() const {
  const std::string range = limits_text(limits, dimension);
  return dimension_name(dimension) + (range.empty() ? "" : ", " + range);
}

void YesNoKind::read(const Value& value, const std::string& path, bool& out, Mistakes& mistakes) const {
  if (value.kind != Kind::boolean) return wrong_kind(value, path, describe(), example(), mistakes);
  out = value.number != 0;
}

void QuantityKind::read(const Value& value, const std::string& path, double& out, Mistakes& mistakes) const {
  const auto refuse = [&](const UnitError& error) {
    mistakes.add(
        {path, fmt::format("{} for `{}`", error.what, shown(key_of(path))), error.reason, error.cure, value.place});
  };
  if (value.kind == Kind::text) {
    const auto parsed = parse_si(value.text, dimension);
    if (!parsed) return refuse(parsed.error());
    out = *parsed;
  } else if (value.kind != Kind::number) {
    wrong_kind(value, path, dimension_name(dimension), example(), mistakes);
  } else if (dimension != dimension::number) {
    refuse(missing_unit(shortest(value.number), dimension));
  } else {
    out = value.number;
  }
}

void QuantityKind::check(double value, const std::string& path, Mistakes& mistakes) const {
  const bool sensible = std::fabs(value) <= largest_sensible;
  if (sensible && limits.hold(value)) return;
  const std::string range =
      sensible ? limits_text(limits, dimension) : "no larger than " + si_text(largest_sensible, dimension);
  mistakes.add_unless_touched({path, fmt::format("impossible value for `{}`", key_of(path)),
                               fmt::format("this is {}", si_text(value, dimension)),
                               fmt::format("it must be {}", range)});
}

std::string QuantityKind::write(double value) const {
  return dimension == dimension::number ? toml_number(value) : toml_text(si_text(value, dimension));
}

// --- several quantities

std::string VectorKind::example() const {
  const std::string x = each.limits.hold(0) ? each.write(0) : each.example();
  return "[" + x + ", " + each.example() + "]";
}

void VectorKind::read(const Value& value, const std::string& path, Vec2& out, Mistakes& mistakes) const {
  if (value.kind != Kind::list) return wrong_kind(value, path, "[x, y]", example(), mistakes);
  if (value.items.size() != 2) {
    mistakes.add({path, fmt::format("wrong number of values for `{}`", shown(key_of(path))),
                  fmt::format("there are {}; two are needed, [x, y]", value.items.size()),
                  fmt::format("write it like {}", example()), value.place});
    return;
  }
  each.read(value.items[0], join(path, "0"), out.x, mistakes);
  each.read(value.items[1], join(path, "1"), out.y, mistakes);
}

void VectorKind::read(const Value& value, const std::string& path, std::optional<Vec2>& out, Mistakes& mistakes) const {
  read(value, path, out.emplace(), mistakes);
}

void VectorKind::check(const Vec2& value, const std::string& path, Mistakes& mistakes) const {
  each.check(value.x, join(path, "0"), mistakes);
  each.check(value.y, join(path, "1"), mistakes);
}

void VectorKind::check(const std::optional<Vec2>& value, const std::string& path, Mistakes& mistakes) const {
  if (value) check(*value, path, mistakes);
}

std::string VectorKind::write(const Vec2& value) const {
  return "[" + each.write(value.x) + ", " + each.write(value.y) + "]";
}

std::string PointsKind::describe() const {
  const std::string count = least == most ? fmt::format("{} ", least)
                            : least > 1   ? fmt::format("at least {} ", least)
                                          : "";
  return count + "points [x, y], each " + each.describe();
}

std::string PointsKind::example() const {
  std::string out = "[\"0 cm\", \"0 cm\"], [\"4 cm\", \"0 cm\"]";
  if (most > 2) out += ", [\"4 cm\", \"3 cm\"]";
  return "[" + out + "]";
}

void PointsKind::read(const Value& value, const std::string& path, std::vector<Vec2>& out, Mistakes& mistakes) const {
  if (value.kind != Kind::list) return wrong_kind(value, path, "a list of points", example(), mistakes);
  out.resize(value.items.size());
  read_items(value, path, [&](const Value& item, const std::string& item_path, std::size_t i) {
    VectorKind{each}.read(item, item_path, out[i], mistakes);
  });
}

void PointsKind::check(const std::vector<Vec2>& value, const std::string& path, Mistakes& mistakes) const {
  if (value.empty() && may_be_empty) return;
  if (value.size() < least || value.size() > most) {
    const std::string needed = fmt::format("{}{}", least == most ? "" : "at least ", least);
    mistakes.add_unless_touched({path, fmt::format("wrong number of points for `{}`", key_of(path)),
                                 fmt::format("there are {}; {} are needed", value.size(), needed),
                                 fmt::format("write it like {}", example())});
    return;
  }
  for (std::size_t i = 0; i < value.size(); ++i) {
    VectorKind{each}.check(value[i], join(path, std::to_string(i)), mistakes);
  }
}

std::string PointsKind::write(const std::vector<Vec2>& value) const {
  if (value.empty()) return "";
  return list_text(value, [&](Vec2 point) { return VectorKind{each}.write(point); });
}

void ListKind::read(const Value& value, const std::string& path, std::vector<double>& out, Mistakes& mistakes) const {
  if (value.kind != Kind::list) return wrong_kind(value, path, "a list", example(), mistakes);
  out.resize(value.items.size());
  read_items(value, path, [&](const Value& item, const std::string& item_path, std::size_t i) {
    each.read(item, item_path, out[i], mistakes);
  });
}

void ListKind::check(const std::vector<double>& value, const std::string& path, Mistakes& mistakes) const {
  for (std::size_t i = 0; i < value.size(); ++i) each.check(value[i], join(path, std::to_string(i)), mistakes);
}

std::string ListKind::write(const std::vector<double>& value) const {
  return list_text(value, [&](double item) { return each.write(item); });
}

void QuantityOrWordKind::read(const Value& value, const std::string& path, std::optional<double>& out,
                              Mistakes& mistakes) const {
  if (value.kind == Kind::text && value.text == word) {
    out.reset();
    return;
  }
  const bool begins_like_word = value.kind == Kind::text && !value.text.empty() && value.text[0] >= 'A';
  if (!begins_like_word) return quantity.read(value, path, out.emplace(), mistakes);
  mistakes.add({path, fmt::format("unknown word for `{}`", shown(key_of(path))),
                fmt::format("{} is needed", describe()), fmt::format("write \"{}\" or {}", word, example()),
                value.place});
}

void QuantityOrWordKind::check(const std::optional<double>& value, const std::string& path, Mistakes& mistakes) const {
  if (value) quantity.check(*value, path, mistakes);
}

std::string QuantityOrWordKind::write(const std::optional<double>& value) const {
  return value ? quantity.write(*value) : toml_text(word);
}

// --- words

std::string WordKind::describe() const {
  std::vector<std::string> quoted;
  for (const std::string& word : words) quoted.push_back(toml_text(word));
  return one_of(quoted);
}

std::optional<int> WordKind::read_word(const Value& value, const std::string& path, Mistakes& mistakes) const {
  if (value.kind != Kind::text) {
    wrong_kind(value, path, describe(), "", mistakes);
    return std::nullopt;
  }
  const auto found = std::ranges::find(words, value.text);
  if (found != words.end()) return static_cast<int>(found - words.begin());
  const std::string near = mistakes.full() ? "" : nearest_word(value.text, words);
  mistakes.add({path, fmt::format("unknown word for `{}`", key_of(path)), fmt::format("{} is needed", describe()),
                near.empty() ? "" : fmt::format("did you mean \"{}\"?", near), value.place});
  return std::nullopt;
}

bool check_name(const std::string& name, const std::string& path, Mistakes& mistakes, std::optional<Place> place) {
  constexpr std::size_t longest_name = 64;
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (!name.empty() && name.size() <= longest_name && std::ranges::all_of(name, allowed)) return true;
  mistakes.add_unless_touched({path, fmt::format("impossible name \"{}\"", shown(name)), "files are called by it",
                               fmt::format("use up to {} letters a-z A-Z, digits, `_` and `-`", longest_name), place});
  return false;
}

void NameKind::read(const Value& value, const std::string& path, std::string& out, Mistakes& mistakes) const {
  if (value.kind != Kind::text) return wrong_kind(value, path, "the " + what, example(), mistakes);
  out = value.text;
  if (out.empty()) check_name(out, path, mistakes);
}

void NameKind::check(const std::string& value, const std::string& path, Mistakes& mistakes) const {
  if (!(value.empty() && may_be_empty)) check_name(value, path, mistakes);
}

}  // namespace udar

#include "udar/units/quantity.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "udar/base/text.hpp"
#include "udar/units/unit_table.hpp"

namespace udar {
namespace {

template <class T>
using Expected = tl::expected<T, UnitError>;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%'; }

/// What a keyboard or a word processor may put in place of the plain signs.
std::string plain_signs(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 7> signs{{{"\u00b5", "u"},
                                                                                {"\u03bc", "u"},
                                                                                {"\u00b2", "^2"},
                                                                                {"\u00b3", "^3"},
                                                                                {"\u00b7", "*"},
                                                                                {"\u00b0", "deg"},
                                                                                {"\u2212", "-"}}};
  std::string out(text);
  for (const auto& [from, to] : signs) {
    for (auto at = out.find(from); at != std::string::npos; at = out.find(from, at + to.size())) {
      out.replace(at, from.size(), to);
    }
  }
  return out;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// Length of the decimal number that `text` begins with; 0 where there is none.
std::size_t number_length(std::string_view text) {
  std::size_t at = 0;
  const auto sign = [&] { at += at < text.size() && (text[at] == '-' || text[at] == '+') ? 1 : 0; };
  const auto digits = [&] {
    const std::size_t begin = at;
    while (at < text.size() && is_digit(text[at])) ++at;
    return at > begin;
  };
  sign();
  if (!digits()) return 0;
  if (at + 1 < text.size() && text[at] == '.' && is_digit(text[at + 1])) {
    ++at;
    digits();
  }
  const std::size_t mantissa = at;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    ++at;
    sign();
    if (!digits()) return mantissa;
  }
  return at;
}

/// Reads an expression of units by recursive descent; the text is short, so the recursion is too.
class UnitReader {
 public:
  UnitReader(std::string_view number, std::string_view text) : number_(number), text_(text) {}

  Expected<Unit> read() {
    Expected<Unit> unit = expression();
    if (unit && at_ < text_.size()) return unexpected();
    return unit;
  }

 private:
  Expected<Unit> expression() {
    Unit all;
    bool divided = false;
    for (bool first = true;; first = false) {
      skip_spaces();
      if (at_ == text_.size() || text_[at_] == ')') {
        if (first) return unexpected();
        return all;
      }
      const bool divide = text_[at_] == '/';
      const bool multiply = text_[at_] == '*';
      if (first && multiply) return unexpected();
      if (!divide && divided) return ambiguous();
      if (divide || multiply) ++at_;
      divided = divided || divide;
      Expected<Unit> next = factor();
      if (!next) return next;
      multiply_by(all, *next, divide ? -1 : 1);
    }
  }

  Expected<Unit> factor() {
    skip_spaces();
    if (at_ == text_.size()) return unexpected();
    if (text_[at_] == '(') {
      ++at_;
      Expected<Unit> inner = expression();
      if (!inner) return inner;
      if (at_ == text_.size()) return unexpected();
      ++at_;
      return inner;
    }
    if (text_[at_] == '1' && at_ + 1 < text_.size() && (text_[at_ + 1] == '/' || text_[at_ + 1] == ' ')) {
      ++at_;
      return Unit{};
    }
    return power();
  }

  Expected<Unit> power() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_letter(text_[at_])) ++at_;
    const std::string_view name = text_.substr(begin, at_ - begin);
    if (name.empty()) return unexpected();
    const std::optional<Unit> base = find_unit(name);
    if (!base) return unknown(begin, name);

    const bool caret = at_ < text_.size() && text_[at_] == '^';
    if (caret) ++at_;
    const bool minus = at_ < text_.size() && text_[at_] == '-';
    if (minus) ++at_;
    int exponent = 1;
    if (at_ < text_.size() && is_digit(text_[at_])) {
      exponent = text_[at_++] - '0';
      if (at_ < text_.size() && is_digit(text_[at_])) return unexpected();
    } else if (caret || minus) {
      return unexpected();
    }
    Unit out;
    for (int i = 0; i < exponent; ++i) multiply_by(out, *base, minus ? -1 : 1);
    return out;
  }

  static void multiply_by(Unit& unit, const Unit& factor, int sign) {
    const Scale& s = factor.scale;
    unit.scale = unit.scale * (sign < 0 ? Scale{s.denominator, s.numerator} : s);
    unit.dimension = unit.dimension + sign * factor.dimension;
  }

  void skip_spaces() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }

  tl::unexpected<UnitError> unexpected() const {
    if (at_ >= text_.size()) return tl::unexpected(UnitError{"incomplete unit", "the unit ends too early", ""});
    const char c = text_[at_];
    const bool printable = c > ' ' && c < 127;
    return tl::unexpected(UnitError{
        "unreadable unit", printable ? fmt::format("`{}` was not expected here", c) : "a sign that no unit has", ""});
  }

  tl::unexpected<UnitError> ambiguous() const {
    return tl::unexpected(UnitError{"ambiguous unit",
                                    "it could be read in two ways: is it divided by all that follows?",
                                    "use parentheses or a second `/`: \"N/(m s)\", \"m/s/s\""});
  }

  tl::unexpected<UnitError> unknown(std::size_t begin, std::string_view name) const {
    UnitError error{fmt::format("unknown unit `{}`", name), "", ""};
    const std::string near = nearest_unit(name);
    if (near.empty()) {
      error.cure = "known are SI units with prefixes and kgf, tf, bar, atm, psi, lbf, in, ft, deg, rpm, min, h, t";
    } else {
      const std::string corrected = std::string(text_.substr(0, begin)) + near + std::string(text_.substr(at_));
      error.cure = fmt::format("did you mean {}?", whole_or_name(corrected, near));
    }
    return tl::unexpected(error);
  }

  /// The quantity with one unit put right, and others that are unknown; only that unit where the rest is no unit.
  std::string whole_or_name(const std::string& corrected, const std::string& name) const {
    const Expected<Unit> again = UnitReader(number_, corrected).read();
    if (again) return fmt::format("\"{} {}\"", number_, corrected);
    const std::string& cure = again.error().cure;
    constexpr std::string_view before = "did you mean \"";
    if (!cure.starts_with(before)) return fmt::format("`{}`", name);
    return cure.substr(before.size() - 1, cure.size() - before.size());
  }

  /// The same letters in other capitals ("mpa") come first, then in another order ("kfg"), then the nearest spelling.
  static std::string nearest_unit(std::string_view name) {
    const auto lower = [](std::string_view text) {
      std::string out(text);
      for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
      return out;
    };
    for (const std::string& known : unit_names()) {
      if (lower(known) == lower(name)) return known;
    }
    for (const std::string& known : unit_names()) {
      if (known.size() > 1 && std::ranges::is_permutation(known, name)) return known;
    }
    return nearest_word(name, unit_names());
  }

  std::string_view number_;
  std::string_view text_;
  std::size_t at_ = 0;
};

/// A text near to `number unit` that has the needed dimension: the unit with something added ("80 m" -> "80 m/s") or
/// taken away ("80 m/s" -> "80 m").
std::string repaired(std::string_view number, std::string_view unit, Dimension needed) {
  const bool technical = unit.find("gf") != std::string_view::npos || unit.find("tf") != std::string_view::npos;
  std::vector<std::string> candidates;
  if (technical) candidates = {fmt::format("{}/cm^2", unit), fmt::format("{}/cm", unit)};
  for (const char* end : {"^2", "^3", "/s", "/s^2", "/m", "/m^2", "/m^3"})
    candidates.push_back(fmt::format("{}{}", unit, end));
  for (const char sign : {'^', '/'}) {
    if (const auto at = unit.rfind(sign); at != std::string_view::npos) candidates.emplace_back(unit.substr(0, at));
  }
  for (const std::string& candidate : candidates) {
    const auto parsed = UnitReader(number, candidate).read();
    if (parsed && fits(parsed->dimension, needed)) return fmt::format("\"{} {}\"", number, candidate);
  }
  return "";
}

struct Split {
  std::string number;
  std::string unit;
};

Expected<Split> split(std::string_view text) {
  if (text.size() > longest_quantity) {
    return tl::unexpected(UnitError{
        "unreadable value", fmt::format("{} characters are too many for a number and a unit", text.size()), ""});
  }
  const std::string plain = plain_signs(text);
  const std::string_view whole = trimmed(plain);
  const std::size_t length = number_length(whole);
  if (length == 0) return tl::unexpected(UnitError{"unreadable value", "this does not begin with a number", ""});
  const std::string_view number = whole.substr(0, length);
  const std::string_view rest = trimmed(whole.substr(length));
  if (rest.size() > 1 && rest[0] == ',' && is_digit(rest[1])) {
    const std::string corrected = fmt::format("{}.{}", number, rest.substr(1));
    const std::string cure = parse_quantity(corrected) ? fmt::format("did you mean \"{}\"?", corrected) : "";
    return tl::unexpected(UnitError{"unreadable value", "a comma is not part of a number", cure});
  }
  return Split{std::string(number), std::string(rest)};
}

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The number times 10^k, rounded once: "0.52 ms" becomes the double nearest to 0.00052, as a program would write it.
std::optional<double> shifted(std::string_view number, int k) {
  const auto e = number.find_first_of("eE");
  int exponent = 0;
  if (e != std::string_view::npos) {
    std::string_view digits = number.substr(e + 1);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    exponent = std::clamp(exponent, -9999, 9999);  // of 0e999999 only
  }
  return number_of(fmt::format("{}e{}", number.substr(0, e), exponent + k));
}

Expected<Quantity> evaluate(const Split& parts) {
  const std::optional<double> value = number_of(parts.number);
  if (!value) return tl::unexpected(UnitError{"impossible value", "this number is too large or too small", ""});
  if (parts.unit.empty()) return Quantity{*value, dimension::number, true};
  const Expected<Unit> unit = UnitReader(parts.number, parts.unit).read();
  if (!unit) return tl::unexpected(unit.error());
  const std::optional<int> k = unit->scale.power_of_ten();
  const std::optional<double> si = k ? shifted(parts.number, *k) : unit->scale.apply(*value);
  if (!si || !std::isfinite(*si)) {
    return tl::unexpected(UnitError{"impossible value", "this is too large or too small in SI units", ""});
  }
  return Quantity{*si, unit->dimension, false};
}

}  // namespace

tl::expected<Quantity, UnitError> parse_quantity(std::string_view text) { return split(text).and_then(evaluate); }

tl::expected<double, UnitError> parse_si(std::string_view text, Dimension needed) {
  const Expected<Split> parts = split(text);
  const Expected<Quantity> quantity = parts.and_then(evaluate);
  if (!quantity) {
    UnitError error = quantity.error();
    if (error.reason.empty()) error.reason = dimension_name(needed) + " is needed";
    if (error.cure.empty()) error.cure = fmt::format("write it like {}", example_of(needed));
    return tl::unexpected(error);
  }
  if (quantity->bare && needed != dimension::number) return tl::unexpected(missing_unit(parts->number, needed));
  if (fits(quantity->dimension, needed)) return quantity->value;

  const std::string better = needed == dimension::number ? parts->number : repaired(parts->number, parts->unit, needed);
  return tl::unexpected(UnitError{
      "wrong unit",
      fmt::format("this is {}; {} is needed", dimension_name(quantity->dimension), dimension_name(needed)),
      better.empty() ? fmt::format("write it like {}", example_of(needed)) : fmt::format("did you mean {}?", better)});
}

UnitError missing_unit(std::string_view number, Dimension needed) {
  const std::string reason = dimension_name(needed) + " is needed";
  // Whoever leaves the unit of an angle out hardly thinks of radians.
  if (needed == dimension::angle)
    return {"missing unit", reason, fmt::format("write \"{0} deg\" or \"{0} rad\"", number)};
  return {"missing unit", reason, fmt::format("in SI units write \"{} {}\"", number, si_unit(needed))};
}

std::string si_text(double value, Dimension dimension) {
  const std::string unit = si_unit(dimension);
  return unit.empty() ? shortest(value) : shortest(value) + " " + unit;
}

}  // namespace udar

#include "udar/case/ascii.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>

namespace udar {
namespace {

struct Character {
  std::uint32_t code = 0;
  int bytes = 0;  ///< 0: not UTF-8
};

/// The character at `at`. Overlong forms, surrogates and codes beyond Unicode are not UTF-8.
Character character_at(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) -> std::uint32_t { return static_cast<unsigned char>(text[i]); };
  const std::uint32_t first = byte(at);
  if (first < 0x80) return {first, 1};
  const int bytes = first >= 0xf0 ? 4 : (first >= 0xe0 ? 3 : 2);
  if (first < 0xc2 || first > 0xf4 || at + bytes > text.size()) return {};
  std::uint32_t code = first & (0xffu >> (bytes + 1));
  for (int i = 1; i < bytes; ++i) {
    if ((byte(at + i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(at + i) & 0x3f);
  }
  constexpr std::uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
  if (code < smallest[bytes] || code > 0x10ffff || (code >= 0xd800 && code <= 0xdfff)) return {};
  return {code, bytes};
}

bool is_control(std::uint32_t code) {
  return (code < 0x20 && code != '\t' && code != '\n') || (code >= 0x7f && code < 0xa0);
}

/// Marks that change the direction of writing: what is seen is then not what is read.
bool is_hidden(std::uint32_t code) {
  return (code >= 0x200b && code <= 0x200f) || (code >= 0x2028 && code <= 0x202e) || (code >= 0x2060 && code <= 0x2069);
}

/// Walks over a TOML text and knows just enough of it to tell strings and comments from the rest.
class Converter {
 public:
  explicit Converter(std::string_view text) : text_(text) {}

  tl::expected<AsciiText, TextError> convert() {
    if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
    begin_line();
    while (at_ < text_.size()) {
      const Character c = character_at(text_, at_);
      if (const TextError error = refuse(c); !error.message.empty()) return tl::unexpected(error);
      if (c.bytes == 1) {
        ascii(static_cast<char>(c.code));
      } else {
        put(substitute(c.code));
        at_ += c.bytes;
      }
      ++column_;
    }
    end_line();
    return std::move(out_);
  }

 private:
  enum class Where { code, comment, basic, literal, long_basic, long_literal };

  TextError refuse(const Character& c) const {
    const auto error = [&](std::string message, std::string pointer, std::string cure) {
      return TextError{line_, column_, std::move(message), std::move(pointer), std::move(cure)};
    };
    if (c.bytes == 0)
      return error("not a text in UTF-8", "this byte is not part of a character", "save the file as UTF-8");
    if (c.code == '\r') {
      if (text_.substr(at_).starts_with("\r\n")) return {};
      return error("stray carriage return", "a line ends with LF or CR LF",
                   "save the file with the line ends of this system");
    }
    if (is_control(c.code)) {
      return error(fmt::format("control character U+{:04X}", c.code), "a case file is plain text", "remove it");
    }
    if (where_ == Where::code && c.code == '.' && dots_ + 1 >= deepest_key) {
      return error("key with too many parts", fmt::format("at most {} parts are read", deepest_key), "");
    }
    if (c.bytes == 1 || where_ == Where::comment) return {};
    const bool in_double_quotes = (where_ == Where::basic || where_ == Where::long_basic) && !escaped_;
    if (in_double_quotes) return {};
    const std::string name = fmt::format("character U+{:04X}", c.code);
    if (where_ == Where::code) {
      return error(name + " outside of quotes", "only ASCII is read here", "put the text into double quotes");
    }
    return error(name + " cannot be read here", "only double quotes take it, and not after a backslash",
                 "use double quotes");
  }

  std::string substitute(std::uint32_t code) const {
    if (where_ == Where::comment) return "?";
    return code < 0x10000 ? fmt::format("\\u{:04X}", code) : fmt::format("\\U{:08X}", code);
  }

  void ascii(char c) {
    const std::string_view rest = text_.substr(at_);
    if (c == '\n') {
      if (where_ != Where::long_basic && where_ != Where::long_literal) where_ = Where::code;
      dots_ = 0;
    } else if (where_ == Where::code) {
      if (c == '#') where_ = Where::comment;
      if (c == '"') where_ = rest.starts_with("\"\"\"") ? Where::long_basic : Where::basic;
      if (c == '\'') where_ = rest.starts_with("'''") ? Where::long_literal : Where::literal;
      dots_ = c == '.' ? dots_ + 1 : (std::string_view("=,[]{}").find(c) == std::string_view::npos ? dots_ : 0);
      if (where_ == Where::long_basic || where_ == Where::long_literal) put_more(2);
    } else if (!escaped_) {
      const bool double_quotes = where_ == Where::basic || where_ == Where::long_basic;
      if ((where_ == Where::basic && c == '"') || (where_ == Where::literal && c == '\'')) where_ = Where::code;
      close_long(where_ == Where::long_basic ? '"' : '\'', rest);
      if (double_quotes && c == '\\') {
        put({&c, 1});
        ++at_;
        escaped_ = true;
        return;
      }
    }
    escaped_ = false;
    put({&c, 1});
    ++at_;
    if (c == '\n') next_line();
  }

  /// Three quotes end a long string; up to two more before them belong to it.
  void close_long(char quote, std::string_view rest) {
    if (where_ != Where::long_basic && where_ != Where::long_literal) return;
    const auto count = std::min(rest.find_first_not_of(quote), rest.size());
    if (count < 3) return;
    put_more(static_cast<int>(std::min<std::size_t>(count, 5)) - 1);
    where_ = Where::code;
  }

  /// Takes over the next quotes of a row; the last one is left to the caller.
  void put_more(int count) {
    for (int i = 0; i < count; ++i, ++at_, ++column_) put(text_.substr(at_, 1));
  }

  void put(std::string_view ascii_text) {
    user_columns_.insert(user_columns_.end(), ascii_text.size(), column_);
    line_is_ascii_ = line_is_ascii_ && static_cast<unsigned char>(text_[at_]) < 0x80;
    out_.text += ascii_text;
  }

  void begin_line() {
    column_ = 1;
    line_is_ascii_ = true;
    user_columns_.clear();
  }
  void end_line() { out_.columns.push_back(line_is_ascii_ ? std::vector<int>{} : user_columns_); }
  void next_line() {
    end_line();
    begin_line();
    column_ = 0;  // the caller counts the line end itself
    ++line_;
  }

  std::string_view text_;
  AsciiText out_;
  std::vector<int> user_columns_;
  std::size_t at_ = 0;
  int line_ = 1;
  int column_ = 1;
  int dots_ = 0;
  Where where_ = Where::code;
  bool escaped_ = false;
  bool line_is_ascii_ = true;
};

}  // namespace

int AsciiText::user_column(int line, int column) const {
  const auto index = static_cast<std::size_t>(line - 1);
  if (line < 1 || column < 1 || index >= columns.size() || columns[index].empty()) return column;
  const std::vector<int>& map = columns[index];
  const auto at = static_cast<std::size_t>(column - 1);
  return at < map.size() ? map[at] : map.back() + static_cast<int>(at - map.size()) + 1;
}

tl::expected<AsciiText, TextError> to_ascii(std::string_view text) {
  if (text.size() > largest_document) {
    return tl::unexpected(TextError{.message = "the case is too large",
                                    .pointer = "at most 1 MiB is read",
                                    .cure = "leave data out that is not part of the case"});
  }
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
    return tl::unexpected(TextError{.message = "the case is written in UTF-16", .cure = "save the file as UTF-8"});
  }
  if (text.substr(0, 4096).find('\0') != std::string_view::npos) {
    return tl::unexpected(TextError{.message = "this is a binary file, not a case",
                                    .pointer = "a case file is text (TOML)",
                                    .cure = "give the name of a case file, such as short-beam.toml"});
  }
  return Converter(text).convert();
}

std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const Character c = character_at(text, at);
    if (c.bytes == 0 || is_control(c.code) || is_hidden(c.code) || c.code == '\n') {
      out += '?';
    } else if (c.code == '\t') {
      out += ' ';  // so that the caret below stands where it should
    } else {
      out += text.substr(at, c.bytes);
    }
    at += std::max(c.bytes, 1);
  }
  return out;
}

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 60;
  if (text.size() <= longest) return printable(text);
  std::size_t end = longest - 3;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return printable(text.substr(0, end)) + "...";
}

}  // namespace udar

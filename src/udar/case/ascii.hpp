#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace udar {

/// What the TOML parser is given in place of the user's text: the same document in ASCII. The parser aborts or worse on
/// some other texts, and strangers send us cases.
struct AsciiText {
  std::string text;
  /// For each line (from 0) that is not ASCII: the user's column of each column of `text`, both from 1.
  std::vector<std::vector<int>> columns;

  /// The user's column for a column of the ASCII text; lines and columns from 1.
  [[nodiscard]] int user_column(int line, int column) const;
};

/// Why a text is not handed to the parser, and where (from 1; 0: nowhere in particular).
struct TextError {
  int line = 0;
  int column = 0;
  std::string message;
  std::string pointer;
  std::string cure;
};

inline constexpr std::size_t largest_document = 1 << 20;  ///< bytes
inline constexpr int deepest_key = 16;                    ///< parts of a key such as a.b.c, and values inside values

/// Checks the text and turns it into ASCII: characters beyond it become \uXXXX inside double quotes, `?` in comments
/// and are refused elsewhere. A byte order mark is dropped.
tl::expected<AsciiText, TextError> to_ascii(std::string_view text);

/// The text with everything replaced that a terminal could take as a command or that hides what stands there.
std::string printable(std::string_view text);

/// `printable`, and not longer than 60 bytes.
std::string shown(std::string_view text);

}  // namespace udar

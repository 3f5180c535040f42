#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "udar/results/file.hpp"

namespace udar {

/// Largest table that is read, bytes.
inline constexpr std::size_t largest_table = std::size_t{1} << 28;

/// A mistake in a line of a table, as UserError (usage).
struct TablePlace {
  std::string file;
  int line = 0;
  std::string text;  ///< of the line

  [[noreturn]] void refuse(const std::string& message, const std::string& reason, const std::string& cure) const;
};

/// The lines of a table, one after another; a part of the file is in memory at a time. Passes over comments and empty
/// lines, and over a byte order mark.
class TableLines {
 public:
  /// Throws UserError where the file is too large or is none, OutputError where it cannot be read.
  explicit TableLines(const std::filesystem::path& file);
  /// False at the end.
  bool next(TablePlace& place);

 private:
  bool any(TablePlace& place);

  PartReader reader_;
  std::string buffer_;
  std::size_t begin_ = 0;     ///< of what is left of the buffer
  std::size_t position_ = 0;  ///< in the file, behind the buffer
};

/// What stands between two separators.
struct TableField {
  std::string text;  ///< without spaces and quotes around it
  bool quoted = false;
};

/// Tab, semicolon or comma: the first of them that a line of names holds outside quotes; 0: none.
char separator_of(std::string_view line);

/// The fields of a line. `fields` is used again, since tables are long. False where a quote is not closed.
bool split_fields(std::string_view line, char separator, std::vector<TableField>& fields, std::size_t& count);

/// A number with a point, or with a comma where `comma` allows it. An empty field, "nan" and "-" are NaN. False where
/// it is none.
bool read_number(const std::string& text, bool comma, double& value);

}  // namespace udar

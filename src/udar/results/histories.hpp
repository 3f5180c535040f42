#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "udar/results/file.hpp"

namespace udar {

/// One column of a history: `displacement_x` in `m`; the unit is empty for plain numbers.
struct Column {
  std::string name;
  std::string unit;

  friend bool operator==(const Column&, const Column&) = default;
};

/// Writes one history as CSV, row by row: a header `time [s],displacement_x [m]`, then the shortest numbers that read
/// back as the same doubles. Throws OutputError.
class HistoryWriter {
 public:
  HistoryWriter(const std::filesystem::path& path, const std::vector<Column>& columns);
  /// Goes on behind the first `size` bytes of a file that has its heading.
  HistoryWriter(const std::filesystem::path& path, std::size_t columns, std::uint64_t size);
  /// One value for each column.
  void write_row(std::span<const double> values);
  /// Makes all rows so far visible to other programs.
  void flush() { file_.flush(); }
  void close() { file_.close(); }
  /// Bytes that other programs see.
  [[nodiscard]] std::uint64_t size() const { return file_.size(); }

 private:
  AppendFile file_;
  std::string row_;  ///< room for the longest
  std::size_t column_count_;
};

/// A history read back: values[c] are the rows of columns[c].
struct History {
  std::vector<Column> columns;
  std::vector<std::vector<double>> values;

  /// The values of the column called `name`; throws OutputError, naming the columns there are.
  [[nodiscard]] const std::vector<double>& at(std::string_view name) const;
};

/// Reads what HistoryWriter wrote; throws OutputError with file and line. A last line without its newline, left by a
/// killed run, is dropped.
History read_csv(const std::filesystem::path& path);

/// The same for text in memory; `name` stands for the file in messages.
History parse_csv(std::string_view text, std::string_view name);

}  // namespace udar

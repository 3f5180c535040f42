#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "udar/results/histories.hpp"
#include "udar/results/run_files.hpp"

namespace udar {

/// The columns of a history, time left out. What a table holds that is part of no history has "" for its history.
struct HistoryColumns {
  std::string history;
  std::vector<Column> columns;

  /// "corner.displacement_y"
  [[nodiscard]] std::string name_of(const Column& column) const {
    return history.empty() ? column.name : history + "." + column.name;
  }
};

/// Columns of measurements or of another program, in SI units.
struct MeasuredTable {
  std::vector<double> times;  ///< s, never falling
  std::vector<HistoryColumns> histories;
  std::vector<std::vector<std::vector<double>>> values;  ///< of each column of each history
  std::vector<std::string> unused;                       ///< columns that mean nothing that the other side has
};

/// How a table is read.
struct TableRequest {
  std::vector<std::string> maps;                       ///< "column=corner.displacement_y"
  const std::vector<HistoryColumns>* known = nullptr;  ///< what the other side has; null: every column is kept
  std::size_t most_values = std::size_t{1} << 25;      ///< that are kept, times included: 256 MB
};

/// Reads a table: first column time, first line names with units ("x [mm]"; none: SI), `,` `;` or tab between them,
/// decimal commas where that is clear, `#` before comments. docs/diff.md describes it. Throws UserError (usage) with
/// the line, OutputError where the file cannot be read.
MeasuredTable read_table(const std::filesystem::path& file, const TableRequest& request);

/// One side of a comparison: a run folder or a table.
class HistorySource {
 public:
  /// Looks which histories there are; reads none of their rows. Throws UserError, OutputError.
  static HistorySource of_run(const std::filesystem::path& folder);
  static HistorySource of_table(const std::filesystem::path& file, const TableRequest& request);

  [[nodiscard]] const std::vector<HistoryColumns>& histories() const { return histories_; }
  /// A history with its rows, time first. Throws OutputError.
  [[nodiscard]] History read(const std::string& history) const;
  /// The run, null for a table.
  [[nodiscard]] const RunFiles* run() const { return run_ ? &*run_ : nullptr; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const std::vector<std::string>& unused() const { return table_.unused; }

 private:
  std::filesystem::path path_;
  std::vector<HistoryColumns> histories_;
  std::optional<RunFiles> run_;
  MeasuredTable table_;
};

/// Is it a table, or does its name say so? Else it should be the folder of a run.
bool is_table(const std::filesystem::path& path);

/// Every "history.column" of a source.
std::vector<std::string> names_of(const std::vector<HistoryColumns>& histories);

}  // namespace udar

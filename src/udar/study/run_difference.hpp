#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "udar/results/run_files.hpp"
#include "udar/study/history_difference.hpp"

namespace udar {

/// Are two runs the same, bit by bit, and if not, what parts first?
struct BitDifference {
  bool same = false;
  std::string where;  ///< "corner.displacement_y", "fields/bodies_000003.vtu", "summary.json: steps"
  std::string how;    ///< why it is no difference of values: "only in A", "ends earlier in B"; "" where it is one
  double time = std::numeric_limits<double>::quiet_NaN();  ///< s, of the run in which it comes first
};

/// Compares the bytes of histories and frames, and summary.json but for what depends on the machine: version, start,
/// machine, threads, seconds and speed. The earliest row of a history counts before frames, these before the summary.
/// Throws OutputError where a file cannot be read.
BitDifference compare_bits(const RunFiles& a, const RunFiles& b);

/// A number of summary.json: "contacts.stop.duration", "histories.corner.displacement_y.min", "momentum.end.y". NaN
/// where it is null or missing.
struct NumberDifference {
  std::string name;
  double a = std::numeric_limits<double>::quiet_NaN();
  double b = std::numeric_limits<double>::quiet_NaN();

  /// The same number, or none in both.
  [[nodiscard]] bool same() const { return a == b || (a != a && b != b); }
};

/// Every number of the summaries, in the order of a; what depends on the machine is left out. Throws OutputError where
/// a text is no JSON.
std::vector<NumberDifference> compare_summaries(const std::string& a, const std::string& b);

/// A key of resolved.toml that differs, and what the two runs have; "" where one has none.
struct KeyDifference {
  std::string key;
  std::string a;
  std::string b;
};

/// What differs between two cases as they ran, in the order of a. Empty where a text cannot be read.
std::vector<KeyDifference> compare_cases(const std::string& a, const std::string& b);

/// One column of both sides.
struct ColumnDifference {
  std::string name;  ///< "corner.displacement_y"
  std::string unit;
  HistoryDifference difference;
  bool same_bits = false;   ///< the same rows
  bool negligible = false;  ///< below 1e-9 of others in its unit, or of what the runs could make of it: rounding
};

/// What is compared with what.
struct DifferenceRequest {
  std::filesystem::path a;  ///< a run folder or a table
  std::filesystem::path b;
  std::vector<std::string> maps;  ///< for a table: "column=corner.displacement_y"; of b where both are tables
  std::vector<std::string> only;  ///< histories, columns, vectors; empty: all
  bool align = false;             ///< b is moved so that first touches fall together
  double shift = 0;               ///< s, by which b is moved besides
  HistoryComparison how;          ///< its times are those of a; its shifts are set here
};

struct RunDifference {
  bool runs = false;                  ///< both are run folders
  std::optional<BitDifference> bits;  ///< of two runs
  double moved = 0;                   ///< s, added to the times of b
  std::vector<ColumnDifference> columns;
  std::vector<std::string> only_in_a;  ///< histories and columns; of a run against a table not told
  std::vector<std::string> only_in_b;
  std::vector<NumberDifference> numbers;  ///< of the summaries
  std::vector<KeyDifference> keys;        ///< of the cases
  std::vector<std::string> notes;         ///< what a run folder lacks
};

/// Compares two runs, or a run with a table. Throws UserError (usage) where there is nothing to compare, OutputError.
RunDifference compare_runs(const DifferenceRequest& request);

/// Does the column differ by more than `within`, a part of the rms value of b? Also where that cannot be told.
bool differs(const ColumnDifference& column, double within);

/// Everything as text of a file, one line for each column of the histories.
std::string to_csv(const RunDifference& difference);
/// The same with everything else, as JSON.
std::string to_json(const RunDifference& difference);

}  // namespace udar

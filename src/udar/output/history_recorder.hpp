#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "udar/output/multiples.hpp"
#include "udar/output/observer.hpp"
#include "udar/results/summary.hpp"

namespace udar {

/// Takes every observer's values in every step for the extremes, and at the sampling interval for the history files.
class HistoryRecorder {
 public:
  /// Histories go to `folder`/<observer>.csv; with no folder only extremes are kept. No file is touched before `begin`
  /// or `carry`.
  HistoryRecorder(const Model& model, std::optional<std::filesystem::path> folder);

  /// Begins all files. Throws OutputError, as everything that writes.
  void begin();
  /// What it knows at t_n; with BytesIn it goes on from there, and rows written since are cut off.
  template <class Archive>
  void carry(Archive& archive);
  /// Hands all rows to the operating system.
  void flush();
  [[nodiscard]] std::vector<std::filesystem::path> files() const;
  /// To be called at t_0 and after every step.
  void record(const State& state);
  /// Writes the last row, if it is not yet there, and closes all files, also where one fails. Throws OutputError.
  void close(const State& state);

  [[nodiscard]] std::map<std::string, std::map<std::string, HistorySummary>> summary() const;

 private:
  struct Watched {
    Observer observer;
    std::vector<double> values;
    std::vector<HistorySummary> extremes;
    std::optional<HistoryWriter> file;
  };
  void write_rows(const State& state);
  [[nodiscard]] std::filesystem::path path_of(const Watched& w) const { return *folder_ / (w.observer.name + ".csv"); }

  std::optional<std::filesystem::path> folder_;
  Multiples samples_;
  std::optional<std::uint64_t> last_written_step_;
  std::vector<Watched> watched_;
  std::vector<double> row_;
  std::chrono::steady_clock::time_point last_flush_ = std::chrono::steady_clock::now();
};

}  // namespace udar

#include "udar/output/history_recorder.hpp"

#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include "udar/base/archive.hpp"

namespace udar {
namespace {

void take(HistorySummary& extremes, double value, double time) {
  extremes.last = value;
  if (!(value >= extremes.min)) {
    extremes.min = value;
    extremes.time_of_min = time;
  }
  if (!(value <= extremes.max)) {
    extremes.max = value;
    extremes.time_of_max = time;
  }
  if (!(std::fabs(value) <= extremes.max_abs)) extremes.max_abs = std::fabs(value);
}

}  // namespace

HistoryRecorder::HistoryRecorder(const Model& model, std::optional<std::filesystem::path> folder)
    : folder_(std::move(folder)), samples_(model.output.histories_every) {
  for (Observer& observer : make_observers(model)) {
    Watched w{std::move(observer), {}, {}, {}};
    w.values.resize(w.observer.columns.size());
    w.extremes.resize(w.observer.columns.size());
    watched_.push_back(std::move(w));
  }
}

void HistoryRecorder::begin() {
  if (!folder_) return;
  for (Watched& w : watched_) {
    std::vector<Column> columns{{"time", "s"}};
    columns.insert(columns.end(), w.observer.columns.begin(), w.observer.columns.end());
    w.file.emplace(path_of(w), columns);
  }
}

template <class Archive>
void HistoryRecorder::carry(Archive& archive) {
  archive(samples_, last_written_step_);
  for (Watched& w : watched_) {
    for (HistorySummary& extremes : w.extremes) archive(extremes);
    std::uint64_t size = w.file ? w.file->size() : 0;
    archive(size);
    if constexpr (Archive::reads) {
      if (folder_) w.file.emplace(path_of(w), w.observer.columns.size() + 1, size);
    }
  }
}
template void HistoryRecorder::carry(BytesOut&);
template void HistoryRecorder::carry(BytesIn&);

void HistoryRecorder::flush() {
  for (Watched& w : watched_) {
    if (w.file) w.file->flush();
  }
}

void HistoryRecorder::record(const State& state) {
  const double time = state.clock.time.value();
  for (Watched& w : watched_) {
    if (time < w.observer.window.begin || time > w.observer.window.end) continue;
    w.observer.measure(state, w.values);
    for (std::size_t q = 0; q < w.values.size(); ++q) take(w.extremes[q], w.values[q], time);
  }
  if (samples_.reached(time)) write_rows(state);
}

void HistoryRecorder::write_rows(const State& state) {
  last_written_step_ = state.clock.step;
  for (Watched& w : watched_) {
    if (!w.file) continue;
    w.observer.measure(state, w.values);
    row_.assign(1, state.clock.time.value());
    row_.insert(row_.end(), w.values.begin(), w.values.end());
    w.file->write_row(row_);
  }
  // Who looks at a run that is under way, or one that was killed, finds all but its last second.
  constexpr std::chrono::seconds between_flushes{1};
  const auto now = std::chrono::steady_clock::now();
  if (now - last_flush_ < between_flushes) return;
  last_flush_ = now;
  flush();
}

std::vector<std::filesystem::path> HistoryRecorder::files() const {
  std::vector<std::filesystem::path> all;
  for (const Watched& w : watched_) {
    if (w.file) all.push_back(path_of(w));
  }
  return all;
}

void HistoryRecorder::close(const State& state) {
  std::exception_ptr refused;
  const auto attempt = [&](auto&& write) {
    try {
      write();
    } catch (...) {
      if (!refused) refused = std::current_exception();
    }
  };
  if (last_written_step_ != state.clock.step) attempt([&] { write_rows(state); });
  for (Watched& w : watched_) {
    if (w.file) attempt([&] { w.file->close(); });
  }
  if (refused) std::rethrow_exception(refused);
}

std::map<std::string, std::map<std::string, HistorySummary>> HistoryRecorder::summary() const {
  std::map<std::string, std::map<std::string, HistorySummary>> all;
  for (const Watched& w : watched_) {
    for (std::size_t q = 0; q < w.extremes.size(); ++q) {
      all[w.observer.name][w.observer.columns[q].name] = w.extremes[q];
    }
  }
  return all;
}

}  // namespace udar

#include "udar/study/compare_levels.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "udar/results/histories.hpp"
#include "udar/results/run_files.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/results/run_frames.hpp"
#include "udar/results/summary_numbers.hpp"
#include "udar/study/estimate.hpp"
#include "udar/study/field_difference.hpp"
#include "udar/study/history_difference.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

/// Differences of neighbours along an axis, and the size of the finest level.
struct Norms {
  std::vector<double> l2;
  std::vector<double> max;
  double size = no_number;
  double largest = no_number;

  void make_relative() {
    for (double& v : l2) v /= size;
    for (double& v : max) v /= largest;
  }
};

fs::path folder_of(const Levels& levels, std::size_t run) {
  return levels.folder / StudyFolder::runs / levels.plan[run].name;
}

void judge(StudyDifference& d, Norms& mesh, Norms& step, const Levels& levels, double tolerance) {
  const Norms& finest = levels.mesh.is_refined() ? mesh : step;
  d.size = finest.size;
  const Standard standard{.tolerance = tolerance};
  const auto estimate = [&](Norms& norms, const Axis& axis, Estimate& l2, Estimate& max) {
    if (!axis.is_refined()) return;
    norms.make_relative();
    l2 = estimate_norms(norms.l2, axis.sizes, standard);
    max = estimate_norms(norms.max, axis.sizes, standard);
  };
  estimate(mesh, levels.mesh, d.mesh_l2, d.mesh_max);
  estimate(step, levels.step, d.step_l2, d.step_max);
  d.verdict = worse(d.mesh_l2.verdict, d.step_l2.verdict);
}

/// One history of all runs.
using HistoryOfRuns = std::map<std::size_t, History>;

const std::vector<double>* column_of(const HistoryOfRuns& runs, std::size_t run, const std::string& name) {
  const auto at = runs.find(run);
  if (at == runs.end()) return nullptr;
  const History& history = at->second;
  for (std::size_t c = 1; c < history.columns.size(); ++c) {
    if (history.columns[c].name == name) return &history.values[c];
  }
  return nullptr;
}

class HistoryLevels {
 public:
  HistoryLevels(const Levels& levels, const ConvergenceOptions& options, const HistoryOfRuns& runs)
      : levels_(levels), options_(options), runs_(runs) {}

  [[nodiscard]] Norms norms(const Axis& axis, const std::string& column) const {
    Norms norms;
    for (std::size_t k = 0; k + 1 < axis.runs.size(); ++k) {
      const HistoryDifference d = difference(axis.runs[k], axis.runs[k + 1], column);
      norms.l2.push_back(d.l2);
      norms.max.push_back(d.max_abs);
      norms.size = d.size;
      norms.largest = d.largest;
    }
    return norms;
  }

 private:
  [[nodiscard]] HistoryDifference difference(std::size_t coarse, std::size_t fine, const std::string& column) const {
    const std::vector<double>* a = column_of(runs_, coarse, column);
    const std::vector<double>* b = column_of(runs_, fine, column);
    if (a == nullptr || b == nullptr) return {};
    HistoryComparison how{.window = options_.window};
    if (options_.aligned) {
      const double a_touches = first_touch(*levels_.standings[coarse].summary);
      const double b_touches = first_touch(*levels_.standings[fine].summary);
      if (std::isfinite(a_touches) && std::isfinite(b_touches)) {
        how.shift_a = a_touches;
        how.shift_b = b_touches;
      }
    }
    return udar::compare_histories({runs_.at(coarse).values.front(), *a}, {runs_.at(fine).values.front(), *b}, how);
  }

  const Levels& levels_;
  const ConvergenceOptions& options_;
  const HistoryOfRuns& runs_;
};

HistoryOfRuns read_history(const Levels& levels, const std::string& name) {
  HistoryOfRuns runs;
  for (const Axis* axis : {&levels.mesh, &levels.step}) {
    for (const std::size_t run : axis->runs) {
      const fs::path file = RunFolder{folder_of(levels, run)}.history(name);
      std::error_code error;
      if (!runs.contains(run) && fs::exists(file, error)) runs.emplace(run, read_csv(file));
    }
  }
  return runs;
}

double largest_of(const std::vector<double>& values) {
  double largest = 0;
  for (const double v : values) {
    if (std::isfinite(v)) largest = std::max(largest, std::fabs(v));
  }
  return largest;
}

/// The columns that are more than rounding, beside those in the same unit.
std::vector<Column> columns_with_something(const History& history, const std::string& name, const RunScales& of_run) {
  std::map<std::string, double> scales;
  for (std::size_t c = 1; c < history.columns.size(); ++c) {
    const std::string& unit = history.columns[c].unit;
    const double own = std::max(largest_of(history.values[c]), of_run.of(unit));
    scales[unit] = std::max(scales[unit], own);
  }
  std::vector<Column> found;
  for (std::size_t c = 1; c < history.columns.size(); ++c) {
    const Column& column = history.columns[c];
    const bool is_something = largest_of(history.values[c]) > rounding_part * scales[column.unit];
    if (is_something && !is_bookkeeping(name, column.name)) found.push_back(column);
  }
  return found;
}

/// The finest run that is compared; none where nothing is.
std::optional<std::size_t> finest_run(const Levels& levels) {
  if (levels.mesh.is_refined()) return levels.mesh.runs.back();
  if (levels.step.is_refined()) return levels.step.runs.back();
  return std::nullopt;
}

/// Frames of all compared runs.
using FramesOfRuns = std::map<std::size_t, RunFrames>;

FramesOfRuns open_frames(const Levels& levels) {
  FramesOfRuns frames;
  for (const Axis* axis : {&levels.mesh, &levels.step}) {
    for (const std::size_t run : axis->runs) {
      if (frames.contains(run)) continue;
      RunFiles files = find_run_files(folder_of(levels, run));
      if (files.frames.empty()) return {};
      frames.emplace(run, RunFrames(std::move(files)));
    }
  }
  return frames;
}

/// Times at which fields are compared: of the finest run's frames, evenly spread, the last one among them.
std::vector<double> field_times(const RunFrames& finest) {
  constexpr std::size_t most = 4;
  std::size_t first = 0;
  while (first < finest.count() && finest.time(first) <= 0) ++first;  // at the start all is equal
  const std::size_t after_start = finest.count() - first;
  const std::size_t count = std::min(most, after_start);
  std::vector<double> times;
  for (std::size_t k = 1; k <= count; ++k) times.push_back(finest.time(first + after_start * k / count - 1));
  return times;
}

struct FieldNorms {
  FieldDifference last;
  Norms mesh;
  Norms step;
};

/// For each time, each field.
using FieldsAtTimes = std::vector<std::map<std::string, FieldNorms>>;

/// Compares neighbours along an axis at all times; `member` is where their norms go.
void add_field_norms(const FramesOfRuns& frames, const Axis& axis, const std::vector<double>& times,
                     Norms FieldNorms::*member, FieldsAtTimes& fields) {
  for (std::size_t k = 0; k + 1 < axis.runs.size(); ++k) {
    const FieldComparison comparison(frames.at(axis.runs[k]), frames.at(axis.runs[k + 1]));
    for (std::size_t t = 0; t < times.size(); ++t) {
      for (FieldDifference& d : comparison.at(times[t])) {
        FieldNorms& field = fields[t][d.name];
        Norms& norms = field.*member;
        norms.l2.push_back(d.l2);
        norms.max.push_back(d.max);
        norms.size = d.size;
        norms.largest = d.largest;
        field.last = std::move(d);
      }
    }
  }
}

}  // namespace

std::vector<StudyDifference> compare_histories(const Levels& levels, const ConvergenceOptions& options) {
  std::vector<StudyDifference> found;
  const std::optional<std::size_t> finest = finest_run(levels);
  if (!finest) return found;
  const RunScales of_run(*levels.standings[*finest].summary);
  for (const fs::path& file : find_run_files(folder_of(levels, *finest)).histories) {
    const std::string name = file.stem().string();
    const HistoryOfRuns runs = read_history(levels, name);
    const HistoryLevels history(levels, options, runs);
    for (const Column& column : columns_with_something(runs.at(*finest), name, of_run)) {
      StudyDifference d{.name = name + "." + column.name, .unit = column.unit};
      Norms mesh = history.norms(levels.mesh, column.name);
      Norms step = history.norms(levels.step, column.name);
      judge(d, mesh, step, levels, options.tolerance);
      found.push_back(std::move(d));
    }
  }
  return found;
}

std::vector<StudyDifference> compare_fields(const Levels& levels, const ConvergenceOptions& options) {
  std::vector<StudyDifference> found;
  const std::optional<std::size_t> finest = finest_run(levels);
  if (!finest) return found;
  const FramesOfRuns frames = open_frames(levels);
  if (frames.empty()) return found;
  const std::vector<double> times = field_times(frames.at(*finest));
  FieldsAtTimes fields(times.size());
  add_field_norms(frames, levels.mesh, times, &FieldNorms::mesh, fields);
  add_field_norms(frames, levels.step, times, &FieldNorms::step, fields);
  for (std::size_t t = 0; t < times.size(); ++t) {
    for (auto& [name, field] : fields[t]) {
      if (!(field.last.size > 0)) continue;
      StudyDifference d{.name = name, .unit = field.last.unit, .time = times[t]};
      judge(d, field.mesh, field.step, levels, options.tolerance);
      found.push_back(std::move(d));
    }
  }
  return found;
}

}  // namespace udar

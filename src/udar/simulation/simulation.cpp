#include "udar/simulation/simulation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "udar/case/build_model.hpp"
#include "udar/output/contact_recorder.hpp"
#include "udar/output/frame_writer.hpp"
#include "udar/output/history_recorder.hpp"
#include "udar/output/run_pictures.hpp"
#include "udar/output/summarise.hpp"
#include "udar/results/file.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/simulation/last_good.hpp"
#include "udar/step/step.hpp"

namespace udar {

/// Why a run stopped, and what there is to say of it.
struct Stop {
  std::string reason = "end_time";
  std::vector<std::string> why;

  void because(const char* new_reason, const std::string& text) {
    reason = new_reason;
    if (why.empty() || why.back() != text) why.push_back(text);
  }
  /// Does something that writes. Where the disk refuses, the run has stopped by that, and the rest may still be
  /// written.
  template <class Write>
  void save(Write&& write) {
    try {
      write();
    } catch (const OutputError& error) {
      because("disk", error.what());
    }
  }
};

namespace {

/// Everything that is written while a case runs.
class Recorders {
 public:
  Recorders(const Model& model, const std::optional<RunFolder>& folder, Pool& pool)
      : histories_(model, folder ? std::optional(*folder / RunFolder::histories) : std::nullopt), contacts_(model) {
    if (folder) frames_.emplace(model, *folder, pool);
  }

  void record(const State& state) {
    histories_.record(state);
    contacts_.record(state);
    if (frames_) frames_->record(state);
  }
  void close(const State& state, Stop& stop) {
    stop.save([&] { histories_.close(state); });
    if (frames_) stop.save([&] { frames_->close(state); });
    frames_.reset();  // what it held is needed no more
  }
  void summarise(Summary& summary) const {
    summary.histories = histories_.summary();
    summary.contacts = contacts_.summary();
  }

 private:
  HistoryRecorder histories_;
  ContactRecorder contacts_;
  std::optional<FrameWriter> frames_;
};

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Now, in UTC: "2025-07-01T12:34:56Z".
std::string now_text() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday,
                     parts.tm_hour, parts.tm_min, parts.tm_sec);
}

MachineSummary this_machine() {
  MachineSummary machine{.processor = "", .threads = available_threads()};
  std::string text;
  try {
    text = read_file("/proc/cpuinfo", std::size_t{1} << 24);
  } catch (const OutputError&) {
    return machine;  // other systems have no such file
  }
  const std::size_t row = text.find("model name");
  const std::size_t colon = text.find(": ", row);
  if (row != std::string::npos && colon < text.find('\n', row)) {
    machine.processor = text.substr(colon + 2, text.find('\n', colon) - colon - 2);
  }
  return machine;
}

std::string log_head(const Model& model, const RunOptions& options) {
  return fmt::format("{}\n{}case {}: {} elements, {} nodes\n", version_text(),
                     options.command.empty() ? "" : options.command + "\n", options.case_name, model.element_count,
                     model.node_count);
}

std::string log_end(const Summary& s) {
  std::string text = fmt::format("{} steps to t = {:.6g} s\n", s.steps, s.end_time);
  text += fmt::format(
      "threads: {}, wall time: {:.3g} s, of it stepping: {:.3g} s, million element-steps per second: {:.4g}\n",
      s.threads, s.wall_seconds, s.stepping_seconds, 1e-6 * s.element_steps_per_second);
  text += fmt::format("step {:.4g} to {:.4g} s, tightest by {} at t = {:.4g} s\n", s.time_step.min, s.time_step.max,
                      s.time_step.limited_by, s.time_step.time_of_min);
  text += fmt::format("stopped by: {}\nverdict: {}\n", s.stop_reason, s.verdict);
  for (const std::string& reason : s.reasons) text += "  " + reason + "\n";
  for (const std::string& warning : s.warnings) text += "  warning: " + warning + "\n";
  return text;
}

RunFolder open_folder(const Case& input, const Model& model, const State& state, const RunOptions& options) {
  RunFolder folder = create_run_folder(*options.folder, options.force);
  const std::string resolved = to_toml(input);
  write_file(folder / RunFolder::given_case, options.case_text.empty() ? resolved : options.case_text);
  write_file(folder / RunFolder::resolved_case, resolved);
  write_file(folder / RunFolder::version, version_text() + "\n");
  write_file(folder / RunFolder::log, log_head(model, options));
  write_file(folder / RunFolder::setup_picture, to_svg(setup_picture(model, state, options.case_name)));
  return folder;
}

/// The state at the end; after a numerical failure with the element that limited the step, most often the culprit.
std::string final_picture(const Model& model, const State& state, const RunOptions& options, const Stop& stop) {
  Picture picture = state_picture(model, state, options.case_name);
  if (stop.reason == "numerical") {
    const Index element = state.clock.limit.element;
    picture.markers.push_back({centroid(model, state, element), "limits the step: " + element_name(model, element)});
  }
  return to_svg(picture);
}

}  // namespace

int threads_for(std::size_t elements) {
  constexpr std::size_t elements_per_thread = 4000;
  const std::size_t most = static_cast<std::size_t>(available_threads());
  return static_cast<int>(std::clamp<std::size_t>(elements / elements_per_thread, 1, most));
}

std::string version_text() {
#if defined(__clang__)
  constexpr const char* compiler = "clang";
#else
  constexpr const char* compiler = "g++";
#endif
  return fmt::format("udar {} ({} {})", UDAR_VERSION, compiler, __VERSION__);
}

Simulation::Simulation(Case input) : case_(std::move(input)), model_((check_case(case_), build_model(case_))) {}

void Simulation::observe(std::function<void(const Model&, const State&)> watch) {
  watchers_.push_back(std::move(watch));
}

void Simulation::compute(const RunOptions& options, Workspace& work, const std::function<void()>& look, Stop& stop) {
  LastGood last_good(model_);
  look();
  while (!finished(model_, state_)) {
    if (options.interrupted && options.interrupted()) {
      return stop.because("interrupted", "the run was interrupted before its end time");
    }
    last_good.keep(state_);
    try {
      step(model_, state_, work);
    } catch (const NumericalError& failure) {
      state_ = last_good.before(state_.clock.step, work);
      return stop.because("numerical", failure.what());
    }
    look();
  }
}

Summary Simulation::run(const RunOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const std::string started = now_text();
  Workspace work(model_, options.threads > 0 ? options.threads : threads_for(model_.element_count));
  state_ = start(model_, work);
  std::optional<RunFolder> folder;
  if (options.folder) folder = open_folder(case_, model_, state_, options);
  Recorders recorders(model_, folder, work.pool);
  const auto look = [&] {
    recorders.record(state_);
    for (const auto& watch : watchers_) watch(model_, state_);
  };

  Stop stop;
  const auto first_step = std::chrono::steady_clock::now();
  stop.save([&] { compute(options, work, look, stop); });
  const double stepping = seconds_since(first_step);
  recorders.close(state_, stop);
  if (folder) {
    stop.save([&] { write_file(*folder / RunFolder::final_picture, final_picture(model_, state_, options, stop)); });
  }

  const double seconds = seconds_since(begin);
  const Summary sums = summarise(model_, state_);
  const auto conclude = [&] {
    Summary s = sums;
    s.version = version_text();
    s.case_name = options.case_name;
    s.started = started;
    s.machine = this_machine();
    s.threads = work.pool.threads();
    s.wall_seconds = seconds;
    s.stepping_seconds = stepping;
    s.element_steps_per_second = static_cast<double>(s.elements) * static_cast<double>(s.steps) / stepping;
    s.stop_reason = stop.reason;
    s.reasons = stop.why;
    recorders.summarise(s);
    judge(model_, state_, s);
    return s;
  };
  if (folder) {
    stop.save([&] { write_file(*folder / RunFolder::log, log_head(model_, options) + log_end(conclude())); });
    stop.save([&] { write_summary(*folder / RunFolder::summary, conclude()); });
  }
  return conclude();
}

}  // namespace udar

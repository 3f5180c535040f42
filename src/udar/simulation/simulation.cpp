#include "udar/simulation/simulation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "udar/case/build_model.hpp"
#include "udar/output/contact_recorder.hpp"
#include "udar/output/frame_writer.hpp"
#include "udar/output/history_recorder.hpp"
#include "udar/output/run_pictures.hpp"
#include "udar/output/summarise.hpp"
#include "udar/results/file.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/step/step.hpp"

namespace udar {
namespace {

using Seconds = std::chrono::duration<double>;

/// Everything that is written while a case runs.
class Recorders {
 public:
  Recorders(const Model& model, const std::optional<RunFolder>& folder)
      : histories_(model, folder ? std::optional(*folder / RunFolder::histories) : std::nullopt), contacts_(model) {
    if (folder) frames_.emplace(model, *folder);
  }

  void record(const State& state) {
    histories_.record(state);
    contacts_.record(state);
    if (frames_) frames_->record(state);
  }
  void close(const State& state) {
    histories_.close(state);
    if (frames_) frames_->close(state);
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

void write_inputs(const RunFolder& folder, const Case& input, const RunOptions& options) {
  const std::string resolved = to_toml(input);
  write_file(folder / RunFolder::given_case, options.case_text.empty() ? resolved : options.case_text);
  write_file(folder / RunFolder::resolved_case, resolved);
  write_file(folder / RunFolder::version, version_text() + "\n");
}

std::string log_text(const Summary& s) {
  std::string text = fmt::format("{}\ncase {}: {} elements, {} nodes, {} threads\n", s.version, s.case_name, s.elements,
                                 s.nodes, s.threads);
  text += fmt::format("{} steps to t = {:.6g} s in {:.3g} s: {:.4g} million element-steps per second\n", s.steps,
                      s.end_time, s.wall_seconds, 1e-6 * s.element_steps_per_second);
  text += fmt::format("step {:.4g} to {:.4g} s, tightest by {} at t = {:.4g} s\n", s.time_step.min, s.time_step.max,
                      s.time_step.limited_by, s.time_step.time_of_min);
  text += fmt::format("stopped by: {}\nverdict: {}\n", s.stop_reason, s.verdict);
  for (const std::string& reason : s.reasons) text += "  " + reason + "\n";
  return text;
}

}  // namespace

int threads_for(const Model& model) {
  constexpr unsigned elements_per_thread = 4000;
  const unsigned useful = model.element_count / elements_per_thread;
  return static_cast<int>(std::clamp(useful, 1U, static_cast<unsigned>(available_threads())));
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

Summary Simulation::run(const RunOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  Workspace work(model_, options.threads > 0 ? options.threads : threads_for(model_));
  state_ = start(model_, work);

  std::optional<RunFolder> folder;
  if (options.folder) {
    folder = create_run_folder(*options.folder, options.force);
    write_inputs(*folder, case_, options);
    write_file(*folder / RunFolder::setup_picture, to_svg(setup_picture(model_, state_, options.case_name)));
  }
  Recorders recorders(model_, folder);
  const auto look = [&] {
    recorders.record(state_);
    for (const auto& watch : watchers_) watch(model_, state_);
  };

  std::string stop_reason = "end_time";
  std::vector<std::string> reasons;
  try {
    look();
    while (!finished(model_, state_)) {
      step(model_, state_, work);
      look();
      if (options.interrupted && options.interrupted()) {
        stop_reason = "interrupted";
        reasons.push_back("the run was interrupted before its end time");
        break;
      }
    }
  } catch (const NumericalError& failure) {
    stop_reason = "numerical";
    reasons.emplace_back(failure.what());
  }
  recorders.close(state_);

  Summary summary = summarise(model_, state_);
  summary.version = version_text();
  summary.case_name = options.case_name;
  summary.threads = work.pool.threads();
  summary.stop_reason = stop_reason;
  summary.reasons = reasons;
  recorders.summarise(summary);
  judge(model_, state_, summary);
  summary.wall_seconds = Seconds(std::chrono::steady_clock::now() - begin).count();
  summary.element_steps_per_second =
      static_cast<double>(summary.elements) * static_cast<double>(summary.steps) / summary.wall_seconds;
  if (folder) {
    write_file(*folder / RunFolder::final_picture, to_svg(state_picture(model_, state_, options.case_name)));
    write_file(*folder / RunFolder::log, log_text(summary));
    write_summary(*folder / RunFolder::summary, summary);
  }
  return summary;
}

}  // namespace udar

#include "udar/simulation/run_output.hpp"

#include <fmt/core.h>

#include "udar/case/case_file.hpp"
#include "udar/output/run_pictures.hpp"
#include "udar/output/summarise.hpp"
#include "udar/results/file.hpp"

namespace udar {
namespace {

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

/// The log so far, and that the run is taken up again.
std::string log_of_resumed(const RunFolder& folder, const Model& model, const State& state, const RunOptions& options) {
  constexpr std::size_t most_bytes = std::size_t{1} << 24;
  std::string text;
  try {
    text = read_file(folder / RunFolder::log, most_bytes);
  } catch (const OutputError&) {
    text = log_head(model, options);
  }
  return text + fmt::format("\ntaken up again at step {}, t = {:.6g} s\n", state.clock.step, state.clock.time.value());
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

/// The state at the end; after a numerical failure, with the place where it began.
std::string final_picture(const Model& model, const State& state, const RunOptions& options, const Stop& stop) {
  Picture picture = state_picture(model, state, options.case_name);
  if (stop.culprit.kind == Culprit::element) {
    const Index element = stop.culprit.number;
    picture.markers.push_back({centroid(model, state, element), "failed: " + element_name(model, element)});
  } else if (stop.culprit.kind == Culprit::node) {
    const Index node = stop.culprit.number;
    picture.markers.push_back({place(state, node), "failed: " + node_name(model, node)});
  }
  return to_svg(picture);
}

}  // namespace

RunOutput::RunOutput(const Case& input, const Model& model, const State& state, const RunOptions& options, Pool& pool)
    : model_(model),
      options_(options),
      folder_(!options.folder             ? std::nullopt
              : options.resume != nullptr ? std::optional(reopen_run_folder(*options.folder))
                                          : std::optional(open_folder(input, model, state, options))),
      recorders_(model, folder_, pool) {
  if (options.resume != nullptr) {
    take_up(*options.resume, recorders_);
  } else {
    recorders_.begin();
  }
  if (!folder_) return;
  log_ = options.resume != nullptr ? log_of_resumed(*folder_, model, state, options) : log_head(model, options);
  checkpoints_.emplace(*folder_, input.output.checkpoint, options.resume);
}

void RunOutput::checkpoint(const RunSoFar& run, const State& state) {
  if (checkpoints_ && checkpoints_->is_wanted()) checkpoints_->write(run, state, recorders_);
}

void RunOutput::close(const State& state, Stop& stop, const std::function<Summary()>& summarise) {
  recorders_.close(state, [&](auto&& write) { stop.save(write); });
  if (!folder_) return;
  stop.save([&] { write_file(*folder_ / RunFolder::final_picture, final_picture(model_, state, options_, stop)); });
  stop.save([&] { write_file(*folder_ / RunFolder::log, log_ + log_end(summarise())); });
  stop.save([&] { write_summary(*folder_ / RunFolder::summary, summarise()); });
  if (stop.is_final()) stop.save([&] { checkpoints_->remove(); });
}

}  // namespace udar

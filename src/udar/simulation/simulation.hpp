#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "udar/case/case_file.hpp"
#include "udar/model/model.hpp"
#include "udar/model/state.hpp"
#include "udar/results/summary.hpp"
#include "udar/step/workspace.hpp"

namespace udar {

struct Checkpoint;
struct Stop;

/// How a case is run. Nothing here changes a result.
struct RunOptions {
  std::optional<std::filesystem::path> folder;  ///< where results go; none: no files
  bool force = false;                           ///< replace the results of an earlier run there
  int threads = 0;                              ///< 0: chosen by the size of the case
  std::string case_name = "case";               ///< for titles and the summary
  std::string case_text;                        ///< the case file as given, kept in the run folder
  std::string command;                          ///< how the run was asked for, for the log
  std::function<bool()> interrupted;            ///< asked before every step; true: stop with everything saved
  /// Goes on from here instead of beginning: a checkpoint of the same case, whose run folder is `folder`. Its file is
  /// cleared once it is read.
  Checkpoint* resume = nullptr;
};

/// A case and its run:
///
///     udar::Simulation simulation{udar::load_case("cases/short-beam/short-beam.toml")};
///     const udar::Summary summary = simulation.run();
class Simulation {
 public:
  /// Checks the case and builds its model. Throws UserError.
  explicit Simulation(Case input);

  /// Calls `watch` at t_0, or where a run is taken up again, and after every step of `run`.
  void observe(std::function<void(const Model&, const State&)> watch);

  /// Runs to the end time, or to where it cannot go on: then the summary says why (stop_reason, reasons), and
  /// everything up to the last good step is saved as far as the disk takes it. Throws UserError where the case cannot
  /// start or the folder is taken, OutputError where the folder cannot be made; then nothing was computed.
  Summary run(const RunOptions& options = {});

  [[nodiscard]] const Case& input() const { return case_; }
  [[nodiscard]] const Model& model() const { return model_; }
  /// After `run`: the state it ended with; after a numerical failure the last good one.
  [[nodiscard]] const State& state() const { return state_; }

 private:
  /// All steps, with a look after each.
  void compute(const RunOptions& options, Workspace& work, Stop& stop, const std::function<void()>& look);
  void watch() const {
    for (const auto& watch : watchers_) watch(model_, state_);
  }

  Case case_;
  Model model_;
  State state_;
  std::vector<std::function<void(const Model&, const State&)>> watchers_;
};

/// Threads that serve a case of this size: more than one only where each has enough to do.
int threads_for(std::size_t elements);

/// "udar 0.1.0 (g++ 12.2.0)".
std::string version_text();
/// "0.1.0".
std::string version_number();

}  // namespace udar

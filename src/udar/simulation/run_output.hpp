#pragma once

#include <functional>
#include <optional>
#include <string>

#include "udar/case/case.hpp"
#include "udar/simulation/checkpoint.hpp"
#include "udar/simulation/recorders.hpp"
#include "udar/simulation/simulation.hpp"
#include "udar/simulation/stop.hpp"

namespace udar {

/// Everything that a run leaves behind: in its folder, if it has one, and in its summary.
class RunOutput {
 public:
  /// Makes the folder, or takes it up again where the run is resumed. Throws UserError and OutputError.
  RunOutput(const Case& input, const Model& model, const State& state, const RunOptions& options, Pool& pool);

  void record(const State& state) { recorders_.record(state); }
  [[nodiscard]] bool checkpoint_is_due() const { return checkpoints_ && checkpoints_->is_due(); }
  /// Writes one, if the case wants any.
  void checkpoint(const RunSoFar& run, const State& state);
  /// Last rows, last frame, final picture, log and summary, as far as the disk takes them. `summarise` is asked again
  /// when the disk refused something in between.
  void close(const State& state, Stop& stop, const std::function<Summary()>& summarise);
  /// What was recorded.
  void summarise(Summary& summary) const { recorders_.summarise(summary); }

 private:
  const Model& model_;
  const RunOptions& options_;
  std::optional<RunFolder> folder_;
  Recorders recorders_;
  std::optional<CheckpointKeeper> checkpoints_;
  std::string log_;
};

}  // namespace udar

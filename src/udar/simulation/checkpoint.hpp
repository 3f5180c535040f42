#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "udar/model/model.hpp"
#include "udar/model/state.hpp"
#include "udar/results/checkpoint_file.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/simulation/recorders.hpp"

namespace udar {

/// What a checkpoint knows of its run besides the state and what was recorded.
struct RunSoFar {
  std::string version;    ///< of the program, without its compiler: all compilers give the same bits
  std::string case_name;  ///< for titles
  std::string case_text;  ///< the resolved case
  std::string started;    ///< UTC
  std::uint64_t steps = 0;
  double wall_seconds = 0;
  double stepping_seconds = 0;
  std::uint64_t resumed = 0;  ///< how often

  template <class Archive>
  void carry(Archive& archive) {
    archive(version, case_name, case_text, started, steps, wall_seconds, stepping_seconds, resumed);
  }
};

/// A checkpoint that was read: whole, undamaged, and of this version of the program.
struct Checkpoint {
  std::size_t generation = 0;  ///< in RunFolder::checkpoints
  CheckpointFile file;
  RunSoFar run;
};

/// The state of a checkpoint. Throws UserError (checkpoint) where it does not fit the model of its case.
State state_of(const Checkpoint& checkpoint, const Model& model);
/// Lets recorders go on from it: rows written since are cut off. Throws UserError (checkpoint), also
/// where files are missing.
void take_up(const Checkpoint& checkpoint, Recorders& recorders);

/// Takes a checkpoint apart. Throws OutputError with what is wrong.
Checkpoint read_checkpoint(std::string bytes, std::size_t generation);
/// The newest checkpoint of a run folder that is whole; what is wrong with others goes to `notes`. Throws UserError
/// (checkpoint) where there is none.
Checkpoint newest_checkpoint(const std::filesystem::path& folder, std::vector<std::string>& notes);

/// Writes the checkpoints of a run: two generations in turn, so that one is whole at any moment.
class CheckpointKeeper {
 public:
  /// `every`: s of wall time between two; none: never. The one that a run was resumed from is written over last.
  CheckpointKeeper(RunFolder folder, std::optional<double> every, const Checkpoint* resumed_from);
  /// Has the time come?
  [[nodiscard]] bool is_due() const;
  [[nodiscard]] bool is_wanted() const { return every_.has_value(); }
  /// Between two steps; of one step only one, so that the other generation is an older one. Everything recorded so far
  /// is on the disk for good before the checkpoint that counts on it. Throws OutputError.
  void write(RunSoFar run, const State& state, Recorders& recorders);
  /// Once the run is complete. Throws OutputError.
  void remove() const;

 private:
  RunFolder folder_;
  std::optional<double> every_;
  std::size_t next_ = 0;
  std::optional<std::uint64_t> written_for_;  ///< the step of the last one
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace udar

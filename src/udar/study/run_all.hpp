#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "udar/results/summary.hpp"
#include "udar/study/plan.hpp"

namespace udar {

/// How a run of a study stands.
struct Standing {
  enum class State { missing, running, done, failed } state = State::missing;
  std::string reason;              ///< why it is not done
  std::optional<Summary> summary;  ///< of one that ended, also by a failure
  double part = 0;                 ///< of its time that was computed
};

/// How all runs stand, in the order of the plan, while they go on.
using Tell = std::function<void(const std::vector<Standing>&)>;

struct RunAllOptions {
  int cores = 1;                      ///< threads of all runs together
  bool again = false;                 ///< also those that are done
  std::function<bool()> interrupted;  ///< true: end the runs in flight, and begin no other
  Tell tell;                          ///< called some times a second
};

/// What the disk tells about a run: done is one that reached its end time with the same case and the same version of
/// the program; failed one that a numerical failure stopped. Throws UserError (usage) where the folder holds something
/// else than this run.
Standing look_at(const std::filesystem::path& folder, const PlannedRun& run);

/// The words after `udar` that compute a run anew; `threads` 0: as many as serve it.
std::vector<std::string> words_of(const StudyInput& input, const std::filesystem::path& folder, const PlannedRun& run,
                                  int threads);
/// The same for one that may have been stopped on its way: from its last checkpoint, if one is whole.
std::vector<std::string> words_to_complete(const StudyInput& input, const std::filesystem::path& folder,
                                           const PlannedRun& run, int threads);

/// Computes what is missing in processes side by side, the most costly run first; `folder` is that of the study. A run
/// that fails does not stop the others. Throws OutputError where no process can be started.
std::vector<Standing> run_all(const StudyInput& input, const std::filesystem::path& folder,
                              const std::vector<PlannedRun>& plan, const RunAllOptions& options);

}  // namespace udar

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "udar/results/summary.hpp"

namespace udar {

/// The files of one frame that are on the disk.
struct FrameFiles {
  double time = 0;  ///< s
  std::filesystem::path bodies;
  std::filesystem::path obstacles;  ///< empty: there are none
};

/// What a run folder holds. A killed run lacks some of it; nothing is made up for that.
struct RunFiles {
  std::filesystem::path folder;
  std::string case_text;
  std::string resolved_text;
  std::string log;
  std::string version;  ///< one line
  std::string summary_text;
  std::optional<Summary> summary;
  std::vector<FrameFiles> frames;                ///< in the order of time
  std::vector<std::filesystem::path> histories;  ///< those of the case's observers first, then energy and momentum
  std::vector<std::string> troubles;             ///< what is there but cannot be read, or is missing; a sentence each
};

/// Is it a folder that `udar run` made, as far as it tells?
bool is_run_folder(const std::filesystem::path& folder);
/// Refuses what is no run folder. Throws UserError (usage).
void check_run_folder(const std::filesystem::path& folder);

/// Looks into a run folder. Throws UserError (usage) where `folder` is none.
RunFiles find_run_files(const std::filesystem::path& folder);

/// The name of the case, as the summary or the log tells; where both are missing that of the folder.
std::string case_name_of(const RunFiles& run);
/// The name of a folder, also of "." and of "runs/a/".
std::string folder_name(const std::filesystem::path& folder);

}  // namespace udar

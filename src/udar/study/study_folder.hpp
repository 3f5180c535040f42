#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "udar/results/study.hpp"
#include "udar/study/plan.hpp"
#include "udar/study/run_all.hpp"
#include "udar/study/run_process.hpp"

namespace udar {

/// Makes the folder of a study, or takes up one that Udar made before, and holds it against others. Throws UserError
/// (usage) where it holds something else or another one works there, OutputError where it cannot be made.
StudyLock open_study_folder(const std::filesystem::path& folder);

/// runs.txt: for each run that is not done a command line for a shell, each by itself. Returns how many there are.
/// Throws OutputError, and UserError where a folder holds another run.
std::size_t write_commands(const StudyInput& input, const std::filesystem::path& folder,
                           const std::vector<PlannedRun>& plan);

/// study.json, study.csv and study.md. Throws OutputError.
void write_study(const std::filesystem::path& folder, const Study& study);

}  // namespace udar

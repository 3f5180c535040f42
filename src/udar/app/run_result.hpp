#pragma once

#include <filesystem>
#include <string>

#include "udar/base/error.hpp"
#include "udar/simulation/simulation.hpp"

namespace udar {

/// What `udar run` and `udar resume` have in common.

/// Runs with a status line; signals save everything and stop it. `begins` follows the counts in the first line: "", or
/// ", from 41 % on".
Summary run_with_status(Simulation& simulation, RunOptions& options, const std::string& begins);
/// Tells how the run ended, and makes its report if that is wanted. The exit code of the command.
ExitCode conclude_run(const Summary& summary, const std::filesystem::path& folder, bool report);

}  // namespace udar

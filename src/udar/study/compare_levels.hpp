#pragma once

#include <filesystem>
#include <vector>

#include "udar/study/convergence.hpp"

namespace udar {

/// The levels of a study whose histories and fields are compared.
struct Levels {
  const std::filesystem::path& folder;  ///< of the study
  const std::vector<PlannedRun>& plan;
  const std::vector<Standing>& standings;
  Axis mesh;
  Axis step;
};

/// Every column of every history that the finest run has, but for what is zero to rounding. Throws OutputError.
std::vector<StudyDifference> compare_histories(const Levels& levels, const ConvergenceOptions& options);

/// Fields at some times, evenly spread over the run. None where the runs have no frames. Throws OutputError.
std::vector<StudyDifference> compare_fields(const Levels& levels, const ConvergenceOptions& options);

}  // namespace udar

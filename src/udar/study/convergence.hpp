#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "udar/results/study.hpp"
#include "udar/study/plan.hpp"
#include "udar/study/run_all.hpp"

namespace udar {

/// How a convergence study is judged.
struct ConvergenceOptions {
  ConvergenceLevels levels;
  double tolerance = 0.02;             ///< an error bar up to this part of a value is "converged"
  bool aligned = false;                ///< histories are laid over each other at first touch
  double window = 0;                   ///< s, of a moving average of the histories; 0: none
  std::vector<std::string> headlines;  ///< numbers to show first; empty: what is usually asked for
};

/// The runs of a study in one direction of refinement, coarsest first: those that are done.
struct Axis {
  std::vector<std::size_t> runs;  ///< numbers in the plan
  std::vector<double> sizes;      ///< of elements, or of steps; relative

  [[nodiscard]] bool is_refined() const { return runs.size() > 1; }
};

/// Meshes at the finest step that most of them were computed with.
Axis mesh_axis(const std::vector<PlannedRun>& plan, const std::vector<Standing>& standings,
               const ConvergenceLevels& levels);
/// Steps of the finest mesh that has most of them.
Axis step_axis(const std::vector<PlannedRun>& plan, const std::vector<Standing>& standings,
               const ConvergenceLevels& levels);

/// What the runs in the study folder say together. Levels that are not done are left out. `input.file` gives the study
/// its name. Throws OutputError for a run that cannot be read.
Study analyse_convergence(const StudyInput& input, const std::filesystem::path& folder,
                          const std::vector<PlannedRun>& plan, const std::vector<Standing>& standings,
                          const ConvergenceOptions& options);

/// What is known of every run: the same for convergence and sweeps.
std::vector<StudyRun> runs_of(const std::vector<PlannedRun>& plan, const std::vector<Standing>& standings);

/// Says of each number of an observer when it was looked at.
void tell_windows(std::vector<StudyQuantity>& quantities, const Case& c);

/// What of the runs may spoil the study though they are done: a sentence each.
std::vector<std::string> warnings_of(const std::vector<StudyRun>& runs);

/// The numbers of all summaries, by name in the order of the last run that has them; what is zero to rounding in all
/// runs is left out. `scales`: for each, the size beside which rounding errors are nothing.
std::vector<StudyQuantity> quantities_of(const std::vector<Standing>& standings, std::vector<double>& scales);

}  // namespace udar

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "udar/results/study.hpp"

namespace udar {

/// Where the folder of a run lies; empty where its name is none of a folder: study.json may have been through other
/// hands.
std::filesystem::path study_run_folder(const std::filesystem::path& study, const StudyRun& run);

/// The runs of a convergence study that stand for its meshes: of each mesh the one with the finest time step that is
/// done, from the coarsest mesh on. Numbers in Study::runs.
std::vector<std::size_t> mesh_levels(const Study& study);
/// The runs with the finest mesh of mesh_levels that are done, from the longest time step on.
std::vector<std::size_t> step_levels(const Study& study);
/// The runs of a sweep that are done, in their order.
std::vector<std::size_t> done_runs(const Study& study);

/// Which runs are shown beside each other, at most `most`: of a convergence study the finest of its mesh_levels, or of
/// its step_levels where there is only one mesh; of a sweep evenly chosen ones with the first and the last.
std::vector<std::size_t> shown_runs(const Study& study, std::size_t most);

/// What tells a run apart from those beside it: "2.5 mm", "friction 0.3"; its name where there is nothing else.
std::string level_label(const Study& study, const StudyRun& run);

}  // namespace udar

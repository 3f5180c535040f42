#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace udar {

struct StudyPlotOptions {
  std::vector<std::string> quantities;  ///< of a sweep: which numbers are plotted; empty: the headlines
  std::function<bool()> interrupted;    ///< asked between plots; true: stop with those that are there
};

/// Writes plots of a study as SVG into its folder plots/ and gives their paths:
///   HISTORY.COLUMN.svg         a curve for each mesh (of a sweep: for up to 6 runs); of the columns that the study
///                              compares (of a sweep: that are not 0 to rounding), at most 400
///   HISTORY.COLUMN-steps.svg   a curve for each time step of the finest mesh, where there are several
///   convergence.svg            relative error of the headlines over the element size, with slopes of order 1 and 2
///   number-NAME.svg            of a sweep: a number over what was varied
/// Earlier plots there are removed. What a run lacks is left out. Throws OutputError where study.json cannot be read or
/// the disk refuses.
std::vector<std::filesystem::path> write_study_plots(const std::filesystem::path& study,
                                                     const StudyPlotOptions& options = {});

}  // namespace udar

#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "udar/report/plot.hpp"

namespace udar {

/// What to plot of one run or of several.
struct PlotRequest {
  std::vector<std::filesystem::path> runs;  ///< at least one
  /// "corner.displacement_y"; "corner.displacement" for x and y; "corner" for all it has. None: a sheet of what is
  /// looked at first.
  std::vector<std::string> names;
  double from = 0;  ///< s
  double to = std::numeric_limits<double>::infinity();
  std::string title;  ///< empty: the name of the case
};

/// Reads the histories of the runs. Quantities in one unit share a panel. Throws UserError (usage) for a name that
/// there is not, with the one that may have been meant, and where no row is in the time asked for; OutputError where a
/// file cannot be read.
Plot history_plot(const PlotRequest& request);

}  // namespace udar

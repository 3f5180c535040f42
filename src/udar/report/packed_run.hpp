#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "udar/report/page.hpp"
#include "udar/report/report.hpp"
#include "udar/results/run_files.hpp"

namespace udar {

/// Bytes that a run may take in a page.
struct RunRoom {
  std::size_t all = 0;        ///< description as text, and blocks
  std::size_t histories = 0;  ///< of these, for the histories
};

/// A run as it stands in a page.
struct PackedRun {
  Json description;       ///< docs/report-format.md; its blocks are those that were added
  std::size_t bytes = 0;  ///< as in RunRoom::all
  std::size_t frames = 0;
  std::vector<std::string> left_out;  ///< sentences
};

/// Thrown where a run has no room even without its frames.
struct RunTooLarge {
  std::size_t needed = 0;  ///< bytes, without any frame
};

/// Adds a run to the blocks of a page: of its frames and fields as many as there is room for. Uses `fields`, `frames`
/// and `interrupted` of the options. Throws UserError where a field has another name, RunTooLarge (and then adds
/// nothing), ReportInterrupted.
PackedRun pack_run(RunFiles run, const ReportOptions& options, const RunRoom& room, Blocks& blocks);

}  // namespace udar

#include "udar/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "udar/base/error.hpp"
#include "udar/report/encode.hpp"
#include "udar/report/packed_run.hpp"
#include "udar/results/run_folder.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

PackedRun packed(RunFiles run, const ReportOptions& options, std::string_view page, Blocks& blocks) {
  const std::size_t around = page_bytes(page);
  const std::size_t limit = options.limit - std::min(options.limit, around);
  try {
    return pack_run(std::move(run), options, {limit, options.limit / 5}, blocks);
  } catch (const RunTooLarge& too_large) {
    throw UserError(ExitCode::usage,
                    fmt::format("a report of {} cannot hold this run: {} are needed without any frame",
                                megabytes(options.limit), megabytes(around + too_large.needed)),
                    "give it more with --limit");
  }
}

}  // namespace

std::string_view page_to_fill(const ReportOptions& options) {
  if (!options.page.empty()) return options.page;
  if (!viewer_page().empty()) return viewer_page();
  throw UserError(ExitCode::output, "the page needs the viewer, which was not built into this program",
                  "scripts/run builds it where Node.js is installed (`apt install nodejs npm`); then `udar report "
                  "RUN` makes the page");
}

ReportInfo write_report(const fs::path& run, const ReportOptions& options) {
  RunFiles files = find_run_files(run);
  const std::string_view page = page_to_fill(options);
  try {
    Blocks blocks;
    const PackedRun packed_run = packed(std::move(files), options, page, blocks);
    const fs::path path = options.output.empty() ? run / RunFolder::report : options.output;
    const std::size_t bytes = write_page(path, page, safe_json(packed_run.description), blocks);
    return {path, bytes, packed_run.frames, packed_run.left_out};
  } catch (const ReportInterrupted&) {
    return {};
  }
}

}  // namespace udar

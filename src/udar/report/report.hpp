#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace udar {

/// How a report is made.
struct ReportOptions {
  std::filesystem::path output;       ///< empty: report.html in the run folder
  std::size_t limit = 25'000'000;     ///< bytes of the whole file
  std::vector<std::string> fields;    ///< names of quantities; empty: all
  std::size_t frames = 0;             ///< at most so many, 2 or more; 0: all
  std::string_view page;              ///< the viewer; empty: the one built into the program
  std::function<bool()> interrupted;  ///< asked between frames; true: stop without a report
};

/// What a report became.
struct ReportInfo {
  std::filesystem::path path;  ///< empty: interrupted
  std::size_t bytes = 0;
  std::size_t frames = 0;             ///< that are in it
  std::vector<std::string> left_out;  ///< sentences
};

/// The page that shows a run; empty where the program was built without it.
std::string_view viewer_page();
/// The page that the options ask for, or the one built in. Throws UserError where there is none.
std::string_view page_to_fill(const ReportOptions& options);

/// Turns a run folder into one file that shows it, all or nothing. What the folder lacks is not in it. Throws UserError
/// where the folder is none of a run, a field has another name, or nothing fits into the limit; OutputError where the
/// disk refuses, and where there is no viewer.
ReportInfo write_report(const std::filesystem::path& run, const ReportOptions& options = {});

}  // namespace udar

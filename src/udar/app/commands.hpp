#pragma once

#include <string>
#include <vector>

#include "udar/base/error.hpp"

namespace udar {

/// The commands of the program. Each writes to the terminal and returns how it went; mistakes are thrown.

struct RunArguments {
  std::string case_file;
  std::vector<std::string> assignments;  ///< of --set
  std::string output;                    ///< empty: runs/<case>, or the next free runs/<case>-2, ...
  bool force = false;
  bool no_report = false;
  int threads = 0;
};

struct ReportArguments {
  std::string run;                  ///< folder
  std::string output;               ///< empty: report.html in it
  std::string limit = "25 MB";      ///< of the file
  std::vector<std::string> fields;  ///< empty: all
  std::size_t frames = 0;           ///< at most; 0: all
  std::string page;                 ///< a viewer to take instead of the one built in
};

ExitCode run_command(const RunArguments& arguments);
ExitCode check_command(const RunArguments& arguments);
ExitCode report_command(const ReportArguments& arguments);
ExitCode keys_command(const std::string& filter);

}  // namespace udar

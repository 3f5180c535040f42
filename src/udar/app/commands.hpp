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
  int threads = 0;
};

ExitCode run_command(const RunArguments& arguments);
ExitCode check_command(const RunArguments& arguments);
ExitCode keys_command(const std::string& filter);

}  // namespace udar

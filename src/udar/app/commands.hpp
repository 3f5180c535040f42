#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "udar/base/error.hpp"
#include "udar/units/dimension.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): of the library
class App;
}

namespace udar {

/// A command of the program.
struct Command {
  CLI::App* words = nullptr;      ///< what it takes, as the parser knows it
  std::function<ExitCode()> run;  ///< once the words are read: writes to the terminal, throws mistakes
  const char* undone = "run";     ///< what was not done where it throws a UserError
};

/// Tells the parser about a command. Each stands in <name>_command.cpp; main.cpp lists them.
using AddCommand = Command (*)(CLI::App& app);

Command add_run(CLI::App& app);
Command add_resume(CLI::App& app);
Command add_check(CLI::App& app);
Command add_report(CLI::App& app);
Command add_keys(CLI::App& app);
Command add_plot(CLI::App& app);
Command add_picture(CLI::App& app);
Command add_movie(CLI::App& app);
Command add_converge(CLI::App& app);
Command add_sweep(CLI::App& app);
Command add_diff(CLI::App& app);
Command add_verify(CLI::App& app);

/// A case and the changes made to it, as several commands take them.
struct CaseArguments {
  std::string file;
  std::vector<std::string> assignments;  ///< of --set
};
void add_case_options(CLI::App& command, CaseArguments& arguments);

/// A quantity of an option, SI: "--to", "0.5 ms". Throws UserError (usage).
double si_of_option(std::string_view option, std::string_view text, Dimension needed);
double time_of_option(std::string_view option, std::string_view text);

/// A size of a file in bytes: "25 MB", "500 kB", "1.5 GB"; a plain number is in MB. Throws UserError (usage).
std::size_t size_of_option(std::string_view option, std::string_view text);

/// --width of a picture, px.
void add_width_option(CLI::App& command, int& width);

}  // namespace udar

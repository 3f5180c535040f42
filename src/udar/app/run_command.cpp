#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "udar/app/commands.hpp"
#include "udar/app/run_result.hpp"
#include "udar/app/terminal.hpp"
#include "udar/results/file.hpp"
#include "udar/simulation/simulation.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

constexpr const char* run_footer = R"(Examples:
  udar run cases/short-beam/short-beam.toml
  udar run cases/short-beam/short-beam.toml --set run.end_time="0.5 ms" --set output.fields_every="5 us"
  udar run cases/short-beam/short-beam.toml --output runs/again --force

Ctrl-C finishes the step and saves everything; a second one stops at once.
`udar resume` goes on with a run that was stopped, by whatever.
While report.html is made, Ctrl-C goes without it.)";

struct RunArguments {
  CaseArguments input;
  std::string output;  ///< empty: runs/<case>, or the next free runs/<case>-2, ...
  bool force = false;
  bool no_report = false;
  int threads = 0;
};

/// runs/<case>, or the first of runs/<case>-2, -3, ... that is not there: a run never replaces another unasked.
fs::path folder_for(const RunArguments& arguments, const std::string& case_name) {
  if (!arguments.output.empty()) return arguments.output;
  const fs::path plain = fs::path("runs") / case_name;
  fs::path folder = plain;
  std::error_code error;
  for (int k = 2; !arguments.force && fs::exists(folder, error); ++k) {
    folder = plain;
    folder += fmt::format("-{}", k);
  }
  return folder;
}

/// The command line that repeats the run.
std::string command_text(const RunArguments& arguments) {
  std::string text = "udar run " + shell_word(arguments.input.file);
  for (const std::string& assignment : arguments.input.assignments) text += " --set " + shell_word(assignment);
  return text;
}

/// Runs the case. Its memory is free again at the end.
Summary compute(const RunArguments& arguments, RunOptions& options, bool& report) {
  std::vector<Diagnostic> warnings;
  Simulation simulation(load_case(arguments.input.file, arguments.input.assignments, &warnings));
  print_warnings(warnings);
  report = simulation.input().output.report && !arguments.no_report;

  options.case_name = fs::path(arguments.input.file).stem().string();
  options.folder = folder_for(arguments, options.case_name);
  options.force = arguments.force;
  options.threads = arguments.threads;
  constexpr std::size_t largest_case = 1 << 20;
  options.case_text = read_file(arguments.input.file, largest_case);
  options.command = command_text(arguments);
  return run_with_status(simulation, options, "");
}

ExitCode run_case(const RunArguments& arguments) {
  RunOptions options;
  bool report = false;
  const Summary summary = compute(arguments, options, report);
  return conclude_run(summary, *options.folder, report);
}

}  // namespace

Command add_run(CLI::App& app) {
  CLI::App* words = app.add_subcommand("run", "Compute a case and leave a folder with everything about it");
  words->footer(run_footer);
  const auto arguments = std::make_shared<RunArguments>();
  add_case_options(*words, arguments->input);
  words->add_option("--output", arguments->output, "Folder of the results; else runs/CASE, runs/CASE-2, ...")
      ->type_name("DIR");
  words->add_flag("--force", arguments->force, "Replace the results of an earlier run in that folder");
  words->add_flag("--no-report", arguments->no_report, "Leave no report.html, as `[output] report = false` does");
  words
      ->add_option("--threads", arguments->threads,
                   "Number of threads, 1 to 1024; else what serves the size of the case")
      ->type_name("N")
      ->check(CLI::Range(1, 1024).description(""));
  return {words, [arguments] { return run_case(*arguments); }};
}

}  // namespace udar

#include <malloc.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

#include "udar/app/commands.hpp"
#include "udar/app/terminal.hpp"
#include "udar/base/text.hpp"
#include "udar/simulation/simulation.hpp"

namespace {

using namespace udar;

constexpr const char* footer = R"(Examples:
  udar check cases/short-beam/short-beam.toml
  udar run cases/short-beam/short-beam.toml
  udar run cases/short-beam/short-beam.toml --set bodies.beam.mesh.element_size="1 cm" --output runs/coarse
  udar report runs/short-beam --limit "5 MB"
  udar keys friction

Exit codes:
  0 done                 3 wrong case                  6 results could not be written
  1 internal error       4 wrong mesh                  7 out of memory or threads
  2 wrong command line   5 stopped by a numerical      130, 143 stopped by Ctrl-C or SIGTERM
                           failure                       with everything saved)";

constexpr const char* run_footer = R"(Examples:
  udar run cases/short-beam/short-beam.toml
  udar run cases/short-beam/short-beam.toml --set run.end_time="0.5 ms" --set output.fields_every="5 us"
  udar run cases/short-beam/short-beam.toml --output runs/again --force

Ctrl-C finishes the step and saves everything; a second one stops at once.)";

constexpr const char* check_footer = R"(Example:
  udar check cases/short-beam/short-beam.toml --set bodies.beam.mesh.element_size="0.5 cm")";

constexpr const char* report_footer = R"(Examples:
  udar report runs/short-beam
  udar report runs/short-beam --limit "5 MB" --output short-beam.html
  udar report runs/short-beam --fields plastic_strain,principal_1 --frames 50

`udar run` makes the same file by itself; this is for old runs and other choices.)";

constexpr const char* keys_footer = R"(Examples:
  udar keys
  udar keys friction)";

const std::vector<std::string> commands{"run", "check", "report", "keys"};

void add_case_options(CLI::App& command, RunArguments& arguments) {
  command.add_option("CASE", arguments.case_file, "Case file, as docs/case-file.md tells")->required()->type_name("");
  command
      .add_option("--set", arguments.assignments,
                  "Replace a value of the case, as often as needed: --set bodies.beam.thickness=\"2 cm\"")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

/// What the user may have meant by a word that was not expected; "" where nothing is near.
std::string meant(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known = commands;
  for (const CLI::App* command : app.get_subcommands()) {
    known.clear();
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    }
  }
  return nearest_word(word.substr(0, word.find('=')), known);
}

ExitCode refuse(const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  std::vector<std::string> extra = app.remaining(true);
  std::string message = error.what();
  std::string cure = fmt::format("`udar{} --help` shows how", chosen.empty() ? "" : " " + chosen[0]->get_name());
  if (!extra.empty()) {
    const bool command = chosen.empty() && extra[0][0] != '-';
    message = fmt::format("`{}` is {}", extra[0], command ? "no command" : "not understood here");
    const std::string near = meant(app, extra[0]);
    if (!near.empty()) {
      cure = fmt::format("did you mean `{}`?", near);
    } else if (command) {
      cure = "write " + one_of(commands);
    }
  } else if (chosen.empty()) {
    message = "a command is needed: " + one_of(commands);
  } else if (message == "CASE is required") {
    message = "a case file is needed";
  } else if (message == "RUN is required") {
    message = "the folder of a run is needed";
  }
  fmt::print(stderr, "error: {}\n  = {}\n", message, cure);
  return ExitCode::usage;
}

ExitCode run_program(int count, char** words) {
  CLI::App app{"Udar computes impacts: bodies that strike, flow plastically, rub, rebound and fly on."};
  app.name("udar");
  app.footer(footer);
  app.set_version_flag("--version", version_text(), "Print the version and exit");
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.get_formatter()->column_width(24);
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.get_formatter()->label("Subcommands", "Commands");
  app.get_formatter()->label("Positionals", "Arguments");
  app.get_formatter()->label("REQUIRED", "");

  RunArguments run;
  CLI::App* run_app = app.add_subcommand("run", "Compute a case and leave a folder with everything about it");
  run_app->footer(run_footer);
  add_case_options(*run_app, run);
  run_app->add_option("--output", run.output, "Folder of the results; else runs/CASE, runs/CASE-2, ...")
      ->type_name("DIR");
  run_app->add_flag("--force", run.force, "Replace the results of an earlier run in that folder");
  run_app->add_flag("--no-report", run.no_report, "Leave no report.html, as `[output] report = false` does");
  run_app->add_option("--threads", run.threads, "Number of threads, 1 to 1024; else what serves the size of the case")
      ->type_name("N")
      ->check(CLI::Range(1, 1024).description(""));

  RunArguments check;
  CLI::App* check_app = app.add_subcommand("check", "Find every mistake in a case and tell what a run would be like");
  check_app->footer(check_footer);
  add_case_options(*check_app, check);

  ReportArguments report;
  CLI::App* report_app = app.add_subcommand("report", "Make report.html of a run: one file that shows it in a browser");
  report_app->footer(report_footer);
  report_app->add_option("RUN", report.run, "Folder of a run")->required()->type_name("");
  report_app->add_option("--limit", report.limit, "Size of the file at most; a plain number is in MB")
      ->type_name("SIZE")
      ->capture_default_str();
  report_app->add_option("--fields", report.fields, "Only these fields: plastic_strain,principal_1")
      ->type_name("NAME,...")
      ->delimiter(',');
  report_app->add_option("--frames", report.frames, "At most so many frames, 2 or more")
      ->type_name("N")
      ->check(CLI::Range(2, 1'000'000).description(""));
  report_app->add_option("--output", report.output, "File to write; else report.html in the folder of the run")
      ->type_name("FILE");
  // For those who work on the viewer.
  report_app->add_option("--template", report.page, "")->group("");

  std::string filter;
  CLI::App* keys_app = app.add_subcommand("keys", "List what a case file may say");
  keys_app->footer(keys_footer);
  keys_app->add_option("WORD", filter, "Only keys whose name or meaning contains this")->type_name("");

  try {
    app.parse(count, words);
    if (app.get_subcommands().empty()) throw CLI::RequiredError("a command");
  } catch (const CLI::ParseError& error) {
    return error.get_exit_code() == 0 ? (app.exit(error), ExitCode::done) : refuse(app, error);
  }
  if (run_app->parsed()) return run_command(run);
  if (check_app->parsed()) return check_command(check);
  if (report_app->parsed()) return report_command(report);
  return keys_command(filter);
}

/// Runs the program and tells what it throws.
ExitCode run_and_tell(int count, char** words) {
  try {
    return run_program(count, words);
  } catch (const UserError& error) {
    fmt::print(stderr, "{}{}; nothing was run\n", error.what(),
               counted(static_cast<long long>(error.diagnostics.size()), "error"));
    return error.code;
  } catch (const OutputError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return ExitCode::output;
  } catch (const NumericalError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return ExitCode::numerical;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "error: not enough memory for this case\n  = take larger elements\n");
    return ExitCode::resources;
  } catch (const std::length_error&) {
    fmt::print(stderr, "error: this case is too large for any memory\n  = take larger elements\n");
    return ExitCode::resources;
  } catch (const std::exception& error) {
    fmt::print(stderr, "internal error: {}\n  = this is a bug of Udar; please report it with the case\n", error.what());
    return ExitCode::internal;
  }
}

}  // namespace

int main(int count, char** words) {
#ifdef __GLIBC__
  // Large arrays of the set-up go back to the system when they are done with. By itself the library comes to keep what
  // is freed below 32 MB, and a run of 200 000 or of 3 million elements would hold a tenth more.
  ::mallopt(M_MMAP_THRESHOLD, 1 << 18);
#endif
  // A full disk or a closed pipe must come back as an error of write(), with a message, not kill the run.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  const ExitCode code = run_and_tell(count, words);
  const int refused = flush_terminal();
  // Whoever closes a pipe, as `head` does, has seen enough.
  if (refused == 0 || refused == EPIPE || code != ExitCode::done) return static_cast<int>(code);
  fmt::print(stderr, "error: cannot write to the standard output: {}\n", std::strerror(refused));
  return static_cast<int>(ExitCode::output);
}

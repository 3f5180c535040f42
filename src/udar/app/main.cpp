#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "udar/app/commands.hpp"
#include "udar/base/text.hpp"
#include "udar/simulation/simulation.hpp"

namespace {

using namespace udar;

constexpr const char* examples = R"(
Examples:
  udar check cases/short-beam/short-beam.toml
  udar run cases/short-beam/short-beam.toml
  udar run cases/short-beam/short-beam.toml --set bodies.beam.mesh.element_size="1 cm" --output runs/coarse
  udar keys friction

Exit codes: 0 done, 1 internal error, 2 wrong command line, 3 wrong case, 4 wrong mesh, 5 stopped by a numerical
failure, 6 results could not be written, 7 out of memory or threads, 130 and 143 stopped by a signal.)";

void add_case_options(CLI::App& command, RunArguments& arguments) {
  command.add_option("case", arguments.case_file, "Case file (docs/case-file.md)")->required();
  command
      .add_option("--set", arguments.assignments,
                  "Replace a value of the case, as often as you like: bodies.beam.thickness=\"2 cm\"")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

/// The command the user may have meant, for a first word that is none.
std::string meant(int count, char** words, const std::vector<std::string>& commands) {
  if (count < 2 || words[1][0] == '-') return "";
  for (const std::string& command : commands) {
    if (command == words[1]) return "";
  }
  const std::string nearest = nearest_word(words[1], commands);
  return fmt::format("error: `{}` is no command\n  = {}\n", words[1],
                     nearest.empty() ? "there are " + one_of(commands) : "did you mean `" + nearest + "`?");
}

ExitCode run_program(int count, char** words) {
  CLI::App app{"Udar computes impacts: bodies that strike, flow plastically, rub, rebound and fly on."};
  app.name("udar");
  app.footer(examples);
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);

  RunArguments run;
  CLI::App* run_app = app.add_subcommand("run", "Compute a case and leave a folder with everything about it");
  add_case_options(*run_app, run);
  run_app->add_option("--output", run.output, "Folder of the results; by itself runs/<case>, or the next free number")
      ->type_name("DIR");
  run_app->add_flag("--force", run.force, "Replace the results of an earlier run in that folder");
  run_app->add_option("--threads", run.threads, "Threads; by itself as many as serve the size of the case")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));

  RunArguments check;
  CLI::App* check_app = app.add_subcommand("check", "Report everything about a case without running it");
  add_case_options(*check_app, check);

  std::string filter;
  CLI::App* keys_app = app.add_subcommand("keys", "List what a case file may say");
  keys_app->add_option("filter", filter, "Only keys whose name or meaning contains this");

  const std::string mistake = meant(count, words, {"run", "check", "keys"});
  if (!mistake.empty()) {
    fmt::print(stderr, "{}", mistake);
    return ExitCode::usage;
  }
  try {
    app.parse(count, words);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::done : ExitCode::usage;
  }
  if (run_app->parsed()) return run_command(run);
  if (check_app->parsed()) return check_command(check);
  return keys_command(filter);
}

}  // namespace

int main(int count, char** words) {
  // A full disk or a closed pipe must come back as an error of write(), with a message, not kill the run.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return static_cast<int>(run_program(count, words));
  } catch (const UserError& error) {
    const std::size_t errors = error.diagnostics.size();
    fmt::print(stderr, "{}{} error{}; nothing was run\n", error.what(), errors, errors == 1 ? "" : "s");
    return static_cast<int>(error.code);
  } catch (const OutputError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return static_cast<int>(ExitCode::output);
  } catch (const std::bad_alloc&) {
    fmt::print(
        stderr,
        "error: not enough memory for this case\n  = take larger elements; `udar check` says how much a case needs\n");
    return static_cast<int>(ExitCode::resources);
  } catch (const std::exception& error) {
    fmt::print(stderr, "internal error: {}\n  = this is a bug of Udar; please report it with the case\n", error.what());
    return static_cast<int>(ExitCode::internal);
  }
}

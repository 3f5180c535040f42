#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
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
  udar picture runs/short-beam --time "0.5 ms" --field sigma1 --output stress.png
  udar converge cases/short-beam/short-beam.toml --mesh 3 --ratio 2 --step 3
  udar plot runs/short-beam corner.displacement_y --output corner.svg
  udar diff runs/coarse runs/short-beam
  udar verify

Exit codes:
  0 done                  5 stopped by a numerical failure   9 not within what --within asks for, or
  1 internal error        6 results could not be written         a check of verify fails
  2 wrong command line    7 out of memory or threads         129, 130, 143 stopped by SIGHUP, Ctrl-C,
  3 wrong case, 4 mesh    8 no checkpoint to go on from          SIGTERM; `udar resume` goes on)";

/// What adds each command, in the order of the help.
constexpr std::array add_commands{add_run,    add_resume, add_check,   add_converge, add_sweep, add_diff,
                                  add_report, add_plot,   add_picture, add_movie,    add_keys,  add_verify};

std::vector<std::string> names_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

/// What the user may have meant by a word that was not expected; "" where nothing is near.
std::string meant(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known = names_of(app);
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
      cure = "write " + one_of(names_of(app));
    }
  } else if (chosen.empty()) {
    message = "a command is needed: " + one_of(names_of(app));
  } else if (message == "CASE is required") {
    message = "a case file is needed";
  } else if (message == "RUN is required") {
    message = "the folder of a run is needed";
  } else if (message == "A is required" || message == "B is required") {
    message = "two runs are needed, or a run and a table";
  } else if (message == "--output is required") {
    message = "a file to make is needed";
    cure = "write --output and its name";
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

  std::vector<Command> commands;
  for (const AddCommand add : add_commands) commands.push_back(add(app));

  try {
    app.parse(count, words);
    if (app.get_subcommands().empty()) throw CLI::RequiredError("a command");
  } catch (const CLI::ParseError& error) {
    return error.get_exit_code() == 0 ? (app.exit(error), ExitCode::done) : refuse(app, error);
  }
  const auto chosen =
      std::find_if(commands.begin(), commands.end(), [](const Command& c) { return c.words->parsed(); });
  try {
    return chosen->run();
  } catch (const UserError& error) {
    const auto count_of_errors = static_cast<long long>(error.diagnostics.size());
    fmt::print(stderr, "{}{}; nothing was {}\n", error.what(), counted(count_of_errors, "error"), chosen->undone);
    return error.code;
  }
}

/// Runs the program and tells what it throws.
ExitCode run_and_tell(int count, char** words) {
  try {
    return run_program(count, words);
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

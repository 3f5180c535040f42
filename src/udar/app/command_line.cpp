#include "udar/app/command_line.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <sstream>

#include "udar/base/text.hpp"
#include "udar/simulation/simulation.hpp"

namespace udar {
namespace {

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

/// What is wrong, and the cure.
std::string mistake_text(const CLI::App& app, const CLI::ParseError& error) {
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
  return fmt::format("error: {}\n  = {}\n", message, cure);
}

}  // namespace

CommandLine::CommandLine()
    : app_(std::make_unique<CLI::App>(
          "Udar computes impacts: bodies that strike, flow plastically, rub, rebound and fly on.")) {
  CLI::App& app = *app_;
  app.name("udar");
  app.footer(footer);
  app.set_version_flag("--version", version_text(), "Print the version and exit");
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.get_formatter()->column_width(24);
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.get_formatter()->label("Subcommands", "Commands");
  app.get_formatter()->label("Positionals", "Arguments");
  app.get_formatter()->label("REQUIRED", "");
  for (const AddCommand add : add_commands) commands_.push_back(add(app));
}

CommandLine::~CommandLine() = default;

Reading CommandLine::read(std::vector<std::string> words) {
  Reading reading;
  std::reverse(words.begin(), words.end());  // the parser takes them from the end
  try {
    app_->parse(std::move(words));
    if (app_->get_subcommands().empty()) throw CLI::RequiredError("a command");
    reading.command =
        &*std::find_if(commands_.begin(), commands_.end(), [](const Command& c) { return c.words->parsed(); });
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      reading.mistake = mistake_text(*app_, error);
      return reading;
    }
    std::ostringstream answer;
    app_->exit(error, answer, answer);
    reading.answer = answer.str();
  }
  return reading;
}

}  // namespace udar

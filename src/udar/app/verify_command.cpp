#include <poll.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "udar/app/commands.hpp"
#include "udar/app/signals.hpp"
#include "udar/app/terminal.hpp"
#include "udar/app/verify_table.hpp"
#include "udar/parallel/for_each.hpp"
#include "udar/report/verification_page.hpp"
#include "udar/simulation/machine.hpp"
#include "udar/simulation/simulation.hpp"
#include "udar/verification/run_problems.hpp"

namespace fs = std::filesystem;

namespace udar {
namespace {

using verification::ProblemRuns;
using verification::Which;

constexpr const char* verify_footer = R"(Examples:
  udar verify
  udar verify --list
  udar verify hertz bar-on-wall
  udar verify --long --output verification

Each problem has an exact answer; a check compares what is computed with it, and the bound of the error comes from the
formula and the order of the method. Nothing but the program is needed. Exit code 9 where a check fails.)";

struct Arguments {
  std::vector<std::string> names;
  std::string output;
  int cores = 0;
  double bounds = 1;
  bool list = false;
  bool force = false;
  bool brief = false;
  bool with_long = false;
  bool only_long = false;

  [[nodiscard]] Which which() const { return only_long ? Which::only_long : with_long ? Which::all : Which::quick; }
};

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// What is at work, in one line.
std::string status_of(const ProblemRuns& runs, double seconds) {
  std::string line = fmt::format("{}  {} of {} parts done", clock_text(seconds), runs.parts_done(), runs.parts());
  std::string_view separator = ": ";
  for (std::size_t k = 0; k < runs.count(); ++k) {
    if (!runs.is_running(k)) continue;
    line += fmt::format("{}{}", separator, runs.problem(k).id);
    separator = ", ";
  }
  return line;
}

/// The threads that compute cannot be asked to stop; nothing that they do needs an end.
[[noreturn]] void stop(std::size_t shown, std::size_t count) {
  if (is_terminal()) say("\r\x1b[K");
  say("interrupted: {} of {} problems were verified; nothing was written\n", shown, count);
  flush_terminal();
  std::_Exit(static_cast<int>(code_of_signal()));
}

Verification run_all(const Arguments& arguments, std::vector<verification::Problem> problems) {
  const int cores = arguments.cores > 0 ? arguments.cores : available_threads();
  const auto begin = std::chrono::steady_clock::now();
  std::string date = now_text().substr(0, std::string_view("2026-01-31T12:00").size());
  std::replace(date.begin(), date.end(), 'T', ' ');
  Verification all{.version = version_text(),
                   .processor = this_machine().processor,
                   .date = date,
                   .cores = cores,
                   .with_long = arguments.which() != Which::quick,
                   .bounds = arguments.bounds};
  ProblemRuns runs(std::move(problems), cores);
  constexpr int look_every = 50;  // ms
  for (std::size_t k = 0; k < runs.count(); ++k) {
    while (!runs.is_done(k)) {
      runs.rethrow();
      if (is_interrupted()) stop(k, runs.count());
      if (is_terminal()) say_in_place(status_of(runs, seconds_since(begin)));
      ::poll(nullptr, 0, look_every);
    }
    if (is_terminal()) say("\r\x1b[K");
    all.problems.push_back(runs.result(k));
    if (arguments.bounds != 1) scale_bounds(all.problems.back(), arguments.bounds);
    say_text(arguments.brief ? line_of(all.problems.back()) : table_of(all.problems.back()));
    flush_terminal();
  }
  runs.finish();
  all.seconds = seconds_since(begin);
  return all;
}

ExitCode list_problems(const Arguments& arguments) {
  verification::Topic topic{};
  bool first = true;
  for (const verification::Problem& problem : verification::choose_problems(arguments.names, Which::all)) {
    if (first || problem.topic != topic) say("{}{}\n", first ? "" : "\n", title_of(problem.topic));
    first = false;
    topic = problem.topic;
    const bool any_long =
        std::any_of(problem.parts.begin(), problem.parts.end(), [](const auto& p) { return p.is_long; });
    say("  {:<16}  {}{}\n", problem.id, problem.title, any_long ? " (--long: more)" : "");
  }
  if (arguments.names.empty()) {
    say("\nOrders that `udar converge` finds by itself are a test of that command: "
        "verification/convergence/README.md.\n");
  }
  return ExitCode::done;
}

ExitCode verify(const Arguments& arguments) {
  if (arguments.list) return list_problems(arguments);
  auto problems = verification::choose_problems(arguments.names, arguments.which());
  if (problems.empty()) {
    throw UserError(ExitCode::usage, "these problems have no long parts", "leave out `--only-long`");
  }
  if (!arguments.output.empty()) check_verification_folder(arguments.output, arguments.force);
  catch_signals();
  const Verification all = run_all(arguments, std::move(problems));
  if (!arguments.output.empty()) {
    write_verification(arguments.output, all);
    say("{}: the manual, with plots\n", (fs::path(arguments.output) / VerificationFiles::page).string());
  }
  say_text(failures_of(all));
  const CheckCount count = count_of(all);
  say("{} of {} checks hold, of {}, in {:.3g} s\n", count.held, count.all,
      counted(static_cast<long long>(all.problems.size()), "problem"), all.seconds);
  return count.held == count.all ? ExitCode::done : ExitCode::differs;
}

}  // namespace

Command add_verify(CLI::App& app) {
  CLI::App* words = app.add_subcommand("verify", "Run problems with exact answers, and compare");
  words->footer(verify_footer);
  const auto arguments = std::make_shared<Arguments>();
  words->add_option("PROBLEM", arguments->names, "Which ones; else all")->type_name("");
  words->add_flag("--list", arguments->list, "Only show what there is");
  words->add_flag("--long", arguments->with_long, "Also the parts that take minutes");
  words->add_flag("--only-long", arguments->only_long, "Only these");
  words->add_flag("--brief", arguments->brief, "A line for each problem, and the checks that fail");
  words
      ->add_option("--bounds", arguments->bounds,
                   "Multiply the bounds of errors: 0.5 shows which checks are within half of theirs")
      ->type_name("FACTOR")
      ->check(CLI::Range(0.0, 1000.0).description(""));
  words
      ->add_option("--output", arguments->output,
                   "Folder for verification.html, verification.md with its pictures, and verify.json")
      ->type_name("DIR");
  words->add_flag("--force", arguments->force, "Replace an earlier verification in that folder");
  words
      ->add_option("--cores", arguments->cores,
                   "How many parts are computed at a time; else as many as there are cores")
      ->type_name("N")
      ->check(CLI::Range(1, 1024).description(""));
  return {words, [arguments] { return verify(*arguments); }, "verified"};
}

}  // namespace udar

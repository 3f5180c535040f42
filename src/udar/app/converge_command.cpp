#include <CLI/CLI.hpp>
#include <memory>

#include "udar/app/picture_options.hpp"
#include "udar/app/study_commands.hpp"
#include "udar/study/convergence.hpp"

namespace udar {
namespace {

constexpr const char* converge_footer = R"(Examples:
  udar converge cases/short-beam/short-beam.toml --set bodies.beam.mesh.element_size="1 cm"
  udar converge cases/short-beam/short-beam.toml --mesh 4 --ratio 2 --step 1 --tolerance "5 %"
  udar converge CASE.toml --show contacts.stop.duration_99 --window "10 us"
  udar converge CASE.toml --list

The meshes begin with that of the case; each next one has elements smaller by the ratio, in every body. Of each
mesh the steps are its own one, the half, the quarter. Runs that are done are not done again: after Ctrl-C, or
with more meshes, the same command goes on. docs/convergence-method.md tells what the verdicts mean.)";

struct Arguments : StudyArguments {
  ConvergenceOptions options;
  std::string tolerance;
  std::string window;
};

ExitCode converge(Arguments& arguments) {
  ConvergenceOptions& options = arguments.options;
  if (!arguments.tolerance.empty()) {
    options.tolerance = si_of_option("--tolerance", arguments.tolerance, dimension::number);
    if (!(options.tolerance > 0 && options.tolerance < 1)) {
      throw UserError(ExitCode::usage, "--tolerance must be between 0 and 1", "write --tolerance \"2 %\"");
    }
  }
  if (!arguments.window.empty()) options.window = time_of_option("--window", arguments.window);
  if (options.window < 0) throw UserError(ExitCode::usage, "--window is negative", "write --window \"10 us\"");
  if (options.levels.meshes * options.levels.steps < 2) {
    throw UserError(ExitCode::usage, "one mesh with one step is no study",
                    "ask for several with `--mesh` or `--step`, or use `udar run`");
  }
  options.headlines = arguments.shown;
  const StudyInput input = study_input(arguments);
  StudyJob job{.kind = "converge", .plan = plan_convergence(input, options.levels), .conclude = {}};
  if (options.window >= job.plan.front().end_time) {
    throw UserError(ExitCode::usage, "--window is as long as the run", "average over a part of it");
  }
  job.conclude = [&](const std::filesystem::path& folder, const std::vector<Standing>& standings) {
    return analyse_convergence(input, folder, job.plan, standings, options);
  };
  return do_study(arguments, job);
}

}  // namespace

Command add_converge(CLI::App& app) {
  CLI::App* words = app.add_subcommand("converge", "Refine mesh and time step, and say how sure every number is");
  words->footer(converge_footer);
  const auto arguments = std::make_shared<Arguments>();
  add_study_options(*words, *arguments, "converge");
  ConvergenceLevels& levels = arguments->options.levels;
  words->add_option("--mesh", levels.meshes, "How many meshes, 1 to 8; 3 by itself")
      ->type_name("N")
      ->check(CLI::Range(1, 8).description(""));
  words->add_option("--ratio", levels.ratio, "Element size of a mesh over that of the next, 1.1 to 16; 2 by itself")
      ->type_name("R")
      ->check(CLI::Range(1.1, 16.0).description(""));
  words->add_option("--step", levels.steps, "How many time steps of each mesh, 1 to 8; 3 by itself")
      ->type_name("N")
      ->check(CLI::Range(1, 8).description(""));
  words->add_option("--tolerance", arguments->tolerance, "An error bar up to this is \"converged\"; 2 % by itself")
      ->type_name("PART");
  words->add_flag("--align", arguments->options.aligned, "Lay histories over each other at first touch");
  words->add_option("--window", arguments->window, "Compare moving averages of the histories over this time")
      ->type_name("TIME");
  return {words, [arguments] { return converge(*arguments); }, "made"};
}

}  // namespace udar

#include <CLI/CLI.hpp>
#include <memory>

#include "udar/app/study_commands.hpp"
#include "udar/study/sweep.hpp"

namespace udar {
namespace {

constexpr const char* sweep_footer = R"(Examples:
  udar sweep cases/short-beam/short-beam.toml --vary obstacles.stop.friction=0,0.1,0.2,0.35
  udar sweep cases/short-beam/short-beam.toml --vary bodies.beam.velocity.1="-20 m/s","-40 m/s","-80 m/s"
  udar sweep CASE.toml --vary bodies.ball.velocity.0="20:100:20 m/s" --vary bodies.ball.mesh.diagonals=right,alternating
  udar sweep CASE.toml --vary obstacles.stop.friction=0:0.5:0.05 --show contacts.stop.duration_99

FIRST:LAST:STEP is a range. With several --vary every combination is computed. Runs that are done are not done
again.)";

struct Arguments : StudyArguments {
  std::vector<std::string> varied;
};

ExitCode sweep(const Arguments& arguments) {
  std::vector<Variation> variations;
  for (const std::string& text : arguments.varied) variations.push_back(read_variation(text));
  const StudyInput input = study_input(arguments);
  StudyJob job{.kind = "sweep", .plan = plan_sweep(input, variations), .conclude = {}};
  job.conclude = [&](const std::filesystem::path&, const std::vector<Standing>& standings) {
    return collect_sweep(input, variations, job.plan, standings, arguments.shown);
  };
  return do_study(arguments, job);
}

}  // namespace

Command add_sweep(CLI::App& app) {
  CLI::App* words = app.add_subcommand("sweep", "Run a case with several values of what it says");
  words->footer(sweep_footer);
  const auto arguments = std::make_shared<Arguments>();
  add_study_options(*words, *arguments, "sweep");
  words->add_option("--vary", arguments->varied, "What to vary, and its values; as often as needed")
      ->required()
      ->type_name("KEY=V1,V2,...")
      ->allow_extra_args(false);
  return {words, [arguments] { return sweep(*arguments); }, "made"};
}

}  // namespace udar

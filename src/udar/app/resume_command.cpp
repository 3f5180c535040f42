#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "udar/app/commands.hpp"
#include "udar/app/run_result.hpp"
#include "udar/app/terminal.hpp"
#include "udar/case/case_file.hpp"
#include "udar/results/file.hpp"
#include "udar/results/run_files.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/simulation/checkpoint.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

constexpr const char* resume_footer = R"(Examples:
  udar resume runs/short-beam
  udar resume runs/short-beam --threads 8

The results are those of a run that was never stopped, to the last bit, on any
number of threads. A run leaves a checkpoint every minute of wall time, and where
Ctrl-C, SIGTERM or SIGHUP stopped it; `[output] checkpoint` says how often.)";

struct ResumeArguments {
  std::string folder;
  bool no_report = false;
  int threads = 0;
};

/// Why the run stopped; "" where it was killed, or goes on.
std::string stop_reason_of(const fs::path& folder) {
  try {
    return read_summary(folder / RunFolder::summary).stop_reason;
  } catch (const OutputError&) {
    return "";
  }
}

/// An edited case would not be what is computed: better to say so.
void refuse_changed_case(const fs::path& folder, const Checkpoint& checkpoint) {
  const fs::path path = folder / RunFolder::resolved_case;
  std::error_code error;
  if (!fs::exists(path, error) || read_file(path, std::size_t{1} << 24) == checkpoint.run.case_text) return;
  throw UserError(ExitCode::checkpoint,
                  fmt::format("{} is not the case that was running: it was changed since", path.string()),
                  "undo the change, or remove the file: the checkpoint has the case; to compute another case, run it");
}

/// Goes on. The checkpoint's memory is free again at the end.
Summary compute(const ResumeArguments& arguments, RunOptions& options, bool& report) {
  std::vector<std::string> notes;
  Checkpoint checkpoint = newest_checkpoint(arguments.folder, notes);
  refuse_changed_case(arguments.folder, checkpoint);
  for (const std::string& note : notes) {
    complain("warning: {}\n  = the older checkpoint is used\n", note);
  }
  Simulation simulation(read_case(checkpoint.run.case_text, RunFolder::resolved_case));
  report = simulation.input().output.report && !arguments.no_report;
  options.case_name = checkpoint.run.case_name;
  options.folder = arguments.folder;
  options.threads = arguments.threads;
  options.command = "udar resume " + arguments.folder;
  options.resume = &checkpoint;
  return run_with_status(simulation, options, fmt::format(", from step {} on", checkpoint.run.steps));
}

ExitCode resume(const ResumeArguments& arguments) {
  check_run_folder(arguments.folder);
  RunFolder folder = reopen_run_folder(arguments.folder);  // not one that is under way
  const std::string reason = stop_reason_of(arguments.folder);
  if (reason == "numerical") {
    throw UserError(ExitCode::numerical, fmt::format("the run in `{}` failed: it would fail again", arguments.folder),
                    "log.txt there says why; change the case and run it anew");
  }
  if (reason == "end_time") {
    // One that was killed at its very end may have left some.
    CheckpointKeeper(folder, std::nullopt, nullptr).remove();
    say("{}: the run is complete, there is nothing to resume\n", arguments.folder);
    return ExitCode::done;
  }
  folder.lock.reset();  // the run takes it again
  RunOptions options;
  bool report = false;
  const Summary summary = compute(arguments, options, report);
  return conclude_run(summary, arguments.folder, report);
}

}  // namespace

Command add_resume(CLI::App& app) {
  CLI::App* words = app.add_subcommand("resume", "Go on with a run that was stopped, as if it never had been");
  words->footer(resume_footer);
  const auto arguments = std::make_shared<ResumeArguments>();
  words->add_option("RUN", arguments->folder, "Folder of the run")->required();
  words->add_flag("--no-report", arguments->no_report, "Leave no report.html");
  words
      ->add_option("--threads", arguments->threads,
                   "Number of threads, 1 to 1024; else what serves the size of the case")
      ->type_name("N")
      ->check(CLI::Range(1, 1024).description(""));
  return {words, [arguments] { return resume(*arguments); }, "resumed"};
}

}  // namespace udar

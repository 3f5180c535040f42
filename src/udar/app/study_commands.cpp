#include "udar/app/study_commands.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "udar/app/signals.hpp"
#include "udar/app/terminal.hpp"
#include "udar/base/human_unit.hpp"
#include "udar/parallel/for_each.hpp"
#include "udar/report/study_page.hpp"
#include "udar/report/study_plots.hpp"
#include "udar/study/estimate.hpp"
#include "udar/study/headlines.hpp"
#include "udar/study/study_folder.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

using State = Standing::State;
using std::chrono::steady_clock;

long long count(const std::vector<Standing>& standings, State state) {
  return std::count_if(standings.begin(), standings.end(), [&](const Standing& s) { return s.state == state; });
}

/// One line for all runs: how many are done, how far those in flight are, when the last one ends.
class StudyStatus {
 public:
  explicit StudyStatus(const std::vector<PlannedRun>& plan) : plan_(plan) {}

  void tell(const std::vector<Standing>& standings) {
    const auto now = steady_clock::now();
    if (now < next_) return;
    next_ = now + (is_terminal() ? std::chrono::milliseconds(250) : std::chrono::seconds(10));
    const double done = cost_done(standings);
    if (before_ < 0) before_ = done;
    const double spent = std::chrono::duration<double>(now - begin_).count();
    const double left = done > before_ ? spent * (1 - done) / (done - before_) : -1;
    std::string line = fmt::format("{} of {} done", count(standings, State::done), standings.size());
    if (const long long failed = count(standings, State::failed)) line += fmt::format(", {} failed", failed);
    if (count(standings, State::running) > 0)
      line += fmt::format("   ETA {}  ", left >= 0 ? clock_text(left) : "--:--");
    for (std::size_t k = 0; k < plan_.size(); ++k) {
      if (standings[k].state != State::running) continue;
      line += fmt::format(" {} {:.0f} %", plan_[k].name, std::floor(100 * standings[k].part));
    }
    say_in_place(line);
  }

  static void finish() {
    if (is_terminal()) say("\r\x1b[K");
  }

 private:
  /// Part of the whole work.
  [[nodiscard]] double cost_done(const std::vector<Standing>& standings) const {
    double done = 0;
    double all = 0;
    for (std::size_t k = 0; k < plan_.size(); ++k) {
      all += plan_[k].cost;
      const bool over = standings[k].state == State::done || standings[k].state == State::failed;
      done += plan_[k].cost * (over ? 1 : standings[k].part);
    }
    return done / all;
  }

  const std::vector<PlannedRun>& plan_;
  double before_ = -1;  ///< part that was done when this began
  steady_clock::time_point begin_ = steady_clock::now();
  steady_clock::time_point next_ = begin_;
};

fs::path folder_for(const StudyArguments& arguments, const std::string& kind) {
  if (!arguments.output.empty()) return arguments.output;
  return fs::path("runs") / (fs::path(arguments.input.file).stem().string() + "-" + kind);
}

ExitCode list_runs(const StudyArguments& arguments, const StudyJob& job, const fs::path& folder) {
  const std::size_t missing = write_commands(study_input(arguments), folder, job.plan);
  say("{}: {} of {}, one on each line, in any order\n", (folder / StudyFolder::commands).string(),
      counted(static_cast<long long>(missing), "command"), counted(static_cast<long long>(job.plan.size()), "run"));
  say("  when they are done, the same command without --list says what they tell together\n");
  return ExitCode::done;
}

/// Makes the page and the plots. A study is as good without them, and says so.
std::vector<std::string> draw(const fs::path& folder, bool& page) {
  std::vector<std::string> notes;
  const auto attempt = [&](const char* what, const auto& make) {
    try {
      make();
    } catch (const UserError& error) {
      notes.push_back(fmt::format("no {}: {}", what, error.diagnostics.front().message));
    } catch (const OutputError& error) {
      notes.push_back(fmt::format("no {}: {}", what, error.what()));
    }
  };
  attempt("plots", [&] { write_study_plots(folder, {.interrupted = is_interrupted}); });
  attempt("study.html", [&] {
    ReportOptions options;
    options.interrupted = is_interrupted;
    const ReportInfo info = write_study_page(folder, options);
    page = !info.path.empty();
    notes.insert(notes.end(), info.left_out.begin(), info.left_out.end());
  });
  if (is_interrupted()) notes.emplace_back("interrupted: `udar report` makes the page and the plots");
  return notes;
}

template <class Items>
std::string tally(const Items& items, std::string_view what) {
  if (items.empty()) return "";
  std::string text = fmt::format("{:<10}", what);
  for (const std::string_view v :
       {verdict::converged, verdict::converging, verdict::not_converging, verdict::unknown}) {
    const auto number = std::count_if(items.begin(), items.end(), [&](const auto& item) { return item.verdict == v; });
    if (number > 0) text += fmt::format("  {} {}", number, v);
  }
  return text + "\n";
}

/// A sign before a headline: colours are not for every terminal.
std::string_view sign_of(const std::string& verdict) {
  if (verdict == verdict::converged) return "ok";
  if (verdict == verdict::converging) return " ~";
  return verdict == verdict::not_converging ? " !" : " ?";
}

void print_headlines(const Study& study) {
  std::size_t width = 0;
  for (const std::string& line : study.headlines) width = std::max(width, line.find(" = "));
  std::size_t next = 0;
  for (const StudyQuantity& q : study.quantities) {
    if (!q.headline || !std::isfinite(q.value) || next >= study.headlines.size()) continue;
    const std::string& line = study.headlines[next++];
    const std::size_t equals = line.find(" = ");
    say("{}  {:<{}}{}\n", sign_of(q.verdict), line.substr(0, equals), width, line.substr(equals));
  }
  say("\nok converged to {:g} %   ~ converging   ! not converging   ? unknown\n", 100 * study.tolerance);
}

/// What was varied, and the first numbers, as many as a line takes.
void print_sweep(const Study& study) {
  std::vector<const StudyQuantity*> shown;
  for (const StudyQuantity& q : study.quantities) {
    if (q.headline) shown.push_back(&q);
  }
  std::stable_partition(shown.begin(), shown.end(), [](const auto* q) { return q->name.starts_with("contacts."); });
  constexpr std::size_t most = 4;
  shown.resize(std::min(shown.size(), most));
  for (std::size_t k = 0; k < shown.size(); ++k) say("({}) {}\n", k + 1, words_of(shown[k]->name));
  std::size_t width = 12;
  for (const StudyRun& run : study.runs) {
    constexpr std::size_t widest = 40;
    for (const std::string& text : run.texts) width = std::clamp(text.size(), width, widest);
  }
  say("\n{:<12}", "run");
  for (const std::string& path : study.varied) {
    std::string end = path;  // whole parts, as many as go
    while (end.size() > width && end.find('.') != std::string::npos) end.erase(0, end.find('.') + 1);
    say("{:>{}}", end, width + 2);
  }
  for (std::size_t k = 0; k < shown.size(); ++k) say("{:>14}", fmt::format("({})", k + 1));
  say("\n");
  constexpr std::size_t most_runs = 50;
  for (std::size_t r = 0; r < std::min(study.runs.size(), most_runs); ++r) {
    say("{:<12}", study.runs[r].name);
    for (const std::string& text : study.runs[r].texts) say("{:>{}}", text.substr(0, width), width + 2);
    for (const StudyQuantity* q : shown)
      say("{:>14}", std::isfinite(q->values[r]) ? human_text(q->values[r], q->unit, 4) : "-");
    say("\n");
  }
  if (study.runs.size() > most_runs) say("and {} more in study.md\n", study.runs.size() - most_runs);
}

void print_study(const Study& study) {
  say("\n");
  if (study.kind == "converge") {
    if (!study.headlines.empty()) print_headlines(study);
    say("{}{}{}", tally(study.quantities, "numbers"), tally(study.histories, "histories"),
        tally(study.fields, "fields"));
  } else {
    print_sweep(study);
  }
  for (const std::string& warning : study.warnings) say("  warning: {}\n", warning);
}

void print_failures(const Study& study) {
  for (const StudyRun& run : study.runs) {
    if (run.state != "done") say("  {} {}: {}\n", run.name, run.state, run.reason);
  }
}

}  // namespace

void add_study_options(CLI::App& command, StudyArguments& arguments, const std::string& kind) {
  add_case_options(command, arguments.input);
  command
      .add_option("--output", arguments.output,
                  fmt::format("Folder of the study; else runs/CASE-{}. What is done there is not done again", kind))
      ->type_name("DIR");
  command.add_option("--show", arguments.shown, "A number to show first, as study.csv names it; as often as needed")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command.add_option("--cores", arguments.cores, "How many threads all runs together may use; else all there are")
      ->type_name("N")
      ->check(CLI::Range(1, 1024).description(""));
  command.add_flag("--list", arguments.list, "Only write runs.txt, a command line for each run, for other machines");
  command.add_flag("--force", arguments.force, "Compute all runs again");
  command.add_flag("--no-report", arguments.no_report, "Leave no study.html and no plots");
}

StudyInput study_input(const StudyArguments& arguments) {
  return {.file = arguments.input.file, .assignments = arguments.input.assignments};
}

ExitCode do_study(const StudyArguments& arguments, const StudyJob& job) {
  const fs::path folder = folder_for(arguments, job.kind);
  const StudyLock lock = open_study_folder(folder);
  if (arguments.list) return list_runs(arguments, job, folder);

  const StudyInput input = study_input(arguments);
  RunAllOptions options{.cores = arguments.cores > 0 ? arguments.cores : available_threads(), .again = arguments.force};
  options.interrupted = is_interrupted;
  StudyStatus status(job.plan);
  options.tell = [&](const std::vector<Standing>& standings) { status.tell(standings); };
  say("{}: {} on {} -> {}\n", fs::path(arguments.input.file).stem().string(),
      counted(static_cast<long long>(job.plan.size()), "run"), counted(options.cores, "core"), folder.string());
  flush_terminal();
  catch_signals();
  const auto begin = steady_clock::now();
  const std::vector<Standing> standings = run_all(input, folder, job.plan, options);
  StudyStatus::finish();
  const long long done = count(standings, State::done);
  const long long failed = count(standings, State::failed);
  if (is_interrupted()) {
    say("stopped: {} of {} runs done; the same command goes on from here\n", done, standings.size());
    return code_of_signal();
  }
  say("{} of {} runs done{} in {}\n", done, standings.size(), failed > 0 ? fmt::format(", {} failed", failed) : "",
      clock_text(std::chrono::duration<double>(steady_clock::now() - begin).count()));
  flush_terminal();

  const Study study = job.conclude(folder, standings);
  write_study(folder, study);
  bool page = false;
  std::vector<std::string> notes;
  if (!arguments.no_report) notes = draw(folder, page);
  print_study(study);
  print_failures(study);
  for (const std::string& note : notes) say("  {}\n", note);
  say("-> {}{}\n", (folder / (page ? StudyFolder::page : StudyFolder::report)).string(),
      page ? ": look at it in a browser; tables are in study.md, study.csv, study.json" : "");
  return failed > 0 ? ExitCode::numerical : ExitCode::done;
}

}  // namespace udar

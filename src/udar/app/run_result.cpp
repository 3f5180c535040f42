#include "udar/app/run_result.hpp"

#include <unistd.h>

#include <algorithm>
#include <functional>
#include <new>

#include "udar/app/signals.hpp"
#include "udar/app/status_line.hpp"
#include "udar/app/terminal.hpp"
#include "udar/base/text.hpp"
#include "udar/report/report.hpp"
#include "udar/results/file.hpp"
#include "udar/results/run_folder.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

/// Peak force from which on a contact is shown, N: in a heap thousands of bodies meet, and the hardest 20 say enough.
double shown_from(const std::map<std::string, ContactSummary>& contacts) {
  constexpr std::size_t most = 20;
  std::vector<double> peaks;
  for (const auto& [name, c] : contacts) peaks.push_back(c.episodes.empty() ? 0 : c.peak_force);
  if (peaks.size() <= most) return 0;
  std::nth_element(peaks.begin(), peaks.begin() + most - 1, peaks.end(), std::greater<>());
  return peaks[most - 1];
}

void print_contacts(const Summary& summary) {
  if (summary.contacts.empty()) return;
  say("\n{:<16}{:>11}{:>11}{:>11}{:>15}{:>12}{:>13}\n", "contact", "touch", "left", "duration", "99 % of push",
      "peak force", "restitution");
  const double least = shown_from(summary.contacts);
  long long hidden = 0;
  for (const auto& [name, c] : summary.contacts) {
    if (least > 0 && (c.episodes.empty() || c.peak_force < least)) {
      ++hidden;
      continue;
    }
    if (c.episodes.empty()) {
      say("{:<16}{:>11}\n", name, "none");
      continue;
    }
    const double restitution = c.episodes.back().restitution;
    say("{:<16}{:>11}{:>11}{:>11}{:>15}{:>12}{:>13}{}\n", name, in_units(c.first_touch, "s"),
        c.last_separation == c.last_separation ? in_units(c.last_separation, "s") : "still on",
        in_units(c.duration, "s"), in_units(c.duration_99, "s"), in_units(c.peak_force, "N"),
        c.episodes.size() == 1 && restitution == restitution ? fmt::format("{:.3f}", restitution) : "-",
        c.episodes.size() > 1 ? fmt::format("  in {} episodes", c.episodes.size()) : "");
  }
  if (hidden > 0) say("and {} with less force, all in summary.json\n", hidden);
}

/// What became of report.html.
struct Made {
  bool report = false;
  bool interrupted = false;
  std::vector<std::string> notes;  ///< what was left out of it, or why there is none
};

/// Makes report.html. Where that fails the run is as good as without it, and says so.
Made make_report(const fs::path& folder) {
  const bool terminal = isatty(STDOUT_FILENO) == 1;
  if (terminal) {
    say("making report.html ... (Ctrl-C: go without)");
    flush_terminal();
  }
  Made made;
  const OnlyNewSignals only_new;  // a run that was interrupted has a report too
  try {
    ReportOptions options;
    options.interrupted = is_interrupted;
    const ReportInfo info = write_report(folder, options);
    made.interrupted = info.path.empty();
    made.report = !made.interrupted;
    made.notes = info.left_out;
    if (made.interrupted) made.notes.emplace_back("no report.html: interrupted; `udar report` makes it");
  } catch (const UserError& error) {
    const Diagnostic& reason = error.diagnostics.front();
    made.notes.push_back("no report.html: " + reason.message);
    made.notes.push_back("  = " + reason.cure);
  } catch (const OutputError& error) {
    made.notes.push_back(fmt::format("no report.html: {}", error.what()));
  } catch (const std::bad_alloc&) {
    made.notes.emplace_back("no report.html: not enough memory");
  }
  if (terminal) say("\r\x1b[K");
  return made;
}

bool has_checkpoint(const fs::path& folder) {
  std::error_code error;
  return std::any_of(RunFolder::checkpoints.begin(), RunFolder::checkpoints.end(),
                     [&](std::string_view name) { return fs::exists(folder / name, error); });
}

void print_result(const Summary& s, const fs::path& folder, const Made& made) {
  print_contacts(s);
  say("\n{} elements x {} in {}: {} element-steps/s, {}\n", s.elements, counted(s.steps, "step"),
      in_units(s.stepping_seconds, "s"), in_units(s.element_steps_per_second, ""), counted(s.threads, "thread"));
  const std::string warnings =
      s.warnings.empty() ? "" : fmt::format(" ({})", counted(static_cast<long long>(s.warnings.size()), "warning"));
  say("verdict: {}{}   energy {:.2g} %   momentum {:.1g}   penetration {:.2g} % of element   -> {}\n", s.verdict,
      warnings, 100 * s.energy_error, s.momentum_error, 100 * s.penetration_ratio,
      (made.report ? folder / RunFolder::report : folder).string());
  const bool told_as_error = s.stop_reason == "numerical" || s.stop_reason == "disk";
  for (std::size_t k = told_as_error ? 1 : 0; k < s.reasons.size(); ++k) say("  {}\n", s.reasons[k]);
  for (const std::string& warning : s.warnings) say("  warning: {}\n", warning);
  for (const std::string& note : made.notes) say("  {}\n", note);
  if (has_checkpoint(folder)) say("  it can go on from here: udar resume {}\n", shell_word(folder.string()));
  std::error_code error;
  const std::string_view picture = made.report ? RunFolder::report : RunFolder::final_picture;
  if (fs::exists(folder / picture, error)) say("  look at {} in a browser", picture);
  if (fs::exists(folder / RunFolder::fields_index, error)) say(", at fields.pvd in ParaView (Apply, then play)");
  say("; numbers are in summary.json and histories/\n");
}

ExitCode exit_code_of(const Summary& s) {
  if (s.stop_reason == "numerical") return ExitCode::numerical;
  if (s.stop_reason == "disk") return ExitCode::output;
  if (s.stop_reason != "interrupted") return ExitCode::done;
  return code_of_signal();
}

}  // namespace

Summary run_with_status(Simulation& simulation, RunOptions& options, const std::string& begins) {
  options.interrupted = is_interrupted;
  catch_signals();
  bool announced = false;
  StatusLine status(simulation.model().run.end_time);
  simulation.observe([&](const Model& model, const State& state) {
    if (!announced) {
      say("{}: {}, {}{} -> {}\n", options.case_name, counted(model.element_count, "element"),
          counted(model.node_count, "node"), begins, options.folder->string());
      flush_terminal();
      announced = true;
    }
    status.update(model, state);
  });
  Summary summary = simulation.run(options);
  status.finish(simulation.model(), simulation.state());
  return summary;
}

ExitCode conclude_run(const Summary& summary, const fs::path& folder, bool report) {
  if (summary.stop_reason == "numerical" || summary.stop_reason == "disk") {
    flush_terminal();
    complain("error: {}\n", summary.reasons.front());
  }
  Made made;
  if (report) made = make_report(folder);
  print_result(summary, folder, made);
  const ExitCode code = exit_code_of(summary);
  if (code != ExitCode::done || !made.interrupted) return code;
  return code_of_signal();
}

}  // namespace udar

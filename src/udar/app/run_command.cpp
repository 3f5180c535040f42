#include <fmt/core.h>

#include <csignal>
#include <filesystem>

#include "udar/app/commands.hpp"
#include "udar/app/status_line.hpp"
#include "udar/results/file.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/simulation/simulation.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

volatile std::sig_atomic_t caught_signal = 0;

extern "C" void note_signal(int signal) {
  caught_signal = signal;
  std::signal(signal, SIG_DFL);  // a second one ends the program at once
}

/// runs/<case>, or the first of runs/<case>-2, -3, ... that is not there: a run never replaces another by itself.
fs::path free_folder(const std::string& case_name) {
  fs::path folder = fs::path("runs") / case_name;
  for (int k = 2; fs::exists(folder); ++k) folder = fs::path("runs") / fmt::format("{}-{}", case_name, k);
  return folder;
}

void print_warnings(const std::vector<Diagnostic>& warnings) {
  for (const Diagnostic& w : warnings) fmt::print(stderr, "warning{}", to_text(w).substr(5));
}

std::string seconds_text(double seconds) {
  return seconds == seconds ? fmt::format("{:.4g} ms", 1e3 * seconds) : std::string("-");
}

void print_contacts(const Summary& summary) {
  for (const auto& [name, contact] : summary.contacts) {
    if (contact.episodes.empty()) {
      fmt::print(" {}: never touched\n", name);
      continue;
    }
    fmt::print(" {}: touched at {}, left at {}, lasted {} (99 % of the impulse in {}), peak {:.4g} kN\n", name,
               seconds_text(contact.first_touch), seconds_text(contact.last_separation), seconds_text(contact.duration),
               seconds_text(contact.duration_99), 1e-3 * contact.peak_force);
  }
}

void print_result(const Summary& s, const fs::path& folder) {
  fmt::print(" {} elements x {} steps in {:.3g} s: {:.3g} million element-steps per second, {} thread{}\n", s.elements,
             s.steps, s.wall_seconds, 1e-6 * s.element_steps_per_second, s.threads, s.threads == 1 ? "" : "s");
  print_contacts(s);
  fmt::print(" verdict: {}   energy {:.2g} %   momentum {:.1g}   penetration {:.2g} % of an element\n", s.verdict,
             100 * s.energy_error, s.momentum_error, 100 * s.penetration_ratio);
  for (const std::string& reason : s.reasons) fmt::print("   {}\n", reason);
  fmt::print(" results in {}\n", folder.string());
  fmt::print("   summary.json  histories/*.csv  setup.svg  final.svg (open in a browser)\n");
  if (fs::exists(folder / RunFolder::fields_index)) {
    fmt::print("   fields.pvd: open in ParaView, press Apply, then play\n");
  }
}

}  // namespace

ExitCode run_command(const RunArguments& arguments) {
  std::vector<Diagnostic> warnings;
  Simulation simulation(load_case(arguments.case_file, arguments.assignments, &warnings));
  print_warnings(warnings);

  RunOptions options;
  options.case_name = fs::path(arguments.case_file).stem().string();
  options.folder = arguments.output.empty() ? free_folder(options.case_name) : fs::path(arguments.output);
  options.force = arguments.force;
  options.threads = arguments.threads;
  constexpr std::size_t largest_case = 1 << 20;
  options.case_text = read_file(arguments.case_file, largest_case);
  options.interrupted = [] { return caught_signal != 0; };
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);

  const Model& model = simulation.model();
  fmt::print(" {}: {} elements, {} nodes, {}\n", options.case_name, model.element_count, model.node_count,
             options.folder->string());
  StatusLine status;
  simulation.observe([&](const Model& m, const State& state) { status.update(m, state); });
  const Summary summary = simulation.run(options);
  status.finish(model, simulation.state());
  print_result(summary, *options.folder);
  if (summary.stop_reason == "numerical") return ExitCode::numerical;
  if (summary.stop_reason == "interrupted") {
    return caught_signal == SIGTERM ? ExitCode::terminated : ExitCode::interrupted;
  }
  return ExitCode::done;
}

}  // namespace udar

#include "udar/study/convergence.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"
#include "udar/case/case_file.hpp"
#include "udar/results/summary_numbers.hpp"
#include "udar/simulation/simulation.hpp"
#include "udar/study/compare_levels.hpp"
#include "udar/study/estimate.hpp"
#include "udar/study/headlines.hpp"

namespace udar {
namespace {

bool is_done(const Standing& s) { return s.state == Standing::State::done; }

/// Of the lines of the grid (`line` of a run: its step, or its mesh) the one with most runs that are done, the finest
/// of several.
template <class Line>
std::vector<std::size_t> fullest_line(const std::vector<PlannedRun>& plan, const std::vector<Standing>& standings,
                                      int lines, Line line) {
  std::vector<std::size_t> best;
  for (int k = lines - 1; k >= 0; --k) {
    std::vector<std::size_t> runs;
    for (std::size_t r = 0; r < plan.size(); ++r) {
      if (line(plan[r]) == k && is_done(standings[r])) runs.push_back(r);
    }
    if (runs.size() > best.size()) best = std::move(runs);
  }
  return best;
}

std::vector<double> along(const Axis& axis, const std::vector<double>& values) {
  std::vector<double> out;
  for (const std::size_t run : axis.runs) out.push_back(values[run]);
  return out;
}

std::string state_name(Standing::State state) {
  switch (state) {
    case Standing::State::done:
      return "done";
    case Standing::State::failed:
      return "failed";
    case Standing::State::running:
    case Standing::State::missing:
      break;
  }
  return "missing";
}

void judge(StudyQuantity& q, double scale, const Axis& mesh, const Axis& step, double tolerance) {
  const Standard standard{.tolerance = tolerance, .zero = rounding_part * scale};
  const Axis& finest = mesh.is_refined() ? mesh : step;
  if (!finest.runs.empty()) q.value = q.values[finest.runs.back()];
  if (mesh.is_refined()) q.mesh = estimate_limit(along(mesh, q.values), mesh.sizes, standard);
  if (step.is_refined()) q.step = estimate_limit(along(step, q.values), step.sizes, standard);
  q.verdict = worse(q.mesh.verdict, q.step.verdict);
}

template <class Observers>
void tell_windows_of(std::vector<StudyQuantity>& quantities, const Observers& observers) {
  for (const auto& observer : observers) {
    if (observer.window.begin == 0 && std::isinf(observer.window.end)) continue;
    const std::string end = std::isinf(observer.window.end) ? "the end" : in_units(observer.window.end, "s");
    for (StudyQuantity& q : quantities) {
      const bool of_it = q.name.starts_with(fmt::format("histories.{}.", observer.name));
      if (of_it) q.window = fmt::format("{} to {}", in_units(observer.window.begin, "s"), end);
    }
  }
}

}  // namespace

void tell_windows(std::vector<StudyQuantity>& quantities, const Case& c) {
  tell_windows_of(quantities, c.observed_nodes);
  tell_windows_of(quantities, c.observed_elements);
  tell_windows_of(quantities, c.observed_regions);
}

std::vector<std::string> warnings_of(const std::vector<StudyRun>& runs) {
  std::vector<std::string> warnings;
  for (const StudyRun& run : runs) {
    if (run.state == "done" && run.verdict != "good") {
      warnings.push_back(fmt::format("{}: the run itself is {}; its log.txt says why", run.name, run.verdict));
    }
    if (run.shortened_steps > 0) {
      warnings.push_back(fmt::format("{}: {} of {} steps were shortened, so its step is not the one asked for",
                                     run.name, run.shortened_steps, run.steps));
    }
  }
  return warnings;
}

Axis mesh_axis(const std::vector<PlannedRun>& plan, const std::vector<Standing>& standings,
               const ConvergenceLevels& levels) {
  Axis axis;
  axis.runs = fullest_line(plan, standings, levels.steps, [](const PlannedRun& run) { return run.step; });
  for (const std::size_t run : axis.runs) {
    // What was meshed, not what was asked for: whole cells only.
    const auto elements = static_cast<double>(standings[run].summary->elements);
    axis.sizes.push_back(1 / std::sqrt(elements));
  }
  return axis;
}

Axis step_axis(const std::vector<PlannedRun>& plan, const std::vector<Standing>& standings,
               const ConvergenceLevels& levels) {
  Axis axis;
  axis.runs = fullest_line(plan, standings, levels.meshes, [](const PlannedRun& run) { return run.mesh; });
  for (const std::size_t run : axis.runs) axis.sizes.push_back(std::ldexp(1.0, -plan[run].step));
  return axis;
}

std::vector<StudyRun> runs_of(const std::vector<PlannedRun>& plan, const std::vector<Standing>& standings) {
  std::vector<StudyRun> runs;
  for (std::size_t k = 0; k < plan.size(); ++k) {
    StudyRun run{.name = plan[k].name,
                 .changes = plan[k].changes,
                 .texts = plan[k].texts,
                 .mesh = plan[k].mesh,
                 .step = plan[k].step,
                 .state = state_name(standings[k].state),
                 .reason = standings[k].reason};
    if (const auto& s = standings[k].summary) {
      run.verdict = s->verdict;
      run.elements = s->elements;
      run.steps = s->steps;
      run.threads = s->threads;
      run.stepping_seconds = s->stepping_seconds;
      run.shortest_step = s->time_step.min;
      run.longest_step = s->time_step.max;
      run.energy_error = s->energy_error;
      run.shortened_steps = s->time_step.shortened_steps;
    }
    runs.push_back(std::move(run));
  }
  return runs;
}

std::vector<StudyQuantity> quantities_of(const std::vector<Standing>& standings, std::vector<double>& scales) {
  std::vector<StudyQuantity> quantities;
  std::map<std::string, std::size_t> numbers;
  // From the finest run on, so that its order counts.
  for (std::size_t k = standings.size(); k-- > 0;) {
    if (!is_done(standings[k])) continue;
    for (SummaryNumber& n : numbers_of(*standings[k].summary)) {
      const auto [at, is_new] = numbers.emplace(n.name, quantities.size());
      if (is_new) {
        quantities.push_back({.name = n.name, .unit = n.unit, .values = std::vector(standings.size(), no_number)});
        scales.push_back(0);
      }
      quantities[at->second].values[k] = n.value;
      scales[at->second] = std::max(scales[at->second], n.scale);
    }
  }
  std::vector<StudyQuantity> kept;
  std::vector<double> kept_scales;
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    const auto is_something = [&](double v) { return std::fabs(v) > rounding_part * scales[q]; };
    if (std::none_of(quantities[q].values.begin(), quantities[q].values.end(), is_something)) continue;
    kept.push_back(std::move(quantities[q]));
    kept_scales.push_back(scales[q]);
  }
  scales = std::move(kept_scales);
  return kept;
}

Study analyse_convergence(const StudyInput& input, const std::filesystem::path& folder,
                          const std::vector<PlannedRun>& plan, const std::vector<Standing>& standings,
                          const ConvergenceOptions& options) {
  Study study{.kind = "converge",
              .version = version_text(),
              .case_name = input.file.stem().string(),
              .meshes = options.levels.meshes,
              .mesh_ratio = options.levels.ratio,
              .element_sizes = element_sizes(input, options.levels),
              .steps = options.levels.steps,
              .tolerance = options.tolerance,
              .comparison = {.aligned = options.aligned, .window = options.window > 0 ? options.window : no_number},
              .runs = runs_of(plan, standings)};
  const Levels levels{folder, plan, standings, mesh_axis(plan, standings, options.levels),
                      step_axis(plan, standings, options.levels)};
  std::vector<double> scales;
  study.quantities = quantities_of(standings, scales);
  for (std::size_t q = 0; q < study.quantities.size(); ++q) {
    judge(study.quantities[q], scales[q], levels.mesh, levels.step, options.tolerance);
  }
  tell_windows(study.quantities, load_case(input.file, input.assignments));
  study.warnings = warnings_of(study.runs);
  study.histories = compare_histories(levels, options);
  try {
    study.fields = compare_fields(levels, options);
  } catch (const UserError& error) {  // the numbers and histories are as good without
    study.warnings.push_back("fields are not compared: " + error.diagnostics.front().message);
  }
  mark_headlines(study, options.headlines);
  return study;
}

}  // namespace udar

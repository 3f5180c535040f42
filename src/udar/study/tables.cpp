#include "udar/study/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "udar/base/human_unit.hpp"
#include "udar/base/text.hpp"
#include "udar/study/headlines.hpp"

namespace udar {
namespace {

// Text
// -----------------------------------------------------------------------------------------------------------------

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string csv_number(double value) { return std::isfinite(value) ? shortest(value) : ""; }

/// Names are the user's: a `|` would begin a new column, an end of line a new row.
std::string cell(const std::string& text) {
  std::string out;
  for (const char letter : text) {
    const char c = letter == '\n' ? ' ' : letter;
    if (c == '|' || c == '<' || c == '`' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string number(double value, int digits = 4) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "–";
}
std::string percent(double part) {
  if (!std::isfinite(part)) return "–";
  return part < 0.1 ? fmt::format("{:.2g} %", 100 * part) : fmt::format("{:.0f} %", 100 * part);
}

std::string row(const std::vector<std::string>& cells) { return fmt::format("| {} |\n", fmt::join(cells, " | ")); }

std::string head(const std::vector<std::string>& cells) {
  std::string line = row(cells) + "|";
  for (std::size_t k = 0; k < cells.size(); ++k) line += k == 0 ? "---|" : "---:|";
  return line + "\n";
}

// Convergence
// ----------------------------------------------------------------------------------------------------------

std::string convergence_csv(const Study& study) {
  std::string out = "name,unit";
  for (const StudyRun& run : study.runs) out += "," + run.name;
  for (const char* along : {"mesh", "step"}) {
    for (const char* what : {"order", "extrapolated", "error", "verdict"}) out += fmt::format(",{} {}", along, what);
  }
  out += "\n";
  for (const StudyQuantity& q : study.quantities) {
    out += csv_text(q.name) + "," + q.unit;
    for (const double v : q.values) out += "," + csv_number(v);
    for (const Estimate* e : {&q.mesh, &q.step}) {
      out += fmt::format(",{},{},{},{}", csv_number(e->order), csv_number(e->extrapolated), csv_number(e->error),
                         e->verdict);
    }
    out += "\n";
  }
  return out;
}

std::string run_table(const Study& study) {
  std::string out = head({"run", "elements", "steps", "shortest step", "longest step", "energy error",
                          "verdict of the run", "time", "threads"});
  for (const StudyRun& r : study.runs) {
    if (r.state != "done") {
      out += row({r.name, fmt::format("{}: {}", r.state, cell(r.reason)), "", "", "", "", "", "", ""});
      continue;
    }
    out += row({r.name, std::to_string(r.elements), std::to_string(r.steps), human_text(r.shortest_step, "s", 4),
                human_text(r.longest_step, "s", 4), percent(r.energy_error), r.verdict,
                human_text(r.stepping_seconds, "s"), std::to_string(r.threads)});
  }
  return out;
}

/// One direction of refinement: which member of a quantity, and what its levels are called.
struct Direction {
  Estimate StudyQuantity::*of = nullptr;
  std::vector<std::string> levels;
};

std::string quantity_row(const StudyQuantity& q, const Direction& along) {
  const Estimate& e = q.*along.of;
  double largest = 0;
  for (const double v : e.values) largest = std::max(largest, std::fabs(v));
  const HumanUnit unit = human_unit(q.unit, largest);
  const auto value = [&](double v) { return number(v / unit.size, 5); };
  std::vector<std::string> cells{cell(q.name), unit.name};
  // Coarse levels that are missing have no value.
  for (std::size_t k = e.values.size(); k < along.levels.size(); ++k) cells.emplace_back("–");
  for (const double v : e.values) cells.push_back(value(v));
  cells.push_back(e.differences.empty() ? "–" : percent(e.differences.back()));
  cells.push_back(number(e.order, 2));
  cells.push_back(value(e.extrapolated));
  cells.push_back(number(e.error / unit.size, 2));
  cells.push_back(e.verdict);
  cells.push_back(e.reason);
  return row(cells);
}

std::string quantity_table(const Study& study, const Direction& along) {
  std::vector<std::string> titles{"number", "unit"};
  titles.insert(titles.end(), along.levels.begin(), along.levels.end());
  titles.insert(titles.end(), {"last change", "order", "limit", "error bar", "verdict", "why"});
  std::string out = head(titles);
  for (const bool headline : {true, false}) {
    for (const StudyQuantity& q : study.quantities) {
      if (q.headline == headline && !(q.*along.of).verdict.empty()) out += quantity_row(q, along);
    }
  }
  return out;
}

std::string difference_table(const std::vector<StudyDifference>& all, bool with_time, Estimate StudyDifference::*l2,
                             Estimate StudyDifference::*max) {
  std::vector<std::string> titles{with_time ? "field" : "history"};
  if (with_time) titles.emplace_back("time");
  titles.insert(titles.end(),
                {"size (rms)", "changes (rms)", "last change (largest)", "order", "error bar", "verdict", "why"});
  std::string out = head(titles);
  for (const StudyDifference& d : all) {
    const Estimate& e = d.*l2;
    if (e.verdict.empty()) continue;
    std::vector<std::string> changes;
    for (const double part : e.differences) changes.push_back(percent(part));
    std::vector<std::string> cells{cell(d.name)};
    if (with_time) cells.push_back(human_text(d.time, "s", 4));
    const std::vector<double>& largest = (d.*max).differences;
    cells.insert(cells.end(), {human_text(d.size, d.unit), fmt::format("{}", fmt::join(changes, " → ")),
                               largest.empty() ? "–" : percent(largest.back()), number(e.order, 2), percent(e.error),
                               e.verdict, e.reason});
    out += row(cells);
  }
  return out;
}

std::string difference_section(const Study& study, const std::string& along, Estimate StudyDifference::*l2,
                               Estimate StudyDifference::*max) {
  std::string out;
  if (!study.histories.empty()) {
    out += fmt::format("\n### Histories, by the {}\n\n", along) + difference_table(study.histories, false, l2, max);
  }
  if (!study.fields.empty()) {
    out += fmt::format("\n### Fields, by the {}\n\n", along) + difference_table(study.fields, true, l2, max);
  }
  return out;
}

bool any_judged(const Study& study, Estimate StudyQuantity::*of) {
  return std::any_of(study.quantities.begin(), study.quantities.end(),
                     [&](const StudyQuantity& q) { return !(q.*of).verdict.empty(); });
}

std::string comparison_text(const Study& study) {
  std::string text = "Histories and fields: difference of each level from the next finer one, relative to the finest.";
  if (study.comparison.aligned) text += " Histories are laid over each other at first touch.";
  if (study.comparison.window > 0) {
    text += fmt::format(" Histories are averaged over {}.", human_text(study.comparison.window, "s"));
  }
  return text;
}

std::string convergence_markdown(const Study& study) {
  std::string out = fmt::format("# {}: convergence\n\n", cell(study.case_name));
  for (const std::string& line : study.headlines) out += fmt::format("- {}\n", cell(line));
  out += fmt::format(
      "\nThe value is that of the finest level; ± is the error bar (grid convergence index). An error bar of at most "
      "{} is "
      "`converged`. {}\n",
      percent(study.tolerance), study.version);
  out += "\n## Runs\n\n" + run_table(study);
  if (any_judged(study, &StudyQuantity::mesh)) {
    Direction mesh{&StudyQuantity::mesh, {}};
    for (const double size : study.element_sizes) mesh.levels.push_back(human_text(size, "m", 4));
    out += "\n## Refining the mesh\n\n### Numbers, by the mesh\n\n" + quantity_table(study, mesh);
    out += difference_section(study, "mesh", &StudyDifference::mesh_l2, &StudyDifference::mesh_max);
  }
  if (any_judged(study, &StudyQuantity::step)) {
    Direction step{&StudyQuantity::step, {}};
    for (int j = 0; j < study.steps; ++j) step.levels.push_back(j == 0 ? "step" : fmt::format("step / {}", 1 << j));
    out += "\n## Refining the time step\n\n### Numbers, by the step\n\n" + quantity_table(study, step);
    out += difference_section(study, "step", &StudyDifference::step_l2, &StudyDifference::step_max);
  }
  return out + "\n" + comparison_text(study) + "\n";
}

// Sweeps
// ---------------------------------------------------------------------------------------------------------------

std::string sweep_csv(const Study& study) {
  std::string out = "run,state";
  for (const std::string& path : study.varied) out += "," + csv_text(path);
  for (const StudyQuantity& q : study.quantities) {
    out += "," + csv_text(q.unit.empty() ? q.name : fmt::format("{} [{}]", q.name, q.unit));
  }
  out += "\n";
  for (std::size_t r = 0; r < study.runs.size(); ++r) {
    out += study.runs[r].name + "," + study.runs[r].state;
    for (const std::string& text : study.runs[r].texts) out += "," + csv_text(text);
    for (const StudyQuantity& q : study.quantities) out += "," + csv_number(q.values[r]);
    out += "\n";
  }
  return out;
}

std::string sweep_markdown(const Study& study) {
  std::string out = fmt::format("# {}: sweep\n\n", cell(study.case_name));
  std::vector<std::string> titles{"run"};
  for (const std::string& path : study.varied) titles.push_back(cell(path));
  std::vector<HumanUnit> units;
  std::vector<const StudyQuantity*> shown;
  for (const StudyQuantity& q : study.quantities) {
    if (!q.headline) continue;
    double largest = 0;
    for (const double v : q.values) largest = std::isfinite(v) ? std::max(largest, std::fabs(v)) : largest;
    shown.push_back(&q);
    units.push_back(human_unit(q.unit, largest));
    titles.push_back(cell(units.back().name.empty() ? q.name : fmt::format("{} [{}]", q.name, units.back().name)));
  }
  titles.emplace_back("verdict of the run");
  out += head(titles);
  for (std::size_t r = 0; r < study.runs.size(); ++r) {
    const StudyRun& run = study.runs[r];
    std::vector<std::string> cells{run.name};
    for (const std::string& text : run.texts) cells.push_back(cell(text));
    for (std::size_t k = 0; k < shown.size(); ++k) cells.push_back(number(shown[k]->values[r] / units[k].size));
    cells.push_back(run.state == "done" ? run.verdict : fmt::format("{}: {}", run.state, cell(run.reason)));
    out += row(cells);
  }
  return out + "\nAll numbers are in study.csv. " + study.version + "\n";
}

}  // namespace

std::string to_csv(const Study& study) { return study.kind == "sweep" ? sweep_csv(study) : convergence_csv(study); }

std::string to_markdown(const Study& study) {
  return study.kind == "sweep" ? sweep_markdown(study) : convergence_markdown(study);
}

}  // namespace udar

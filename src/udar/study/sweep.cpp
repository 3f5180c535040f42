#include "udar/study/sweep.hpp"

#include "udar/case/case_file.hpp"
#include "udar/simulation/simulation.hpp"
#include "udar/study/convergence.hpp"
#include "udar/study/headlines.hpp"
#include "udar/units/quantity.hpp"

namespace udar {
namespace {

/// SI value of "0.2", "2 mm" or "\"2 mm\""; NaN of other words.
double value_of(std::string text) {
  if (text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front()) {
    text = text.substr(1, text.size() - 2);
  }
  const auto quantity = parse_quantity(text);
  return quantity ? quantity->value : no_number;
}

}  // namespace

Study collect_sweep(const StudyInput& input, const std::vector<Variation>& variations,
                    const std::vector<PlannedRun>& plan, const std::vector<Standing>& standings,
                    const std::vector<std::string>& headlines) {
  Study study{.kind = "sweep",
              .version = version_text(),
              .case_name = input.file.stem().string(),
              .runs = runs_of(plan, standings)};
  for (const Variation& v : variations) study.varied.push_back(v.path);
  for (StudyRun& run : study.runs) {
    for (const std::string& text : run.texts) run.values.push_back(value_of(text));
  }
  std::vector<double> scales;
  study.quantities = quantities_of(standings, scales);
  for (StudyQuantity& q : study.quantities) {
    for (const double v : q.values) q.value = v == v ? v : q.value;
  }
  tell_windows(study.quantities, load_case(input.file, input.assignments));
  study.warnings = warnings_of(study.runs);
  mark_headlines(study, headlines);
  study.headlines.clear();  // a single value says nothing of a sweep
  return study;
}

}  // namespace udar

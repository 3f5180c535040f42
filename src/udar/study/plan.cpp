#include "udar/study/plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"
#include "udar/case/build_model.hpp"
#include "udar/case/case_file.hpp"

namespace udar {
namespace {

constexpr std::size_t most_runs = 10000;
constexpr const char* range_form = "write FIRST:LAST:STEP UNIT, as in 0:0.5:0.1 or \"20:100:20 m/s\"";

Case with_changes(const StudyInput& input, const std::vector<std::string>& changes) {
  std::vector<std::string> all = input.assignments;
  all.insert(all.end(), changes.begin(), changes.end());
  return load_case(input.file, all);
}

void refuse(const std::string& message, const std::string& cure) { throw UserError(ExitCode::usage, message, cure); }

/// Changes of the case that divide all sizes of elements and the step.
std::vector<std::string> level_changes(const Case& c, double element_part, double step_part) {
  std::vector<std::string> changes;
  const auto set = [&](const std::string& path, double value, const char* unit) {
    changes.push_back(unit[0] != '\0' ? fmt::format("{}=\"{} {}\"", path, shortest(value), unit)
                                      : fmt::format("{}={}", path, shortest(value)));
  };
  for (const BodyCase& body : c.bodies) {
    const std::string path = "bodies." + body.name + ".mesh.";
    std::visit(
        [&](const auto& mesh) {
          if (element_part == 1) return;
          set(path + "element_size", mesh.element_size * element_part, "m");
          if (mesh.finest_size) set(path + "finest_size", *mesh.finest_size * element_part, "m");
        },
        body.mesh);
  }
  if (c.run.time_step) {
    const double part = element_part * step_part;
    if (part != 1) set("run.time_step", *c.run.time_step * part, "s");
  } else if (step_part != 1) {
    set("run.step_safety", c.run.step_safety * step_part, "");
  }
  return changes;
}

/// Elements that the case has; checks that it has a model.
double count_elements(const Case& c) { return build_model(c).element_count; }

std::vector<std::string> split_values(const std::string& text) {
  std::vector<std::string> values(1);
  int depth = 0;
  char quote = '\0';
  for (const char letter : text) {
    if (quote != '\0') {
      if (letter == quote) quote = '\0';
    } else if (letter == '"' || letter == '\'') {
      quote = letter;
    } else if (letter == '[' || letter == '{') {
      ++depth;
    } else if (letter == ']' || letter == '}') {
      --depth;
    } else if (letter == ',' && depth == 0) {
      values.emplace_back();
      continue;
    }
    values.back() += letter;
  }
  for (std::string& value : values) {
    value.erase(0, value.find_first_not_of(' '));
    value.erase(value.find_last_not_of(' ') + 1);
  }
  return values;
}

bool read_number(std::string_view& text, double& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || !std::isfinite(number)) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

/// "first:last:step unit" as a list; empty where the text is no such range.
std::vector<std::string> values_of_range(std::string_view text) {
  double first = 0;
  double last = 0;
  double step = 0;
  const auto colon = [&] {
    if (!text.starts_with(':')) return false;
    text.remove_prefix(1);
    return true;
  };
  if (!read_number(text, first) || !colon() || !read_number(text, last) || !colon() || !read_number(text, step))
    return {};
  const double count = (last - first) / step;
  const std::string range = fmt::format("the range {}:{}:{}", shortest(first), shortest(last), shortest(step));
  if (!(count >= 0)) refuse(range + " has no end that its step reaches", range_form);
  if (count > static_cast<double>(most_runs)) {
    refuse(fmt::format("{} has more than {} values", range, most_runs), "take a larger step");
  }
  const auto steps = static_cast<int>(std::floor(count * (1 + 1e-12) + 1e-9));
  std::vector<std::string> values;
  for (int k = 0; k <= steps; ++k) {
    // Twelve digits hide the rounding of k * step.
    values.push_back(fmt::format("{:.12g}{}", first + k * step, text));
  }
  return values;
}

/// No value of a case has a colon outside of a text or a table.
bool looks_like_range(const std::string& value) {
  return value.find(':') != std::string::npos && value.find_first_of("\"'{[") == std::string::npos;
}

/// The same key twice, or one within the other: the later would undo the earlier.
void refuse_overlaps(const std::vector<Variation>& variations) {
  for (std::size_t a = 0; a < variations.size(); ++a) {
    for (std::size_t b = a + 1; b < variations.size(); ++b) {
      const std::string one = variations[a].path + ".";
      const std::string two = variations[b].path + ".";
      if (!one.starts_with(two) && !two.starts_with(one)) continue;
      refuse(fmt::format("`{}` and `{}` vary the same value", variations[a].path, variations[b].path),
             "give all its values with one `--vary`");
    }
  }
}

}  // namespace

std::vector<PlannedRun> plan_convergence(const StudyInput& input, const ConvergenceLevels& levels) {
  const Case base = with_changes(input, {});
  const double elements = count_elements(base);
  std::vector<PlannedRun> runs;
  for (int i = 0; i < levels.meshes; ++i) {
    for (int j = 0; j < levels.steps; ++j) {
      const double finer = std::pow(levels.ratio, i);
      PlannedRun run{.name = fmt::format("mesh{}-step{}", i + 1, j + 1), .mesh = i, .step = j};
      run.changes = level_changes(base, 1 / finer, std::ldexp(1.0, -j));
      const Case changed = with_changes(input, run.changes);
      run.resolved = to_toml(changed);
      run.elements = elements * finer * finer;
      run.cost = run.elements * finer * std::ldexp(1.0, j);
      run.end_time = changed.run.end_time;
      runs.push_back(std::move(run));
    }
  }
  return runs;
}

Variation read_variation(const std::string& text) {
  const std::size_t equals = text.find('=');
  const char* const cure = "write --vary obstacles.stop.friction=0,0.1,0.2 or =0:0.5:0.1";
  if (equals == std::string::npos || equals == 0) refuse(fmt::format("`{}` does not say what to vary", text), cure);
  Variation v{.path = text.substr(0, equals), .values = {}};
  for (const std::string& value : split_values(text.substr(equals + 1))) {
    if (value.empty()) refuse(fmt::format("`{}` has an empty value", text), cure);
    const std::vector<std::string> range = values_of_range(value);
    if (range.empty()) {
      if (looks_like_range(value)) refuse(fmt::format("`{}` is no range", value), range_form);
      v.values.push_back(value);
    } else {
      v.values.insert(v.values.end(), range.begin(), range.end());
    }
  }
  std::vector<std::string> sorted = v.values;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end()) refuse(fmt::format("`{}` has the value {} twice", text, *twice), "leave one out");
  return v;
}

std::vector<PlannedRun> plan_sweep(const StudyInput& input, const std::vector<Variation>& variations) {
  refuse_overlaps(variations);
  std::size_t count = 1;
  for (const Variation& v : variations) {
    count *= v.values.size();
    if (count > most_runs) refuse(fmt::format("more than {} runs", most_runs), "vary less at once");
  }
  std::vector<PlannedRun> runs;
  for (std::size_t k = 0; k < count; ++k) {
    PlannedRun run{.name = fmt::format("run-{:0{}}", k + 1, std::to_string(count).size())};
    std::size_t rest = k;
    std::size_t block = count;
    for (const Variation& v : variations) {
      block /= v.values.size();
      run.texts.push_back(v.values[rest / block]);
      run.changes.push_back(v.path + "=" + run.texts.back());
      rest %= block;
    }
    const Case changed = with_changes(input, run.changes);
    run.resolved = to_toml(changed);
    run.elements = count_elements(changed);
    run.cost = run.elements * std::sqrt(run.elements);
    run.end_time = changed.run.end_time;
    runs.push_back(std::move(run));
  }
  return runs;
}

std::vector<double> element_sizes(const StudyInput& input, const ConvergenceLevels& levels) {
  const Case base = with_changes(input, {});
  const auto deformable =
      std::find_if(base.bodies.begin(), base.bodies.end(), [](const BodyCase& b) { return !b.rigid; });
  const BodyCase& body = deformable == base.bodies.end() ? base.bodies.front() : *deformable;
  const double size = std::visit([](const auto& mesh) { return mesh.element_size; }, body.mesh);
  std::vector<double> sizes;
  for (int i = 0; i < levels.meshes; ++i) sizes.push_back(size / std::pow(levels.ratio, i));
  return sizes;
}

}  // namespace udar

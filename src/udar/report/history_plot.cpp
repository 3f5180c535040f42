#include "udar/report/history_plot.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"
#include "udar/results/histories.hpp"
#include "udar/results/run_files.hpp"
#include "udar/results/run_folder.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

/// The histories of one run, read when they are asked for.
class RunHistories {
 public:
  explicit RunHistories(const fs::path& folder) : files_(find_run_files(folder)) {
    for (const fs::path& file : files_.histories) names_.push_back(file.stem().string());
    std::sort(names_.begin(), names_.end());
    if (names_.empty()) {
      throw UserError(ExitCode::usage, fmt::format("the run `{}` has no histories", folder.string()),
                      "run the case again");
    }
  }

  [[nodiscard]] const RunFiles& files() const { return files_; }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] bool has(const std::string& name) const {
    return std::binary_search(names_.begin(), names_.end(), name);
  }
  const History& read(const std::string& name) {
    const auto known = read_.find(name);
    if (known != read_.end()) return known->second;
    return read_.emplace(name, read_csv(files_.folder / RunFolder::histories / (name + ".csv"))).first->second;
  }

 private:
  RunFiles files_;
  std::vector<std::string> names_;
  std::map<std::string, History> read_;
};

/// One quantity, in any run.
struct Quantity {
  std::string history;
  std::string column;
  std::string unit;

  [[nodiscard]] std::string name() const { return history + "." + column; }
};

/// Quantities that share a panel.
struct Group {
  std::string caption;
  std::string unit;
  std::vector<Quantity> quantities;
};

bool has_column(const History& history, std::string_view name) {
  return std::any_of(history.columns.begin(), history.columns.end(), [&](const Column& c) { return c.name == name; });
}

std::vector<Quantity> columns_of(const std::string& name, const History& history, std::string_view wanted) {
  std::vector<Quantity> found;
  const bool exact = has_column(history, wanted);
  for (std::size_t c = 1; c < history.columns.size(); ++c) {
    const Column& column = history.columns[c];
    const bool of_vector = column.name == std::string(wanted) + "_x" || column.name == std::string(wanted) + "_y";
    if (wanted.empty() || column.name == wanted || (!exact && of_vector)) {
      found.push_back({name, column.name, column.unit});
    }
  }
  return found;
}

[[noreturn]] void refuse_column(const std::string& history, const History& of, std::string_view wanted) {
  std::vector<std::string> names;
  for (std::size_t c = 1; c < of.columns.size(); ++c) names.push_back(of.columns[c].name);
  const std::string near = nearest_word(wanted, names);
  throw UserError(ExitCode::usage, fmt::format("`{}` has no column `{}`", history, wanted),
                  near.empty() ? "write " + one_of(names) : fmt::format("did you mean `{}.{}`?", history, near));
}

/// What a word of the user names in a run: a history may have dots in its own name, so the longest one counts.
std::vector<Quantity> find_quantities(RunHistories& run, const std::string& word) {
  std::string history;
  for (const std::string& name : run.names()) {
    const bool fits = word == name || word.starts_with(name + ".");
    if (fits && name.size() > history.size()) history = name;
  }
  if (history.empty()) {
    const std::string head = word.substr(0, word.find('.'));
    const std::string near = nearest_word(head, run.names());
    std::vector<std::string> names = run.names();
    if (names.size() > 12) names.resize(12);
    throw UserError(
        ExitCode::usage, fmt::format("the run `{}` has no history `{}`", run.files().folder.string(), head),
        near.empty() ? "write " + one_of(names) : fmt::format("did you mean `{}{}`?", near, word.substr(head.size())));
  }
  const std::string column = word.size() > history.size() ? word.substr(history.size() + 1) : "";
  const History& read = run.read(history);
  std::vector<Quantity> found = columns_of(history, read, column);
  if (found.empty()) refuse_column(history, read, column);
  return found;
}

/// What the numbers of a panel are.
std::string caption_of(const std::vector<Quantity>& quantities) {
  const auto stem = [](const std::string& column) {
    const bool component = column.ends_with("_x") || column.ends_with("_y");
    std::string text = component ? column.substr(0, column.size() - 2) : column;
    std::replace(text.begin(), text.end(), '_', ' ');
    return text;
  };
  std::set<std::string> stems;
  for (const Quantity& q : quantities) stems.insert(stem(q.column));
  if (stems.size() == 1) return *stems.begin();
  static const std::map<std::string, std::string> common{
      {"m", "length"}, {"m/s", "velocity"}, {"m/s^2", "acceleration"}, {"Pa", "stress"},
      {"N", "force"},  {"J", "energy"},     {"N s", "impulse"},        {"N m", "moment"}};
  const auto known = common.find(quantities.front().unit);
  return known == common.end() ? "" : known->second;
}

std::vector<Group> grouped(const std::vector<Quantity>& quantities) {
  std::vector<Group> groups;
  std::vector<std::string> keys;
  for (const Quantity& q : quantities) {
    // Plain numbers of different kinds have nothing in common.
    const std::string key = q.unit.empty() ? "=" + q.column : q.unit;
    const auto at = std::find(keys.begin(), keys.end(), key);
    if (at == keys.end()) {
      keys.push_back(key);
      groups.push_back({"", q.unit, {q}});
    } else {
      groups[static_cast<std::size_t>(at - keys.begin())].quantities.push_back(q);
    }
  }
  for (Group& group : groups) group.caption = caption_of(group.quantities);
  return groups;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values) {
    if (std::isfinite(v)) most = std::max(most, std::fabs(v));
  }
  return most;
}

/// Leaves out what stays near zero beside the others, and of many the smaller ones.
void keep_what_matters(RunHistories& run, Group& group) {
  constexpr double hardly = 1e-3;
  constexpr std::size_t most_curves = 6;
  const auto size = [&](const Quantity& q) { return largest(run.read(q.history).at(q.column)); };
  double top = 0;
  for (const Quantity& q : group.quantities) top = std::max(top, size(q));
  std::erase_if(group.quantities, [&](const Quantity& q) { return !(size(q) > hardly * top); });
  if (group.quantities.size() <= most_curves) return;
  std::vector<double> sizes;
  for (const Quantity& q : group.quantities) sizes.push_back(size(q));
  std::nth_element(sizes.begin(), sizes.begin() + most_curves - 1, sizes.end(), std::greater<>());
  std::erase_if(group.quantities, [&](const Quantity& q) { return size(q) < sizes[most_curves - 1]; });
  group.quantities.resize(std::min(group.quantities.size(), most_curves));
}

/// What is looked at first: velocities of bodies, forces, energy, places of observed nodes.
std::vector<Group> usual_sheet(RunHistories& run) {
  std::vector<Group> sheet{{"velocity of centre of mass", "m/s", {}},
                           {"contact force", "N", {}},
                           {"energy", "J", {}},
                           {"displacement", "m", {}}};
  const auto add = [&](Group& group, const std::string& name, std::string_view column) {
    const auto found = columns_of(name, run.read(name), column);
    group.quantities.insert(group.quantities.end(), found.begin(), found.end());
  };
  for (const std::string& name : run.names()) {
    const History& history = run.read(name);
    if (has_column(history, "kinetic")) {
      for (const char* term : {"kinetic", "elastic", "plastic", "contact", "ties", "friction", "damping", "total"}) {
        if (has_column(history, term)) add(sheet[2], name, term);
      }
    } else if (has_column(history, "displacement_x")) {
      add(sheet[3], name, "displacement");
    } else if (has_column(history, "touching_nodes")) {
      add(sheet[1], name, "force");
    } else if (has_column(history, "position_x")) {
      add(sheet[0], name, "velocity");
    }
  }
  for (Group& group : sheet) keep_what_matters(run, group);
  std::erase_if(sheet, [](const Group& group) { return group.quantities.empty(); });
  return sheet;
}

/// The rows between two times, both included.
PlotCurve cut_out(const History& history, const std::string& column, double from, double to) {
  PlotCurve curve;
  const std::vector<double>& times = history.values.front();
  const std::vector<double>& values = history.at(column);
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times[i] < from || times[i] > to) continue;
    curve.times.push_back(times[i]);
    curve.values.push_back(values[i]);
  }
  return curve;
}

PlotPanel panel_of(std::vector<RunHistories>& runs, const std::vector<std::string>& labels, const Group& group,
                   const PlotRequest& request) {
  PlotPanel panel{.caption = group.caption, .unit = group.unit, .curves = {}};
  for (std::size_t q = 0; q < group.quantities.size(); ++q) {
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const Quantity& quantity = group.quantities[q];
      if (!runs[r].has(quantity.history) || !has_column(runs[r].read(quantity.history), quantity.column)) continue;
      PlotCurve curve = cut_out(runs[r].read(quantity.history), quantity.column, request.from, request.to);
      curve.name = runs.size() > 1 ? labels[r] + ": " + quantity.name() : quantity.name();
      // One quantity of several runs: a colour for each run. Several: a kind of line for each run.
      const bool by_run = group.quantities.size() == 1;
      curve.colour = by_run ? r : q;
      curve.dash = by_run ? 0 : r;
      panel.curves.push_back(std::move(curve));
    }
  }
  return panel;
}

/// Sets the time axis to the rows there are, within what was asked for.
void set_times(Plot& plot, const PlotRequest& request) {
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  for (const PlotPanel& panel : plot.panels) {
    for (const PlotCurve& curve : panel.curves) {
      if (curve.times.empty()) continue;
      first = std::min(first, curve.times.front());
      last = std::max(last, curve.times.back());
    }
  }
  if (!(first < last)) {
    throw UserError(ExitCode::usage, "there are less than two rows in this time", "widen --from and --to");
  }
  plot.from = request.from > 0 ? request.from : first;
  plot.to = std::isfinite(request.to) ? request.to : last;
}

/// Names that tell the runs apart: of folders, or where these are the same, as they were given.
std::vector<std::string> run_labels(const std::vector<fs::path>& runs) {
  std::vector<std::string> labels;
  for (const fs::path& run : runs) labels.push_back(folder_name(run));
  if (std::set<std::string>(labels.begin(), labels.end()).size() == labels.size()) return labels;
  labels.clear();
  for (const fs::path& run : runs) labels.push_back(run.string());
  return labels;
}

}  // namespace

Plot history_plot(const PlotRequest& request) {
  std::vector<RunHistories> runs;
  for (const fs::path& folder : request.runs) runs.emplace_back(folder);
  std::vector<Quantity> quantities;
  for (const std::string& name : request.names) {
    for (const Quantity& q : find_quantities(runs.front(), name)) quantities.push_back(q);
    for (std::size_t r = 1; r < runs.size(); ++r) find_quantities(runs[r], name);  // refuses what is missing there
  }
  const std::vector<Group> groups = request.names.empty() ? usual_sheet(runs.front()) : grouped(quantities);
  const std::vector<std::string> labels = run_labels(request.runs);
  Plot plot{.title = request.title.empty() ? case_name_of(runs.front().files()) : request.title};
  for (const Group& group : groups) plot.panels.push_back(panel_of(runs, labels, group, request));
  set_times(plot, request);
  return plot;
}

}  // namespace udar

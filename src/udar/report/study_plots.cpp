#include "udar/report/study_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "udar/base/error.hpp"
#include "udar/base/human_unit.hpp"
#include "udar/report/plot.hpp"
#include "udar/report/study_runs.hpp"
#include "udar/results/file.hpp"
#include "udar/results/histories.hpp"
#include "udar/results/run_files.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/results/study.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_history_plots = 400;
constexpr std::size_t most_curves = 8;
constexpr std::size_t most_numbers = 40;

/// A run whose histories are plotted.
struct Level {
  std::string label;
  fs::path folder;
};

std::string readable(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// The largest size of a column over all levels.
double largest(const std::vector<History>& histories, const std::string& column) {
  double most = 0;
  for (const History& history : histories) {
    for (std::size_t c = 1; c < history.columns.size(); ++c) {
      if (history.columns[c].name != column) continue;
      for (const double v : history.values[c]) {
        if (std::isfinite(v)) most = std::max(most, std::fabs(v));
      }
    }
  }
  return most;
}

/// Is a column 0 to rounding beside those of its unit?
bool is_nothing(const std::vector<History>& histories, const History& of, const Column& column) {
  double most = 0;
  for (const Column& other : of.columns) {
    if (other.unit == column.unit && &other != &of.columns.front()) {
      most = std::max(most, largest(histories, other.name));
    }
  }
  return !(largest(histories, column.name) > 1e-12 * most);
}

class StudyPlots {
 public:
  StudyPlots(const fs::path& folder, const StudyPlotOptions& options)
      : folder_(folder), options_(options), study_(read_study(folder)) {}

  std::vector<fs::path> write() {
    std::error_code error;
    refuse_link(folder_ / StudyFolder::plots);
    fs::create_directories(folder_ / StudyFolder::plots, error);
    if (error) {
      throw OutputError(fmt::format("cannot make {}: {}", (folder_ / StudyFolder::plots).string(), error.message()));
    }
    remove_old();
    if (study_.kind == "converge") {
      convergence();
      histories(levels(mesh_levels(study_), false), "", "each mesh");
      const std::vector<std::size_t> steps = step_levels(study_);
      if (steps.size() > 1) histories(levels(steps, true), "-steps", "each time step of the finest mesh");
    } else {
      numbers();
      constexpr std::size_t most_runs = 6;
      histories(levels(shown_runs(study_, most_runs), false), "", "runs of the sweep");
    }
    return paths_;
  }

 private:
  [[nodiscard]] bool is_stopped() const { return options_.interrupted && options_.interrupted(); }

  /// What an earlier study left there would be taken for this one's.
  void remove_old() const {
    std::error_code error;
    std::vector<fs::path> old;
    for (fs::directory_iterator it(folder_ / StudyFolder::plots, error), end; !error && it != end;
         it.increment(error)) {
      if (it->path().extension() == ".svg" && fs::is_regular_file(it->symlink_status(error))) old.push_back(it->path());
    }
    for (const fs::path& file : old) fs::remove(file, error);
  }

  void put(const std::string& name, const Plot& plot) {
    fs::path path = folder_ / StudyFolder::plots / (safe_name(name) + ".svg");
    write_file(path, to_svg(plot));
    paths_.push_back(std::move(path));
  }

  /// The finest ones, as many as colours part.
  [[nodiscard]] std::vector<Level> levels(const std::vector<std::size_t>& runs, bool of_steps) const {
    std::vector<Level> out;
    for (const std::size_t r : runs) {
      const StudyRun& run = study_.runs[r];
      const fs::path folder = study_run_folder(folder_, run);
      if (folder.empty() || !is_run_folder(folder)) continue;
      const double step = std::isfinite(run.longest_step) ? run.longest_step : run.shortest_step;
      const bool by_step = of_steps && std::isfinite(step);
      out.push_back({by_step ? "step " + human_text(step, "s") : level_label(study_, run), folder});
    }
    if (out.size() > most_curves) out.erase(out.begin(), out.end() - static_cast<std::ptrdiff_t>(most_curves));
    return out;
  }

  void histories(const std::vector<Level>& levels, const std::string& ending, const std::string& subtitle) {
    if (levels.empty()) return;
    std::size_t plots = 0;
    // The finest run says in which order they are looked at.
    for (const fs::path& file : find_run_files(levels.back().folder).histories) {
      const std::string name = file.stem().string();
      std::vector<History> read;
      for (const Level& level : levels) {
        try {
          read.push_back(read_csv(level.folder / RunFolder::histories / file.filename()));
        } catch (const OutputError&) {
          read.emplace_back();  // this run has no such history: no curve
        }
      }
      const History& finest = read.back();
      for (std::size_t c = 1; c < finest.columns.size(); ++c) {
        if (plots >= most_history_plots || is_stopped()) return;
        const Column& column = finest.columns[c];
        if (!is_worth_it(read, finest, name, column)) continue;
        const Plot plot = overlay(name, column, levels, read, subtitle);
        if (!(plot.from < plot.to)) continue;
        put(fmt::format("{}.{}{}", name, column.name, ending), plot);
        ++plots;
      }
    }
  }

  /// A convergence study names the columns that are more than rounding.
  [[nodiscard]] bool is_worth_it(const std::vector<History>& read, const History& finest, const std::string& history,
                                 const Column& column) const {
    if (study_.kind != "converge") return !is_nothing(read, finest, column);
    const std::string name = fmt::format("{}.{}", history, column.name);
    return std::any_of(study_.histories.begin(), study_.histories.end(),
                       [&](const StudyDifference& d) { return d.name == name; });
  }

  [[nodiscard]] Plot overlay(const std::string& name, const Column& column, const std::vector<Level>& levels,
                             const std::vector<History>& read, const std::string& subtitle) const {
    PlotPanel panel{.caption = readable(column.name), .unit = column.unit, .curves = {}};
    double from = std::numeric_limits<double>::infinity();
    double to = -from;
    for (std::size_t l = 0; l < levels.size(); ++l) {
      const std::vector<Column>& columns = read[l].columns;
      const auto at = std::find(columns.begin(), columns.end(), column);
      if (at == columns.end() || read[l].values.front().empty()) continue;
      const std::vector<double>& times = read[l].values.front();
      from = std::min(from, times.front());
      to = std::max(to, times.back());
      panel.curves.push_back({.name = levels[l].label,
                              .times = times,
                              .values = read[l].values[static_cast<std::size_t>(at - columns.begin())],
                              .colour = l});
    }
    return {.title = fmt::format("{}: {}.{}", study_.case_name, name, column.name),
            .subtitle = subtitle,
            .panels = {std::move(panel)},
            .from = from,
            .to = to};
  }

  [[nodiscard]] std::vector<const StudyQuantity*> chosen() const {
    std::vector<const StudyQuantity*> out;
    for (const StudyQuantity& q : study_.quantities) {
      const bool named =
          std::find(options_.quantities.begin(), options_.quantities.end(), q.name) != options_.quantities.end();
      if (options_.quantities.empty() ? q.headline : named) out.push_back(&q);
    }
    if (out.empty() && options_.quantities.empty()) {
      for (const StudyQuantity& q : study_.quantities) out.push_back(&q);
    }
    // Those whose limit is known tell most.
    std::stable_partition(out.begin(), out.end(), [](const auto* q) { return std::isfinite(q->mesh.extrapolated); });
    if (out.size() > most_numbers) out.resize(most_numbers);
    return out;
  }

  /// Relative difference from the extrapolated value, or from the finest one, %, over the element size.
  [[nodiscard]] PlotCurve errors_of(const StudyQuantity& quantity, const std::vector<std::size_t>& levels) const {
    PlotCurve curve{.name = quantity.name, .times = {}, .values = {}, .markers = true};
    const bool known = std::isfinite(quantity.mesh.extrapolated);
    const auto value = [&](std::size_t r) {
      return r < quantity.values.size() ? quantity.values[r] : std::numeric_limits<double>::quiet_NaN();
    };
    const double best = known ? quantity.mesh.extrapolated : value(levels.back());
    double size_of_it = std::fabs(best);  // of a number that goes to 0 its largest value
    for (const std::size_t r : levels) size_of_it = std::fmax(size_of_it, std::fabs(value(r)));
    constexpr double rounding = 1e-10;  // %
    curve.name += known ? " (from the extrapolated value)" : " (from the finest value)";
    for (const std::size_t r : std::vector(levels.rbegin(), levels.rend())) {  // the finest first: sizes rise
      const auto mesh = static_cast<std::size_t>(study_.runs[r].mesh);
      const double size = mesh < study_.element_sizes.size() ? study_.element_sizes[mesh] : 0;
      const double error = 100 * std::fabs(value(r) - best) / size_of_it;
      if (!(size > 0) || !std::isfinite(error) || !(error > rounding)) continue;
      curve.times.push_back(size);
      curve.values.push_back(error);
    }
    return curve;
  }

  void convergence() {
    const std::vector<std::size_t> meshes = mesh_levels(study_);
    PlotPanel panel{.caption = "relative difference", .unit = "%", .curves = {}, .logarithmic = true};
    double from = std::numeric_limits<double>::infinity();
    double to = 0;
    double top = 0;  // of the coarsest values, %
    for (const StudyQuantity* quantity : meshes.empty() ? std::vector<const StudyQuantity*>{} : chosen()) {
      if (panel.curves.size() >= most_curves) break;
      PlotCurve curve = errors_of(*quantity, meshes);
      if (curve.times.size() < 2) continue;
      curve.colour = panel.curves.size();
      from = std::min(from, curve.times.front());
      to = std::max(to, curve.times.back());
      top = std::max(top, *std::max_element(curve.values.begin(), curve.values.end()));
      panel.curves.push_back(std::move(curve));
    }
    if (!(from < to)) return;
    // What first and second order would look like, from the worst value down.
    for (const int order : {1, 2}) {
      panel.curves.push_back({.name = order == 1 ? "slope of first order" : "slope of second order",
                              .times = {from, to},
                              .values = {top * std::pow(from / to, order), top},
                              .colour = 4,
                              .dash = static_cast<std::size_t>(order)});
    }
    std::vector<double> sizes;
    for (const std::size_t r : std::vector(meshes.rbegin(), meshes.rend())) {
      const auto mesh = static_cast<std::size_t>(study_.runs[r].mesh);
      if (mesh < study_.element_sizes.size()) sizes.push_back(study_.element_sizes[mesh]);
    }
    std::erase_if(sizes, [&](double size) { return size < from || size > to; });
    constexpr double margin = 1.12;
    put("convergence", {.title = study_.case_name + ": convergence",
                        .subtitle = "headline quantities; each mesh with its finest time step",
                        .panels = {std::move(panel)},
                        .from = from / margin,
                        .to = to * margin,
                        .axis = {.label = "element size", .unit = "m", .logarithmic = true, .places = sizes},
                        .extremes = false});
  }

  /// A number of a sweep over the first thing that was varied; of the others each choice has its curve.
  void numbers() {
    const std::vector<std::size_t> runs = done_runs(study_);
    const auto is_number = [&](std::size_t r) {
      return !study_.runs[r].values.empty() && std::isfinite(study_.runs[r].values.front());
    };
    const bool by_number = std::all_of(runs.begin(), runs.end(), is_number);
    for (const StudyQuantity* quantity : chosen()) {
      if (is_stopped()) return;
      Plot plot = number(*quantity, runs, by_number);
      const bool any = std::any_of(plot.panels[0].curves.begin(), plot.panels[0].curves.end(),
                                   [](const PlotCurve& c) { return extremes_of(c).any; });
      if (any) put("number-" + quantity->name, plot);
    }
  }

  [[nodiscard]] Plot number(const StudyQuantity& quantity, const std::vector<std::size_t>& runs, bool by_number) const {
    Plot plot{.title = study_.case_name + ": " + quantity.name, .extremes = false};
    plot.axis = {.label = study_.varied.empty() ? "run" : study_.varied.front(), .unit = ""};
    const bool has_unit =
        by_number && !runs.empty() && study_.runs[runs.front()].texts.front().find(' ') != std::string::npos;
    if (has_unit) plot.axis.label += " [SI units]";
    std::map<std::string, std::vector<std::array<double, 2>>> points;
    std::vector<std::string>& names = plot.axis.names;
    for (const std::size_t r : runs) {
      const StudyRun& run = study_.runs[r];
      const std::string text = run.texts.empty() ? run.name : run.texts.front();
      double x = by_number ? run.values.front() : 0;
      if (!by_number) {
        const auto at = std::find(names.begin(), names.end(), text);
        x = static_cast<double>(at - names.begin());
        if (at == names.end()) names.push_back(text);
      }
      std::string others;
      for (std::size_t v = 1; v < run.texts.size(); ++v) {
        others +=
            (others.empty() ? "" : ", ") + (v < study_.varied.size() ? study_.varied[v] + " = " : "") + run.texts[v];
      }
      if (r < quantity.values.size()) points[others].push_back({x, quantity.values[r]});
    }
    PlotPanel panel{
        .caption = readable(quantity.name.substr(quantity.name.rfind('.') + 1)), .unit = quantity.unit, .curves = {}};
    double from = std::numeric_limits<double>::infinity();
    double to = -from;
    for (auto& [name, of] : points) {
      std::sort(of.begin(), of.end());
      PlotCurve curve{.name = name.empty() ? quantity.name : name,
                      .times = {},
                      .values = {},
                      .colour = panel.curves.size(),
                      .dash = panel.curves.size() / most_curves,
                      .markers = true};
      for (const auto& [x, y] : of) {
        from = std::min(from, x);
        to = std::max(to, x);
        curve.times.push_back(x);
        curve.values.push_back(y);
      }
      panel.curves.push_back(std::move(curve));
    }
    for (std::size_t n = 0; n < names.size(); ++n) plot.axis.places.push_back(static_cast<double>(n));
    const double margin = to > from ? 0.04 * (to - from) : 1;
    plot.from = from - margin;
    plot.to = to + margin;
    plot.panels.push_back(std::move(panel));
    return plot;
  }

  fs::path folder_;
  const StudyPlotOptions& options_;
  Study study_;
  std::vector<fs::path> paths_;
};

}  // namespace

std::vector<fs::path> write_study_plots(const fs::path& study, const StudyPlotOptions& options) {
  return StudyPlots(study, options).write();
}

}  // namespace udar

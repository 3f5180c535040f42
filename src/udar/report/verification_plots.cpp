#include "udar/report/verification_plots.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "udar/report/plot.hpp"

namespace udar {
namespace {

constexpr std::size_t most_panels = 3;
constexpr std::size_t most_places = 9;
constexpr std::size_t ink = 4;  // colour of what is exact

/// Errors that have an order can be drawn on logarithmic axes.
bool is_drawn(const ErrorSeries& series) {
  return series.sizes.size() >= 2 && series.sizes.size() == series.errors.size() && std::isfinite(series.order);
}

bool same_axis(const ErrorSeries& a, const ErrorSeries& b) { return a.size == b.size && a.size_unit == b.size_unit; }

/// The sizes of all, rising, each once.
std::vector<double> sizes_of(const std::vector<const ErrorSeries*>& all) {
  std::vector<double> sizes;
  for (const ErrorSeries* series : all) sizes.insert(sizes.end(), series->sizes.begin(), series->sizes.end());
  std::sort(sizes.begin(), sizes.end());
  sizes.erase(std::unique(sizes.begin(), sizes.end(), [](double a, double b) { return b < a * (1 + 1e-9); }),
              sizes.end());
  return sizes;
}

PlotCurve rising(PlotCurve curve) {
  if (curve.times.size() > 1 && curve.times.front() > curve.times.back()) {
    std::reverse(curve.times.begin(), curve.times.end());
    std::reverse(curve.values.begin(), curve.values.end());
  }
  return curve;
}

/// A straight line with the order measured, through the middle of the errors.
PlotCurve slope_of(const ErrorSeries& series) {
  double middle = 0;
  for (std::size_t i = 0; i < series.sizes.size(); ++i) {
    middle += std::log(series.errors[i]) - series.order * std::log(series.sizes[i]);
  }
  middle /= static_cast<double>(series.sizes.size());
  PlotCurve line{
      .name = fmt::format("order {:.2f}", series.order), .times = {}, .values = {}, .colour = ink, .dash = 2};
  if (std::isfinite(series.expected)) line.name += fmt::format(", {:.2f} expected", series.expected);
  for (const double size : series.sizes) {
    line.times.push_back(size);
    line.values.push_back(std::exp(middle + series.order * std::log(size)));
  }
  return rising(line);
}

PlotPanel panel_of(const ErrorSeries& series) {
  PlotPanel panel{.caption = "error", .unit = "", .curves = {}, .logarithmic = true};
  panel.curves.push_back(
      rising({.name = series.what, .times = series.sizes, .values = series.errors, .colour = 0, .markers = true}));
  if (!series.bounds.empty()) {
    panel.curves.push_back(
        rising({.name = "bound", .times = series.sizes, .values = series.bounds, .colour = 1, .dash = 1}));
  }
  panel.curves.push_back(slope_of(series));
  return panel;
}

VerificationPlot plot_of(const std::vector<const ErrorSeries*>& all) {
  Plot plot{.title = fmt::format("Errors over the {}", all.front()->size), .subtitle = "", .panels = {}};
  plot.extremes = false;
  const std::vector<double> sizes = sizes_of(all);
  const double margin = std::pow(sizes.back() / sizes.front(), 0.04);
  plot.from = sizes.front() / margin;
  plot.to = sizes.back() * margin;
  plot.axis = {.label = all.front()->size, .unit = all.front()->size_unit, .logarithmic = true};
  if (sizes.size() <= most_places) plot.axis.places = sizes;
  std::string names;
  for (const ErrorSeries* series : all) {
    plot.panels.push_back(panel_of(*series));
    names += (names.empty() ? "" : "; ") + series->what;
  }
  return {fmt::format("{}: {}", plot.title, names), to_svg(plot)};
}

VerificationPlot plot_of(const CheckCurve& curve) {
  Plot plot{
      .title = curve.title, .subtitle = "", .panels = {{.caption = curve.y_label, .unit = curve.y_unit, .curves = {}}}};
  plot.extremes = false;
  plot.axis = {.label = curve.x_label, .unit = curve.x_unit};
  bool any = false;
  std::size_t colour = 0;
  for (const CheckLine& line : curve.lines) {
    PlotCurve drawn{.name = line.name, .times = line.x, .values = line.y};
    const bool few = line.x.size() <= 30;
    drawn.markers = !line.exact && few;
    if (line.exact) {
      drawn.colour = ink;
      drawn.dash = 1;
    } else {
      drawn.colour = colour == ink ? ++colour : colour;
      ++colour;
    }
    for (const double x : line.x) {
      plot.from = any ? std::min(plot.from, x) : x;
      plot.to = any ? std::max(plot.to, x) : x;
      any = true;
    }
    plot.panels[0].curves.push_back(std::move(drawn));
  }
  if (!(plot.to > plot.from)) plot.to = plot.from + 1;
  return {curve.title, to_svg(plot)};
}

}  // namespace

std::vector<VerificationPlot> verification_plots(const VerifiedPart& part) {
  std::vector<VerificationPlot> plots;
  std::vector<const ErrorSeries*> together;
  const auto flush = [&] {
    if (!together.empty()) plots.push_back(plot_of(together));
    together.clear();
  };
  for (const ErrorSeries& series : part.series) {
    if (!is_drawn(series)) continue;
    if (together.size() == most_panels || (!together.empty() && !same_axis(*together.front(), series))) flush();
    together.push_back(&series);
  }
  flush();
  for (const CheckCurve& curve : part.curves) plots.push_back(plot_of(curve));
  return plots;
}

}  // namespace udar

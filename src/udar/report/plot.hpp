#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace udar {

/// One quantity over time, or over what the plot has instead.
struct PlotCurve {
  std::string name;
  std::vector<double> times;   ///< s, rising; or the SI unit of the axis
  std::vector<double> values;  ///< SI, as many
  std::size_t colour = 0;
  std::size_t dash = 0;          ///< which kind of line
  bool markers = false;          ///< a dot for each value
  std::vector<double> errors{};  ///< half the length of an error bar for each value, SI; NaN: none; empty: none at all
};

/// What the panels have in common below them.
struct PlotAxis {
  std::string label = "time";
  std::string unit = "s";  ///< SI
  bool logarithmic = false;
  std::vector<double> places{};      ///< of the ticks, SI, rising; empty: round numbers
  std::vector<std::string> names{};  ///< of these places; empty: their numbers
};

/// Curves that share a vertical axis.
struct PlotPanel {
  std::string caption;
  std::string unit;  ///< SI; "" for plain numbers
  std::vector<PlotCurve> curves;
  bool logarithmic = false;  ///< values that are not positive are passed over
};

/// Panels one below the other with a common axis, that of time unless it says otherwise.
struct Plot {
  std::string title;
  std::string subtitle;
  std::vector<PlotPanel> panels;
  double from = 0;  ///< s, or the SI unit of `axis`
  double to = 1;
  PlotAxis axis{};
  bool extremes = true;  ///< tells and marks largest, smallest and last values; else only names
};

/// The plot as an SVG file, 1000 px wide. Above each panel a table names the curves with their largest, smallest and
/// last values; dots show where they are. A long history is drawn by its extremes in each half px.
std::string to_svg(const Plot& plot);

/// Where a curve is largest and smallest; values that are no numbers are passed over.
struct CurveExtremes {
  bool any = false;
  std::size_t least = 0;
  std::size_t most = 0;
  std::size_t last = 0;
};
CurveExtremes extremes_of(const PlotCurve& curve);

}  // namespace udar

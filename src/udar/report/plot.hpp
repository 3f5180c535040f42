#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace udar {

/// One quantity over time.
struct PlotCurve {
  std::string name;
  std::vector<double> times;   ///< s, rising
  std::vector<double> values;  ///< SI, as many
  std::size_t colour = 0;
  std::size_t dash = 0;  ///< which kind of line
};

/// Curves that share a vertical axis.
struct PlotPanel {
  std::string caption;
  std::string unit;  ///< SI; "" for plain numbers
  std::vector<PlotCurve> curves;
};

/// Panels one below the other with a common time axis.
struct Plot {
  std::string title;
  std::string subtitle;
  std::vector<PlotPanel> panels;
  double from = 0;  ///< s
  double to = 1;    ///< s
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

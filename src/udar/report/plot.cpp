#include "udar/report/plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "udar/base/human_unit.hpp"
#include "udar/report/ticks.hpp"
#include "udar/results/picture_page.hpp"
#include "udar/results/svg.hpp"

namespace udar {
namespace {

constexpr double width = 1000;
constexpr double left = 92;  // of the axes
constexpr double right = width - 28;
constexpr double row_height = 20;
constexpr double largest_column = left + 0.44 * (right - left);
constexpr double smallest_column = left + 0.66 * (right - left);
constexpr double last_column = left + 0.88 * (right - left);

// Told apart by eyes that do not see all colours (Okabe and Ito 2008), the light ones last.
constexpr std::array<std::string_view, 8> colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                  "#1d2733", "#e69f00", "#56b4e9", "#8c6d31"};
constexpr std::array<std::string_view, 4> dashes{"", "8 4", "2 3", "10 3 2 3"};

std::string_view colour_of(const PlotCurve& curve) { return colours[curve.colour % colours.size()]; }
std::string dash_of(const PlotCurve& curve) {
  const std::string_view dash = dashes[curve.dash % dashes.size()];
  return dash.empty() ? "" : fmt::format(R"( stroke-dasharray="{}")", dash);
}

/// Numbers along one side of a panel.
struct Scale {
  HumanUnit unit;
  Ticks ticks;
  double low = 0;  // in that unit
  double high = 1;
  bool logarithmic = false;

  /// Where a value stands, 0 at the low end, 1 at the high one.
  [[nodiscard]] double part(double si) const {
    const double value = si / unit.size;
    if (logarithmic) return value > 0 ? std::log(value / low) / std::log(high / low) : std::nan("");
    return (value - low) / (high - low);
  }
};

/// Axes of one panel: numbers to px.
struct Axes {
  double top = 0;     // px
  double bottom = 0;  // px
  Scale across;
  Scale up;

  [[nodiscard]] double x(double si) const { return left + across.part(si) * (right - left); }
  [[nodiscard]] double y(double si) const { return bottom - up.part(si) * (bottom - top); }
};

/// A value with as many decimals as give `largest` four digits, and a true minus sign.
std::string number(double value, double largest) {
  const int digits = largest > 0 ? std::clamp(3 - static_cast<int>(std::floor(std::log10(largest))), 0, 9) : 0;
  const std::string text = fmt::format("{:.{}f}", std::fabs(value), digits);
  const bool zero = text.find_first_not_of("0.") == std::string::npos;
  return zero ? "0" : value < 0 ? "−" + text : text;
}

/// Least and largest of what a panel shows, with error bars; only positive numbers where the axis is logarithmic.
std::array<double, 2> range_of(const PlotPanel& panel) {
  double low = 0;
  double high = 0;
  bool any = false;
  const auto take = [&](double value) {
    if (!std::isfinite(value) || (panel.logarithmic && value <= 0)) return;
    low = any ? std::min(low, value) : value;
    high = any ? std::max(high, value) : value;
    any = true;
  };
  for (const PlotCurve& curve : panel.curves) {
    for (std::size_t i = 0; i < curve.values.size(); ++i) {
      take(curve.values[i]);
      if (i >= curve.errors.size()) continue;
      take(curve.values[i] - curve.errors[i]);
      take(curve.values[i] + curve.errors[i]);
    }
  }
  if (!any && panel.logarithmic) return {1, 10};
  return {low, high};
}

Scale scale_across(const Plot& plot) {
  Scale scale;
  scale.logarithmic = plot.axis.logarithmic;
  scale.unit = human_unit(plot.axis.unit, std::max(std::fabs(plot.from), std::fabs(plot.to)));
  scale.low = plot.from / scale.unit.size;
  scale.high = plot.to / scale.unit.size;
  if (!plot.axis.places.empty()) {
    scale.ticks.logarithmic = true;  // each number as it is
    for (const double place : plot.axis.places) scale.ticks.values.push_back(place / scale.unit.size);
  } else if (scale.logarithmic) {
    scale.ticks = log_ticks_over(scale.low, scale.high);
    std::erase_if(scale.ticks.values, [&](double v) { return v < scale.low || v > scale.high; });
  } else {
    scale.ticks = ticks_within(scale.low, scale.high, 10);
  }
  return scale;
}

Scale scale_up(const PlotPanel& panel, double height) {
  const auto [low, high] = range_of(panel);
  Scale scale;
  scale.logarithmic = panel.logarithmic;
  scale.unit = human_unit(panel.unit, std::max(std::fabs(low), std::fabs(high)));
  scale.ticks = panel.logarithmic ? log_ticks_over(low / scale.unit.size, high / scale.unit.size)
                                  : ticks_over(low / scale.unit.size, high / scale.unit.size, height > 300 ? 7 : 5);
  scale.low = scale.ticks.values.front();
  scale.high = scale.ticks.values.back();
  return scale;
}

Axes axes_of(const Plot& plot, const PlotPanel& panel, double top, double height) {
  return {.top = top, .bottom = top + height, .across = scale_across(plot), .up = scale_up(panel, height)};
}

std::string with_unit(const std::string& words, const HumanUnit& unit) {
  return words + (unit.name.empty() ? "" : " [" + unit.name + "]");
}

void draw_axes(Svg& svg, const Axes& axes, const Plot& plot, const PlotPanel& panel, bool lowest) {
  const Scale& up = axes.up;
  for (const double v : up.ticks.values) {
    const double y = axes.y(v * up.unit.size);
    const bool zero = !up.logarithmic && std::fabs(v) < 1e-9 * up.ticks.step;
    svg.add(R"(<path d="M{:.1f} {:.1f}H{:.1f}" stroke="{}" stroke-width="{}"/>)", left, y, right,
            zero ? "#8a949e" : "#dde2e7", zero ? 1.2 : 1.0);
    svg.text({left - 9, y + 5}, up.ticks.text(v), "end");
  }
  const Scale& across = axes.across;
  const std::vector<std::string>& names = plot.axis.names;
  for (std::size_t n = 0; n < across.ticks.values.size(); ++n) {
    const double t = across.ticks.values[n];
    const double x = axes.x(t * across.unit.size);
    svg.add(R"(<path d="M{0:.1f} {1:.1f}V{2:.1f}" stroke="#dde2e7"/><path d="M{0:.1f} {2:.1f}v5" stroke="{3}"/>)", x,
            axes.top, axes.bottom, picture_ink);
    if (lowest) svg.text({x, axes.bottom + 21}, n < names.size() ? names[n] : across.ticks.text(t), "middle");
  }
  svg.add(R"(<path d="M{:.1f} {:.1f}V{:.1f}H{:.1f}" fill="none" stroke="{}" stroke-width="1.2"/>)", left, axes.top,
          axes.bottom, right, picture_ink);
  if (lowest) svg.text({0.5 * (left + right), axes.bottom + 44}, with_unit(plot.axis.label, across.unit), "middle");
  const std::string label = with_unit(panel.caption, up.unit);
  const double middle = 0.5 * (axes.top + axes.bottom);
  svg.text({22, middle}, label, "middle", fmt::format(R"svg(transform="rotate(-90 22 {:.1f})")svg", middle));
}

/// The curve with at most four points in each half px: the first, the extremes, the last.
PathData thinned_path(const PlotCurve& curve, const Axes& axes) {
  PathData path;
  bool open = false;
  const std::size_t count = curve.times.size();
  for (std::size_t i = 0; i < count;) {
    const double column = std::floor(2 * axes.x(curve.times[i]));
    std::array<std::size_t, 4> kept{i, i, i, i};  // first, least, most, last
    std::size_t end = i;
    for (; end < count && std::floor(2 * axes.x(curve.times[end])) == column; ++end) {
      if (curve.values[end] < curve.values[kept[1]]) kept[1] = end;
      if (curve.values[end] > curve.values[kept[2]]) kept[2] = end;
      kept[3] = end;
    }
    std::sort(kept.begin(), kept.end());
    for (std::size_t k = 0; k < kept.size(); ++k) {
      if (k > 0 && kept[k] == kept[k - 1]) continue;
      const Vec2 at{axes.x(curve.times[kept[k]]), axes.y(curve.values[kept[k]])};
      if (!std::isfinite(at.y)) {
        open = false;
      } else if (open) {
        path.line_to(at);
      } else {
        path.move_to(at);
        open = true;
      }
    }
    i = end;
  }
  return path;
}

void draw_curve(Svg& svg, const Axes& axes, const PlotCurve& curve) {
  svg.add(R"(<path d="{}" fill="none" stroke="{}" stroke-width="1.8" stroke-linejoin="round"{}/>)",
          thinned_path(curve, axes).text(), colour_of(curve), dash_of(curve));
}

void draw_extremes(Svg& svg, const Axes& axes, const PlotCurve& curve) {
  const CurveExtremes extremes = extremes_of(curve);
  if (!extremes.any || curve.values[extremes.most] == curve.values[extremes.least]) return;
  for (const std::size_t at : {extremes.least, extremes.most}) {
    svg.add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="4" fill="{}" stroke="#ffffff" stroke-width="1.4"/>)",
            axes.x(curve.times[at]), axes.y(curve.values[at]), colour_of(curve));
  }
}

void draw_markers(Svg& svg, const Axes& axes, const PlotCurve& curve) {
  for (std::size_t i = 0; i < curve.values.size(); ++i) {
    const double x = axes.x(curve.times[i]);
    const double y = axes.y(curve.values[i]);
    if (!std::isfinite(y)) continue;
    if (i < curve.errors.size() && std::isfinite(curve.errors[i])) {
      const double high = axes.y(curve.values[i] + curve.errors[i]);
      double low = axes.y(curve.values[i] - curve.errors[i]);
      if (!std::isfinite(low)) low = axes.bottom;  // a bar that reaches 0 on a logarithmic axis
      svg.add(
          R"(<path d="M{0:.1f} {1:.1f}V{2:.1f}M{3:.1f} {1:.1f}h10M{3:.1f} {2:.1f}h10" stroke="{4}" stroke-width="1.4"/>)",
          x, high, low, x - 5, colour_of(curve));
    }
    if (curve.markers) {
      svg.add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="4.5" fill="{}" stroke="#ffffff" stroke-width="1.2"/>)", x, y,
              colour_of(curve));
    }
  }
}

/// One row of the table: line, name and, where asked for, largest, smallest, last.
void draw_row(Svg& svg, const Axes& axes, const PlotCurve& curve, double y, bool with_extremes) {
  svg.add(R"(<path d="M{:.1f} {:.1f}h30" stroke="{}" stroke-width="2.4"{}/>)", left, y - 5, colour_of(curve),
          dash_of(curve));
  const double room = (with_extremes ? largest_column - 90 : right) - left - 40;
  const double letters = std::min(picture_font_size, room / std::max(1.0, text_width(curve.name, 1)));
  svg.text({left + 40, y}, curve.name, "start", fmt::format(R"(font-size="{:.1f}")", letters));
  const CurveExtremes extremes = extremes_of(curve);
  if (!extremes.any || !with_extremes) return;
  const double size = std::max(std::fabs(curve.values[extremes.least]), std::fabs(curve.values[extremes.most]));
  const auto value = [&](std::size_t at) {
    return number(curve.values[at] / axes.up.unit.size, size / axes.up.unit.size);
  };
  const auto with_time = [&](std::size_t at) { return value(at) + " at " + human_text(curve.times[at], "s", 4); };
  svg.text({largest_column + 70, y}, with_time(extremes.most), "end");
  svg.text({smallest_column + 70, y}, with_time(extremes.least), "end");
  svg.text({last_column + 70, y}, value(extremes.last), "end");
}

}  // namespace

CurveExtremes extremes_of(const PlotCurve& curve) {
  CurveExtremes found;
  for (std::size_t i = 0; i < curve.values.size(); ++i) {
    if (!std::isfinite(curve.values[i])) continue;
    if (!found.any || curve.values[i] < curve.values[found.least]) found.least = i;
    if (!found.any || curve.values[i] > curve.values[found.most]) found.most = i;
    found.last = i;
    found.any = true;
  }
  return found;
}

std::string to_svg(const Plot& plot) {
  const double height = plot.panels.size() == 1 ? 400 : plot.panels.size() == 2 ? 260 : 190;
  Svg svg;
  const double title_size = std::min(19.0, (right - 28) / std::max(1.0, text_width(plot.title, 1)));
  svg.text({28, 38}, plot.title, "start", fmt::format(R"(font-size="{:.1f}" font-weight="bold")", title_size));
  svg.text({28, 60}, plot.subtitle, "start", fmt::format(R"(fill="{}")", picture_grey));
  double y = plot.subtitle.empty() ? 68 : 90;
  if (plot.extremes) {
    const auto grey = fmt::format(R"(fill="{}")", picture_grey);
    svg.text({largest_column + 70, y}, "largest", "end", grey);
    svg.text({smallest_column + 70, y}, "smallest", "end", grey);
    svg.text({last_column + 70, y}, "at the end", "end", grey);
  } else {
    y -= 0.5 * row_height;
  }
  for (std::size_t p = 0; p < plot.panels.size(); ++p) {
    const PlotPanel& panel = plot.panels[p];
    const double table = row_height * static_cast<double>(panel.curves.size());
    const Axes axes = axes_of(plot, panel, y + table + 14, height);
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
      draw_row(svg, axes, panel.curves[c], y + row_height * static_cast<double>(c + 1), plot.extremes);
    }
    draw_axes(svg, axes, plot, panel, p + 1 == plot.panels.size());
    for (const PlotCurve& curve : panel.curves) draw_curve(svg, axes, curve);
    for (const PlotCurve& curve : panel.curves) {
      draw_markers(svg, axes, curve);
      if (plot.extremes) draw_extremes(svg, axes, curve);
    }
    y = axes.bottom + 18;
  }
  return picture_head(width, y + 44) + svg.body + "</svg>\n";
}

}  // namespace udar

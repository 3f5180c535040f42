#include "udar/study/headlines.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "udar/base/human_unit.hpp"
#include "udar/base/text.hpp"
#include "udar/study/estimate.hpp"

namespace udar {
namespace {

bool has(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

/// How far a decimal place is from the point: 0.031 -> 2.
int place_of(double size) { return size > 0 ? -static_cast<int>(std::floor(std::log10(size))) : 0; }

constexpr int most_digits = 6;

/// Decimals of a value whose error is `error`: two digits of the error, four of a value without one.
int decimals_for(double value, double error) {
  const int by_value = place_of(std::fabs(value)) + 3;
  if (!(error > 0)) return std::clamp(by_value, 0, 12);
  return std::clamp(std::min(place_of(error) + 1, place_of(std::fabs(value)) + most_digits - 1), 0, 12);
}

std::string decimal(double value, int decimals) {
  const std::string text = fmt::format("{:.{}f}", std::fabs(value), decimals);
  const bool zero = text.find_first_not_of("0.") == std::string::npos;
  return value < 0 && !zero ? "-" + text : text;
}

std::string unit_text(const HumanUnit& unit) { return unit.name.empty() ? "" : " " + unit.name; }

/// An error with two digits, in its own unit where it is small in that of the value.
std::string error_text(double error, const HumanUnit& unit, const std::string& si_unit) {
  HumanUnit own = unit;
  if (error < 1e-3 * unit.size) own = human_unit(si_unit, error);
  if (own.name.starts_with("10")) own = unit;  // a power of ten is harder to read than zeros
  const double size = error / own.size;
  const std::string number =
      size > 0 && size < 1e-6 ? fmt::format("{:.1e}", size) : decimal(size, std::clamp(place_of(size) + 1, 0, 12));
  return number + unit_text(own);
}

constexpr double rounding = 1e-9;

/// "± 0.031 ms (mesh)"; "" where there is no error bar.
std::string bar_of(const StudyQuantity& q, const Estimate& e, std::string_view what, const HumanUnit& unit) {
  if (e.verdict.empty() || !std::isfinite(e.error)) return "";
  if (e.error <= rounding * std::fabs(q.value)) return fmt::format(" ± 0 ({})", what);
  return fmt::format(" ± {} ({})", error_text(e.error, unit, q.unit), what);
}

/// What there is instead of it.
std::string lack_of(const Estimate& e, std::string_view what) {
  if (e.verdict.empty() || std::isfinite(e.error)) return "";
  if (e.verdict == verdict::not_converging) {
    const double last = 100 * e.differences.back();
    return fmt::format(", not converging with the {} (last change {})", what,
                       last < 10 ? fmt::format("{:.2g} %", last) : fmt::format("{:.0f} %", last));
  }
  return fmt::format(", {}: {}", what, e.reason);
}

/// What tells how many digits of the value mean something; NaN: nothing does.
double largest_error(const StudyQuantity& q) {
  double error = no_number;
  for (const Estimate* e : {&q.mesh, &q.step}) {
    if (!e->verdict.empty() && !std::isfinite(e->error)) return no_number;
    if (e->error > rounding * std::fabs(q.value) && !(e->error < error)) error = e->error;
  }
  return error;
}

bool is_usual(const StudyQuantity& q, double energy) {
  if (q.name.starts_with("contacts."))
    return q.name.ends_with(".duration_99") || q.name.ends_with(".episodes.0.restitution");
  if (q.name == "ledger.plastic" || q.name == "ledger.friction") {
    constexpr double worth_telling = 0.001;
    return std::fabs(q.value) > worth_telling * energy;
  }
  if (!q.name.starts_with("histories.")) return false;
  // Of observed nodes and elements; bodies and obstacles have other columns.
  const bool of_node = has(q.name, ".displacement_") && q.name.ends_with(".max_abs");
  const bool of_element = q.name.ends_with(".plastic_strain.max");
  return of_node || of_element;
}

void mark_usual(Study& study) {
  double energy = 0;
  for (const StudyQuantity& q : study.quantities) {
    if (q.name == "ledger.total") energy = q.value;
  }
  constexpr int most = 12;
  int count = 0;
  for (StudyQuantity& q : study.quantities) {
    q.headline = count < most && is_usual(q, energy);
    count += q.headline ? 1 : 0;
  }
}

/// Is `asked` the name, its end, or some whole parts of it?
bool is_meant(const std::string& name, const std::string& asked) {
  return fmt::format(".{}.", name).find(fmt::format(".{}.", asked)) != std::string::npos;
}

/// Returns whether there is such a number.
bool mark_asked(Study& study, const std::string& asked) {
  bool found = false;
  std::vector<std::string> names;
  for (StudyQuantity& q : study.quantities) {
    names.push_back(q.name);
    const std::size_t dot = q.name.find('.');
    if (dot != std::string::npos) names.push_back(q.name.substr(dot + 1));  // "corner.velocity_y.min"
    if (!is_meant(q.name, asked)) continue;
    q.headline = true;
    found = true;
  }
  if (found) return true;
  const std::string near = nearest_word(asked, names);
  study.warnings.push_back(
      fmt::format("no run has a number `{}`; {}", asked,
                  near.empty() ? "study.csv names all of them" : fmt::format("did you mean `{}`?", near)));
  return false;
}

}  // namespace

std::string words_of(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, const char*>, 20> known{
      {{"duration_99", "contact time (to 99 % of the push)"},
       {"duration", "contact time"},
       {"restitution", "restitution"},
       {"peak_force", "peak force"},
       {"first_touch", "first touch"},
       {"last_separation", "last separation"},
       {"plastic", "energy dissipated by plastic flow"},
       {"friction", "energy dissipated by friction"},
       {"kinetic", "kinetic energy at the end"},
       {"max_abs", "largest size of"},
       {"max", "largest"},
       {"min", "smallest"},
       {"last", "last"},
       {"time_of_max", "time of the largest"},
       {"time_of_min", "time of the smallest"},
       {"depth", "deepest penetration"},
       {"penetration_ratio", "deepest penetration over element size"},
       {"energy_error", "energy error"},
       {"x", "x"},
       {"y", "y"}}};
  const std::size_t dot = name.rfind('.');
  const std::string last = dot == std::string::npos ? name : name.substr(dot + 1);
  const auto* const at = std::find_if(known.begin(), known.end(), [&](const auto& pair) { return pair.first == last; });
  if (at == known.end()) return name;
  const std::string words = at->second;
  if (name.starts_with("histories.")) {
    const std::string rest = name.substr(10, dot - 10);
    const std::size_t part = rest.rfind('.');
    std::string column = rest.substr(part + 1);
    std::replace(column.begin(), column.end(), '_', ' ');
    return fmt::format("{} {} of {}", words, column, rest.substr(0, part));
  }
  if (name.starts_with("contacts.")) {
    std::string rest = name.substr(9, dot - 9);
    const std::size_t episodes = rest.find(".episodes.");
    if (episodes == std::string::npos) return fmt::format("{} of {}", words, rest);
    const int number = std::stoi(rest.substr(episodes + 10)) + 1;
    return fmt::format("{} of {}, episode {}", words, rest.substr(0, episodes), number);
  }
  return name.starts_with("ledger.") || dot == std::string::npos ? words : name;
}

std::string headline_of(const StudyQuantity& q) {
  const HumanUnit unit = human_unit(q.unit, std::fabs(q.value));
  const double error = largest_error(q);
  return fmt::format("{}{} = {}{}{}{}{}{}", words_of(q.name), q.window.empty() ? "" : ", " + q.window,
                     decimal(q.value / unit.size, decimals_for(q.value / unit.size, error / unit.size)),
                     unit_text(unit), bar_of(q, q.mesh, "mesh", unit), bar_of(q, q.step, "step", unit),
                     lack_of(q.mesh, "mesh"), lack_of(q.step, "step"));
}

void mark_headlines(Study& study, const std::vector<std::string>& asked) {
  bool any = false;
  for (const std::string& name : asked) any = mark_asked(study, name) || any;
  if (!any) mark_usual(study);
  for (const StudyQuantity& q : study.quantities) {
    if (q.headline && std::isfinite(q.value)) study.headlines.push_back(headline_of(q));
  }
}

}  // namespace udar

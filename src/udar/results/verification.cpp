#include "udar/results/verification.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <tuple>

#include "udar/base/human_unit.hpp"
#include "udar/results/json_members.hpp"

namespace udar {

constexpr int verification_schema = 1;

namespace {

/// The name of a kind in verify.json.
const char* name_of(CheckKind kind) {
  switch (kind) {
    case CheckKind::relative:
      return "relative";
    case CheckKind::absolute:
      return "absolute";
    case CheckKind::equal:
      return "equal";
    case CheckKind::at_most:
      return "at_most";
    case CheckKind::below:
      return "below";
    case CheckKind::at_least:
      return "at_least";
    case CheckKind::above:
      return "above";
    case CheckKind::between:
      return "between";
    case CheckKind::order:
      return "order";
    case CheckKind::holds:
      return "holds";
  }
  return "";
}

/// "1.23", without an exponent where a plain number says it as well.
std::string plain(double value, int digits) {
  std::string text = fmt::format("{:.{}g}", value, digits);
  if (text.find('e') == std::string::npos || std::fabs(value) >= 1e6 || std::fabs(value) < 1) return text;
  return fmt::format("{:.0f}", std::stod(text));  // 28300, not 2.83e+04
}

/// "0.35 %" of an error that is relative; small ones as they are.
std::string part(double error) {
  if (std::isnan(error)) return "";
  return error >= 1e-5 && error < 10 ? plain(100 * error, 3) + " %" : plain(error, 3);
}

/// A row's numbers are all in the unit that suits the largest of computed and exact.
struct RowNumbers {
  explicit RowNumbers(const CheckRow& row) {
    const bool known = std::isfinite(row.exact);
    // Beside a much larger bound its unit serves better.
    const double size = std::max(std::fabs(row.computed), known ? std::fabs(row.exact) : 0.1 * std::fabs(row.bound));
    // Rounding of a force is 1e-12 N, not 1e-9 mN.
    unit = size > 1e-9 && size < 1e12 ? human_unit(row.unit, size) : HumanUnit{typeset(row.unit), 1};
    if (row.unit.empty()) unit = {};
    if (unit.name.starts_with("10")) unit = {typeset(row.unit), 1};  // 1.5e-05 m/s: no prefix is usual there
    // Beside an exact value, or close to a bound, more digits tell something.
    const bool close = std::fabs(row.computed - row.bound) <= 0.01 * std::fabs(row.bound);
    digits = row.kind == CheckKind::order ? 3 : known || close ? 6 : 4;
  }
  [[nodiscard]] std::string text(double value, int of_digits) const {
    if (std::isnan(value)) return "";
    return plain(value / unit.size, of_digits) + (unit.name.empty() ? "" : " " + unit.name);
  }
  [[nodiscard]] std::string text(double value) const { return text(value, digits); }

  HumanUnit unit;
  int digits = 4;
};

std::string bound_words(const CheckRow& row, const RowNumbers& numbers) {
  const int digits = numbers.digits == 6 && std::isnan(row.exact) ? 6 : 3;  // a close bound has as many as its number
  const std::string bound = numbers.text(row.bound, digits);
  switch (row.kind) {
    case CheckKind::relative:
      return "≤ " + part(row.bound);
    case CheckKind::absolute:
      return "≤ " + bound;
    case CheckKind::equal:
      return "equal";
    case CheckKind::at_most:
      return "≤ " + bound;
    case CheckKind::below:
      return "< " + bound;
    case CheckKind::at_least:
      return "≥ " + bound;
    case CheckKind::above:
      return "> " + bound;
    case CheckKind::between:
      return fmt::format("{} … {}", bound, numbers.text(row.upper, digits));
    case CheckKind::order:
      return std::isinf(row.upper) ? "≥ " + bound : bound + " … " + numbers.text(row.upper, 3);
    case CheckKind::holds:
      return "";
  }
  return "";
}

}  // namespace

Json json_of(CheckKind kind) { return name_of(kind); }

template <Is<CheckRow> T, class Visit>
void for_each_member(T& r, Visit visit) {
  visit("kind", r.kind);
  visit("setting", r.setting);
  visit("what", r.what);
  visit("unit", r.unit);
  visit("computed", r.computed);
  visit("exact", r.exact);
  visit("error", r.error);
  visit("bound", r.bound);
  visit("upper", r.upper);
  visit("holds", r.holds);
}

template <Is<ErrorSeries> T, class Visit>
void for_each_member(T& s, Visit visit) {
  visit("what", s.what);
  visit("size", s.size);
  visit("size_unit", s.size_unit);
  visit("sizes", s.sizes);
  visit("errors", s.errors);
  visit("bounds", s.bounds);
  visit("order", s.order);
  visit("expected", s.expected);
}

template <Is<CheckLine> T, class Visit>
void for_each_member(T& l, Visit visit) {
  visit("name", l.name);
  visit("exact", l.exact);
  visit("x", l.x);
  visit("y", l.y);
}

template <Is<CheckCurve> T, class Visit>
void for_each_member(T& c, Visit visit) {
  visit("title", c.title);
  visit("x_label", c.x_label);
  visit("x_unit", c.x_unit);
  visit("y_label", c.y_label);
  visit("y_unit", c.y_unit);
  visit("lines", c.lines);
}

template <Is<VerifiedPart> T, class Visit>
void for_each_member(T& p, Visit visit) {
  visit("name", p.name);
  visit("long", p.is_long);
  visit("seconds", p.seconds);
  visit("checks", p.rows);
  visit("series", p.series);
  visit("curves", p.curves);
  visit("notes", p.notes);
  visit("page_rows", p.page_rows);
}

template <Is<VerifiedProblem> T, class Visit>
void for_each_member(T& p, Visit visit) {
  visit("id", p.id);
  visit("title", p.title);
  visit("topic", p.topic);
  visit("parts", p.parts);
}

template <Is<Verification> T, class Visit>
void for_each_member(T& v, Visit visit) {
  visit("version", v.version);
  visit("processor", v.processor);
  visit("date", v.date);
  visit("seconds", v.seconds);
  visit("cores", v.cores);
  visit("with_long", v.with_long);
  visit("bounds_times", v.bounds);
  visit("problems", v.problems);
}

bool is_held(const CheckRow& row) {
  if (row.kind != CheckKind::holds && !std::isfinite(row.computed)) return false;
  switch (row.kind) {
    case CheckKind::relative:
    case CheckKind::absolute:
      return row.error <= row.bound;
    case CheckKind::equal:
      return row.computed == row.exact;
    case CheckKind::at_most:
      return row.computed <= row.bound;
    case CheckKind::below:
      return row.computed < row.bound;
    case CheckKind::at_least:
      return row.computed >= row.bound;
    case CheckKind::above:
      return row.computed > row.bound;
    case CheckKind::between:
    case CheckKind::order:
      return row.computed >= row.bound && row.computed <= row.upper;
    case CheckKind::holds:
      return row.holds;
  }
  return false;
}

void scale_bounds(VerifiedProblem& problem, double factor) {
  for (VerifiedPart& part : problem.parts) {
    for (CheckRow& row : part.rows) {
      const bool upper = row.kind == CheckKind::relative || row.kind == CheckKind::absolute ||
                         row.kind == CheckKind::at_most || row.kind == CheckKind::below;
      if (!upper) continue;
      row.bound *= factor;
      row.holds = is_held(row);
    }
  }
}

CheckCount count_of(const VerifiedProblem& problem) {
  using Key = std::tuple<CheckKind, std::string, std::string, double, double, double>;
  CheckCount count;
  std::set<Key> earlier;
  for (const VerifiedPart& part : problem.parts) {
    std::set<Key> here;
    for (const CheckRow& row : part.rows) {
      if (row.kind != CheckKind::holds && std::isfinite(row.computed)) {
        const auto number = [](double value) { return std::isnan(value) ? 0.0 : value; };
        const Key key{row.kind, row.setting, row.what, row.computed, number(row.exact), number(row.bound)};
        if (earlier.contains(key)) continue;
        here.insert(key);
      }
      ++count.all;
      count.held += row.holds ? 1 : 0;
    }
    earlier.merge(here);
  }
  return count;
}

CheckCount count_of(const Verification& verification) {
  CheckCount count;
  for (const VerifiedProblem& problem : verification.problems) {
    const CheckCount of_problem = count_of(problem);
    count.held += of_problem.held;
    count.all += of_problem.all;
  }
  return count;
}

std::vector<std::vector<const CheckRow*>> grouped(const VerifiedPart& part) {
  std::vector<std::vector<const CheckRow*>> groups;
  for (const CheckRow& row : part.rows) {
    const auto same =
        std::find_if(groups.begin(), groups.end(), [&](const auto& group) { return group.front()->what == row.what; });
    if (same == groups.end()) {
      groups.push_back({&row});
    } else {
      same->push_back(&row);
    }
  }
  return groups;
}

double seconds_of(const VerifiedProblem& problem) {
  double seconds = 0;
  for (const VerifiedPart& part : problem.parts) seconds += part.seconds;
  return seconds;
}

CheckWords words_of(const CheckRow& row) {
  const RowNumbers numbers(row);
  const bool absolute = row.kind == CheckKind::absolute;
  const auto text = [&](double value) {
    const bool order = row.kind == CheckKind::order && std::isfinite(value);
    return order ? fmt::format("{:.2f}", value) : numbers.text(value);
  };
  CheckWords words{.computed = text(row.computed),
                   .exact = text(row.exact),
                   .error = absolute ? numbers.text(row.error, 3) : part(row.error),
                   .bound = bound_words(row, numbers),
                   .verdict = row.holds ? "holds" : "FAILS"};
  if (words.computed.empty() && row.kind != CheckKind::holds) words.computed = "no number";
  return words;
}

std::string to_json(const Verification& verification) {
  const CheckCount count = count_of(verification);
  Json json = Json::object();
  json["schema"] = verification_schema;
  json["checks"] = count.all;
  json["checks_held"] = count.held;
  json.update(json_of(verification));
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace udar

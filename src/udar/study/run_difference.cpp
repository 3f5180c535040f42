#include "udar/study/run_difference.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"
#include "udar/results/summary_numbers.hpp"
#include "udar/study/history_source.hpp"

namespace udar {
namespace {

[[noreturn]] void refuse(const std::string& message, const std::string& cure) {
  throw UserError(ExitCode::usage, message, cure);
}

/// Names for a message: not more than a line or two.
std::string some_of(std::vector<std::string> names) {
  constexpr std::size_t most = 12;
  const bool more = names.size() > most;
  if (more) names.resize(most);
  return one_of(names) + (more ? ", ..." : "");
}

/// What both sides have, by history, in the order of a.
struct Shared {
  std::string history;
  std::vector<Column> columns;
};

const HistoryColumns* find_history(const HistorySource& source, const std::string& name) {
  for (const HistoryColumns& h : source.histories()) {
    if (h.history == name) return &h;
  }
  return nullptr;
}

bool has_column(const HistoryColumns& h, const std::string& name) {
  return std::any_of(h.columns.begin(), h.columns.end(), [&](const Column& c) { return c.name == name; });
}

/// What `one` has and `other` has not: whole histories by their name, columns of common ones as history.column.
std::vector<std::string> only_in(const HistorySource& one, const HistorySource& other) {
  std::vector<std::string> names;
  for (const HistoryColumns& h : one.histories()) {
    const HistoryColumns* there = find_history(other, h.history);
    if (there == nullptr && !h.history.empty()) {
      names.push_back(h.history);
      continue;
    }
    for (const Column& column : h.columns) {
      if (there == nullptr || !has_column(*there, column.name)) names.push_back(h.name_of(column));
    }
  }
  names.insert(names.end(), one.unused().begin(), one.unused().end());
  return names;
}

std::vector<Shared> shared_of(const HistorySource& a, const HistorySource& b) {
  std::vector<Shared> shared;
  for (const HistoryColumns& h : a.histories()) {
    const HistoryColumns* there = find_history(b, h.history);
    if (there == nullptr) continue;
    Shared both{h.history, {}};
    for (const Column& column : h.columns) {
      if (has_column(*there, column.name)) both.columns.push_back(column);
    }
    if (!both.columns.empty()) shared.push_back(std::move(both));
  }
  return shared;
}

/// Does a word of --only mean this column? A history, one column, or both components of a vector.
bool means(const std::string& word, const std::string& history, const std::string& name) {
  return word == name || (!history.empty() && word == history) || word + "_x" == name || word + "_y" == name;
}

/// Refuses a word that means nothing common.
[[noreturn]] void refuse_word(const std::string& word, const std::vector<Shared>& shared, const HistorySource& a,
                              const HistorySource& b) {
  for (const HistorySource* side : {&a, &b}) {
    for (const HistoryColumns& h : side->histories()) {
      for (const Column& column : h.columns) {
        if (means(word, h.history, h.name_of(column))) {
          refuse(fmt::format("`{}` is only in `{}`", word, side->path().string()), "name what both have");
        }
      }
    }
  }
  std::vector<std::string> histories;
  std::vector<std::string> names;
  for (const Shared& s : shared) {
    histories.push_back(s.history);
    for (const Column& column : s.columns) names.push_back(HistoryColumns{s.history, {}}.name_of(column));
  }
  const std::string near = nearest_word(word, word.find('.') == std::string::npos ? histories : names);
  refuse(fmt::format("there is no history `{}`", word),
         near.empty() ? "write " + some_of(histories) : fmt::format("did you mean `{}`?", near));
}

/// Leaves only what the words mean.
void keep_only(std::vector<Shared>& shared, const std::vector<std::string>& words, const HistorySource& a,
               const HistorySource& b) {
  if (words.empty()) return;
  std::set<std::string> used;
  std::vector<Shared> kept = shared;
  for (Shared& s : kept) {
    std::erase_if(s.columns, [&](const Column& column) {
      const std::string name = HistoryColumns{s.history, {}}.name_of(column);
      bool wanted = false;
      for (const std::string& word : words) {
        if (!means(word, s.history, name)) continue;
        wanted = true;
        used.insert(word);
      }
      return !wanted;
    });
  }
  for (const std::string& word : words) {
    if (!used.contains(word)) refuse_word(word, shared, a, b);
  }
  std::erase_if(kept, [](const Shared& s) { return s.columns.empty(); });
  shared = std::move(kept);
}

bool same_rows(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

/// First and last time of all that was compared.
struct TimeRange {
  double first = std::numeric_limits<double>::infinity();
  double last = -std::numeric_limits<double>::infinity();

  void take(const std::vector<double>& times, double moved) {
    if (times.empty()) return;
    first = std::min(first, times.front() + moved);
    last = std::max(last, times.back() + moved);
  }
  [[nodiscard]] std::string text() const {
    return first <= last ? fmt::format("from {} to {}", in_units(first, "s"), in_units(last, "s")) : "none";
  }
};

/// Marks what is far below everything else of its unit, or below what the runs could make of it.
void mark_negligible(std::vector<ColumnDifference>& columns, const HistorySource& a, const HistorySource& b) {
  const auto size = [](const ColumnDifference& c) {
    return c.difference.compared() ? std::max(c.difference.size, c.difference.size_of_a) : 0;
  };
  std::map<std::string, double> largest;
  for (const ColumnDifference& c : columns) largest[c.unit] = std::max(largest[c.unit], size(c));
  for (const HistorySource* side : {&a, &b}) {
    if (side->run() == nullptr || !side->run()->summary) continue;
    const RunScales of_run(*side->run()->summary);
    for (auto& [unit, scale] : largest) scale = std::max(scale, of_run.of(unit));
  }
  for (ColumnDifference& c : columns) {
    c.negligible = !c.unit.empty() && c.difference.compared() && size(c) <= rounding_part * largest[c.unit];
  }
}

void compare_columns(RunDifference& out, const std::vector<Shared>& shared, const HistorySource& a,
                     const HistorySource& b, const HistoryComparison& how) {
  TimeRange range_a;
  TimeRange range_b;
  for (const Shared& s : shared) {
    const History one = a.read(s.history);
    const History two = b.read(s.history);
    range_a.take(one.values.front(), -how.shift_a);
    range_b.take(two.values.front(), -how.shift_b);
    const bool same_times = same_rows(one.values.front(), two.values.front());
    for (const Column& column : s.columns) {
      const std::vector<double>& in_a = one.at(column.name);
      const std::vector<double>& in_b = two.at(column.name);
      ColumnDifference c{.name = HistoryColumns{s.history, {}}.name_of(column),
                         .unit = column.unit,
                         .difference = compare_histories({one.values.front(), in_a}, {two.values.front(), in_b}, how),
                         .same_bits = same_times && same_rows(in_a, in_b)};
      out.columns.push_back(std::move(c));
    }
  }
  const bool cut = std::isfinite(how.from) || std::isfinite(how.to);
  // Runs of one row, as one that failed at once leaves them, have no time to compare over and may yet be the same.
  const bool as_they_are = !cut && how.shift_b == 0;
  const bool any = std::any_of(out.columns.begin(), out.columns.end(), [&](const ColumnDifference& c) {
    return c.difference.compared() || (as_they_are && c.same_bits);
  });
  if (any) return;
  refuse(fmt::format("there is no time that both have: A has rows {}, B {}", range_a.text(), range_b.text()),
         cut ? "widen --from and --to, or move B with --shift" : "move B with --shift, or compare other runs");
}

HistorySource open_side(const std::filesystem::path& path, const TableRequest& request) {
  return is_table(path) ? HistorySource::of_table(path, request) : HistorySource::of_run(path);
}

double touch_of(const HistorySource& side) {
  const bool told = side.run() != nullptr && side.run()->summary;
  const double time = told ? first_touch(*side.run()->summary) : no_number;
  if (std::isfinite(time)) return time;
  const bool table = side.run() == nullptr;
  refuse(fmt::format("`{}` has no first touch to align at", side.path().string()),
         table ? "a table does not tell it: move B with --shift instead" : "leave --align out, or move B with --shift");
}

/// Two sources, a table knowing what the other side has.
std::pair<HistorySource, HistorySource> open_both(const DifferenceRequest& request) {
  const bool table_a = is_table(request.a);
  const bool table_b = is_table(request.b);
  if (!request.maps.empty() && !table_a && !table_b) {
    refuse("--map names columns of a table, and both are runs", "leave --map out, or name a .csv file");
  }
  if (table_a && !table_b) {
    HistorySource b = HistorySource::of_run(request.b);
    const TableRequest table{.maps = request.maps, .known = &b.histories()};
    HistorySource a = HistorySource::of_table(request.a, table);
    return {std::move(a), std::move(b)};
  }
  HistorySource a = open_side(request.a, {});
  const TableRequest table{.maps = request.maps, .known = &a.histories()};
  HistorySource b = open_side(request.b, table);
  return {std::move(a), std::move(b)};
}

[[noreturn]] void refuse_nothing_common(const HistorySource& a, const HistorySource& b) {
  for (const HistorySource* side : {&a, &b}) {
    const HistorySource& other = side == &a ? b : a;
    if (side->run() != nullptr && side->histories().empty()) {
      refuse(fmt::format("the run `{}` has no histories", side->path().string()), "run the case again");
    }
    if (side->run() != nullptr || other.run() == nullptr) continue;
    const std::string example = names_of(other.histories()).empty() ? "" : names_of(other.histories()).front();
    const std::string column = side->unused().empty() ? "column" : side->unused().front();
    refuse(fmt::format("no column of `{}` is a history of `{}`", side->path().string(), other.path().string()),
           fmt::format("say what a column means: --map \"{}={}\"", column, example));
  }
  refuse(fmt::format("`{}` and `{}` have no common history", a.path().string(), b.path().string()),
         "compare runs that observe the same");
}

void compare_run_files(RunDifference& out, const RunFiles& a, const RunFiles& b) {
  out.runs = true;
  out.bits = compare_bits(a, b);
  if (!a.summary_text.empty() && !b.summary_text.empty()) {
    out.numbers = compare_summaries(a.summary_text, b.summary_text);
  }
  out.keys = compare_cases(a.resolved_text, b.resolved_text);
  for (const RunFiles* run : {&a, &b}) {
    for (const std::string& trouble : run->troubles) out.notes.push_back(run->folder.string() + ": " + trouble);
  }
}

}  // namespace

RunDifference compare_runs(const DifferenceRequest& request) {
  const auto [a, b] = open_both(request);
  std::vector<Shared> shared = shared_of(a, b);
  if (shared.empty()) refuse_nothing_common(a, b);
  keep_only(shared, request.only, a, b);
  RunDifference out;
  out.moved = request.shift + (request.align ? touch_of(a) - touch_of(b) : 0);
  // That a table lacks most of what a run has is no news.
  const bool alike = (a.run() == nullptr) == (b.run() == nullptr);
  if (alike || a.run() == nullptr) out.only_in_a = only_in(a, b);
  if (alike || b.run() == nullptr) out.only_in_b = only_in(b, a);
  HistoryComparison how = request.how;
  how.shift_a = 0;
  how.shift_b = -out.moved;
  compare_columns(out, shared, a, b, how);
  mark_negligible(out.columns, a, b);
  if (a.run() != nullptr && b.run() != nullptr) compare_run_files(out, *a.run(), *b.run());
  return out;
}

bool differs(const ColumnDifference& column, double within) {
  if (column.negligible) return false;
  if (!column.difference.compared()) return !column.same_bits;
  return !(relative_l2(column.difference) <= within);
}

}  // namespace udar

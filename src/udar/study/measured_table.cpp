#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"
#include "udar/case/ascii.hpp"
#include "udar/study/history_source.hpp"
#include "udar/study/table_text.hpp"
#include "udar/units/quantity.hpp"

namespace udar {
namespace {

/// A name of the first line.
struct Header {
  std::string name;  ///< without its unit
  std::string unit;  ///< as written; "" where there is none
};

Header header_of(const std::string& text) {
  const std::size_t open = text.rfind('[');
  if (open == std::string::npos || !text.ends_with(']')) return {text, ""};
  Header header{text.substr(0, open), text.substr(open + 1, text.size() - open - 2)};
  while (header.name.ends_with(' ')) header.name.pop_back();
  if (header.unit == "-" || header.unit == "1") header.unit.clear();
  return header;
}

/// Factor from a unit to SI. A whole number of parts divides: 2.5 ms is then the double nearest to 0.0025 s.
struct ToSi {
  double factor = 1;
  double parts = 0;  ///< 0: none

  [[nodiscard]] double operator()(double value) const { return parts > 0 ? value / parts : value * factor; }
};

/// "m^2" -> its dimension; a plain number where it is "" or no unit at all.
Dimension dimension_of(const std::string& unit) {
  if (unit.empty()) return dimension::number;
  const auto one = parse_quantity("1 " + unit);
  return one ? one->dimension : dimension::number;
}

/// The cure of a wrong unit, without the number that it was tried with.
std::string without_number(std::string cure) {
  if (const std::size_t at = cure.find("\"1 "); at != std::string::npos) cure.erase(at + 1, 2);
  return cure;
}

/// The factor of a column's unit, which must be one of `needed`.
ToSi to_si(const TablePlace& place, const Header& header, Dimension needed, const std::string& what) {
  if (header.unit.empty()) return {};
  const auto one = parse_quantity("1 " + header.unit);
  const std::string column = fmt::format("`{} [{}]`", shown(header.name), shown(header.unit));
  if (!one) {
    const UnitError& error = one.error();
    place.refuse(fmt::format("{} in the column {}", error.what, column), error.reason, without_number(error.cure));
  }
  if (!fits(one->dimension, needed)) {
    place.refuse(fmt::format("wrong unit in the column {}", column),
                 fmt::format("it is {}; {} is {}", dimension_name(one->dimension), what, dimension_name(needed)),
                 needed == dimension::number
                     ? "leave the unit out"
                     : fmt::format("write a unit such as [{}], or map another column", si_unit(needed)));
  }
  const double parts = std::round(1 / one->value);
  const bool whole = parts > 1 && parts < 0x1p53 && std::fabs(1 / one->value - parts) <= 1e-12 * parts;
  return {one->value, whole ? parts : 0};
}

/// A column of the table that is read.
struct Wanted {
  std::size_t field = 0;
  std::string history;
  Column column;
  ToSi to_si;
  std::vector<double> values;
};

/// Reads one table.
class TableReader {
 public:
  TableReader(const std::filesystem::path& file, const TableRequest& request)
      : lines_(file), request_(request), stem_(file.stem().string()) {
    place_.file = file.string();
  }

  MeasuredTable read() {
    read_header();
    read_rows();
    if (table_.times.empty()) {
      place_.line = 0;
      throw UserError(
          ExitCode::usage,
          {{.file = place_.file, .message = "the table has no rows", .cure = "write numbers below the line of names"}});
    }
    for (Wanted& w : wanted_) keep(w);
    return std::move(table_);
  }

 private:
  void read_header() {
    if (!lines_.next(place_)) {
      throw UserError(ExitCode::usage, fmt::format("`{}` is empty", place_.file),
                      "its first line names columns, as \"time [ms],corner.displacement_y [mm]\"");
    }
    separator_ = separator_of(place_.text);
    std::size_t count = 0;
    constexpr std::size_t most_columns = 10000;
    if (!split_fields(place_.text, separator_ == 0 ? ',' : separator_, fields_, count)) refuse_quote();
    double number = 0;
    if (!fields_[0].text.empty() && read_number(fields_[0].text, true, number)) {
      place_.refuse("the first line holds no names", "this is a number",
                    "name the columns, as \"time [ms],corner.displacement_y [mm]\"; a comment is no line of names");
    }
    if (separator_ == 0 || count < 2) {
      place_.refuse("a table has two columns at least", "there is no `,`, `;` or tab between names",
                    "the first column is time; the others are what is compared");
    }
    if (count > most_columns) place_.refuse("there are too many columns", "10000 are read at most", "");
    if (fields_[count - 1].text.empty()) --count;  // a separator ends every line
    columns_ = count;
    for (std::size_t k = 0; k < count; ++k) headers_.push_back(header_of(fields_[k].text));
    time_to_si_ = to_si(place_, headers_[0], dimension::time, "the first column");
    read_maps();
    for (std::size_t k = 1; k < count; ++k) choose(k);
  }

  /// Puts the meaning that --map gives in place of a column's name.
  void read_maps() {
    meanings_.resize(headers_.size());
    std::vector<std::string> names;
    for (std::size_t k = 1; k < headers_.size(); ++k) names.push_back(headers_[k].name);
    for (const std::string& map : request_.maps) {
      const std::size_t equals = map.rfind('=');
      if (equals == std::string::npos || equals == 0 || equals + 1 == map.size()) {
        throw UserError(ExitCode::usage, fmt::format("`--map {}` is not understood", map),
                        "write --map \"column=corner.displacement_y\"");
      }
      const std::string column = header_of(map.substr(0, equals)).name;
      const auto at = std::find(names.begin(), names.end(), column);
      if (at == names.end()) {
        const std::string near = nearest_word(column, names);
        if (names.size() > 12) names.resize(12);
        throw UserError(ExitCode::usage, fmt::format("`{}` has no column `{}`", place_.file, shown(column)),
                        near.empty() ? "write " + one_of(names) : fmt::format("did you mean `{}`?", shown(near)));
      }
      meanings_[static_cast<std::size_t>(at - names.begin()) + 1] = map.substr(equals + 1);
      check_meaning(map.substr(equals + 1));
    }
  }

  void check_meaning(const std::string& meaning) const {
    if (request_.known == nullptr || !find_known(meaning).empty()) return;
    std::vector<std::string> names = names_of(*request_.known);
    const std::string near = nearest_word(meaning, names);
    if (names.size() > 12) names.resize(12);
    throw UserError(ExitCode::usage, fmt::format("there is no history `{}` to compare with", meaning),
                    near.empty() ? "write " + one_of(names) : fmt::format("did you mean `{}`?", near));
  }

  /// Where the other side has a name: nothing, or one history and its column.
  std::vector<std::pair<const HistoryColumns*, const Column*>> find_known(const std::string& name) const {
    for (const HistoryColumns& h : *request_.known) {
      for (const Column& column : h.columns) {
        if (h.name_of(column) == name) return {{&h, &column}};
      }
    }
    return {};
  }

  /// Finds out what column `k` means and whether it is read.
  void choose(std::size_t k) {
    const std::string& name = headers_[k].name;
    if (name.empty() && meanings_[k].empty()) return;
    const std::string meaning = meanings_[k].empty() ? name : meanings_[k];
    Wanted w{.field = k, .history = "", .column = {meaning, ""}, .to_si = {}, .values = {}};
    if (request_.known != nullptr) {
      auto found = find_known(meaning);
      // A file of histories/ itself: corner.csv with displacement_y.
      if (found.empty()) found = find_known(stem_ + "." + meaning);
      if (found.empty()) {
        table_.unused.push_back(name);
        return;
      }
      w.history = found.front().first->history;
      w.column = *found.front().second;
      w.to_si = to_si(place_, headers_[k], dimension_of(w.column.unit), meaning);
    } else {
      if (const std::size_t dot = meaning.rfind('.'); dot != std::string::npos && dot > 0) {
        w.history = meaning.substr(0, dot);
        w.column.name = meaning.substr(dot + 1);
      }
      const auto one = parse_quantity("1 " + headers_[k].unit);
      const Dimension own = one && !headers_[k].unit.empty() ? one->dimension : dimension::number;
      w.to_si = to_si(place_, headers_[k], own, meaning);
      w.column.unit = si_unit(own);
    }
    for (const Wanted& other : wanted_) {
      if (other.history == w.history && other.column.name == w.column.name) {
        place_.refuse(fmt::format("two columns mean `{}`", meaning),
                      fmt::format("`{}` and `{}`", shown(headers_[other.field].name), shown(name)),
                      "take one of them out, or tell them apart with --map");
      }
    }
    wanted_.push_back(std::move(w));
  }

  void read_rows() {
    while (lines_.next(place_)) {
      std::size_t count = 0;
      if (!split_fields(place_.text, separator_, fields_, count)) refuse_quote();
      if (count == columns_ + 1 && fields_[count - 1].text.empty()) --count;
      if (count != columns_) {
        place_.refuse(fmt::format("{} values where the first line names {} columns", count, columns_), "",
                      separator_ == ',' && count > columns_
                          ? "numbers with a decimal comma need `;` or a tab between columns"
                          : "give every row as many values; an empty one is passed over");
      }
      const double time = time_to_si_(number(0));
      if (!std::isfinite(time)) place_.refuse("a row has no time", "", "take the row out");
      if (!table_.times.empty() && time < table_.times.back()) {
        place_.refuse("time goes back", "this row is before the one above", "sort the rows by time");
      }
      if ((table_.times.size() + 1) * (wanted_.size() + 1) > request_.most_values) {
        place_.refuse("the table has too many rows", fmt::format("{} values are kept at most", request_.most_values),
                      "keep every tenth row, or only the columns that you compare");
      }
      table_.times.push_back(time);
      for (Wanted& w : wanted_) w.values.push_back(w.to_si(number(w.field)));
    }
  }

  double number(std::size_t field) const {
    double value = 0;
    const TableField& f = fields_[field];
    if (!read_number(f.text, separator_ != ',' || f.quoted, value)) {
      place_.refuse(fmt::format("`{}` is not a number", shown(f.text)),
                    fmt::format("of the column `{}`", shown(headers_[field].name)),
                    "write 1.5, or 1,5 where `;` or a tab is between columns; nothing between thousands");
    }
    return value;
  }

  void keep(Wanted& w) {
    auto at = std::find_if(table_.histories.begin(), table_.histories.end(),
                           [&](const HistoryColumns& h) { return h.history == w.history; });
    if (at == table_.histories.end()) {
      table_.histories.push_back({w.history, {}});
      table_.values.emplace_back();
      at = table_.histories.end() - 1;
    }
    at->columns.push_back(w.column);
    table_.values[static_cast<std::size_t>(at - table_.histories.begin())].push_back(std::move(w.values));
  }

  [[noreturn]] void refuse_quote() const {
    place_.refuse("a quote is not closed", "", "write \" at both ends of a name, in one line");
  }

  TableLines lines_;
  const TableRequest& request_;
  std::string stem_;
  TablePlace place_;
  char separator_ = 0;
  std::size_t columns_ = 0;
  std::vector<TableField> fields_;
  std::vector<Header> headers_;
  std::vector<std::string> meanings_;  ///< of --map, for each column
  ToSi time_to_si_;
  std::vector<Wanted> wanted_;
  MeasuredTable table_;
};

}  // namespace

MeasuredTable read_table(const std::filesystem::path& file, const TableRequest& request) {
  return TableReader(file, request).read();
}

}  // namespace udar

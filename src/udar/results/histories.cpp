#include "udar/results/histories.hpp"

#include <fmt/format.h>

#include <cassert>
#include <charconv>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"
#include "udar/results/run_folder.hpp"

namespace udar {
namespace {

/// Cuts the text before `separator` off `rest`; all of it where there is no separator.
std::string_view cut(std::string_view& rest, char separator) {
  const std::size_t end = rest.find(separator);
  const std::string_view piece = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  return piece;
}

[[noreturn]] void refuse(std::string_view file, std::size_t line, const std::string& reason) {
  throw OutputError(fmt::format("cannot read {}:{}: {}", file, line, reason));
}

Column parse_column(std::string_view text, std::string_view file) {
  const std::size_t bracket = text.find(" [");
  if (!text.empty() && bracket == std::string_view::npos) return {std::string(text), ""};
  if (text.empty() || bracket == 0 || text.back() != ']') {
    refuse(file, 1, fmt::format("the column `{}` is not of the form `name [unit]`", text));
  }
  return {std::string(text.substr(0, bracket)), std::string(text.substr(bracket + 2, text.size() - bracket - 3))};
}

std::size_t room_for(std::size_t columns) {
  constexpr std::size_t longest_number = 25;  // -2.2250738585072014e-308 and a comma
  return columns * longest_number;
}

double parse_number(std::string_view text, std::string_view file, std::size_t line) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    refuse(file, line, fmt::format("`{}` is not a number", text.substr(0, 40)));
  }
  return value;
}

}  // namespace

HistoryWriter::HistoryWriter(const std::filesystem::path& path, const std::vector<Column>& columns)
    : file_(path), row_(room_for(columns.size()), '\0'), column_count_(columns.size()) {
  std::string header;
  for (const Column& column : columns) {
    if (!header.empty()) header += ',';
    header += safe_name(column.name);
    if (!column.unit.empty()) header += " [" + column.unit + "]";
  }
  file_.write(header + '\n');
}

HistoryWriter::HistoryWriter(const std::filesystem::path& path, std::size_t columns, std::uint64_t size)
    : file_(path, size), row_(room_for(columns), '\0'), column_count_(columns) {}

void HistoryWriter::write_row(std::span<const double> values) {
  assert(values.size() == column_count_);
  char* to = row_.data();
  for (const double value : values) {
    to = std::to_chars(to, row_.data() + row_.size(), value).ptr;
    *to++ = ',';
  }
  to[-1] = '\n';
  file_.write({row_.data(), to});
}

const std::vector<double>& History::at(std::string_view name) const {
  std::vector<std::string> names;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].name == name) return values[c];
    names.push_back(columns[c].name);
  }
  throw OutputError(fmt::format("no column `{}`; there is {}", name, one_of(names)));
}

History read_csv(const std::filesystem::path& path) {
  constexpr std::size_t most_bytes = std::size_t{1} << 30;
  return parse_csv(read_file(path, most_bytes), path.string());
}

History parse_csv(std::string_view text, std::string_view name) {
  constexpr std::size_t most_columns = 10000;  // a hostile header must not cost hundreds of times its size
  text = text.substr(0, text.rfind('\n') + 1);
  if (text.empty()) refuse(name, 1, "there is no header");
  History history;
  for (std::string_view header = cut(text, '\n'); !header.empty();) {
    history.columns.push_back(parse_column(cut(header, ','), name));
    if (history.columns.size() > most_columns) refuse(name, 1, "there are too many columns");
  }
  if (history.columns.empty()) refuse(name, 1, "the header is empty");
  history.values.resize(history.columns.size());
  for (std::size_t line = 2; !text.empty(); ++line) {
    std::string_view row = cut(text, '\n');
    std::size_t count = 0;
    while (!row.empty()) {
      const double value = parse_number(cut(row, ','), name, line);
      if (count < history.values.size()) history.values[count].push_back(value);
      ++count;
    }
    if (count != history.columns.size()) {
      refuse(name, line, fmt::format("{} values where the header names {} columns", count, history.columns.size()));
    }
  }
  return history;
}

}  // namespace udar

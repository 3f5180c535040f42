#include "udar/study/table_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "udar/base/error.hpp"
#include "udar/case/ascii.hpp"

namespace udar {
namespace {

[[noreturn]] void refuse_file(const std::filesystem::path& file, const std::string& reason, const std::string& cure) {
  throw UserError(ExitCode::usage, fmt::format("`{}` {}", file.string(), reason), cure);
}

/// The file, if it may be opened: reading a pipe or a device could wait for ever.
const std::filesystem::path& checked(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) refuse_file(file, "is not there", "name a table, or the folder of a run");
  if (!std::filesystem::is_regular_file(file, error)) refuse_file(file, "is no file", "name a file with a table");
  return file;
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

}  // namespace

void TablePlace::refuse(const std::string& message, const std::string& reason, const std::string& cure) const {
  constexpr std::size_t longest = 200;
  throw UserError(ExitCode::usage, {{.file = file,
                                     .line = line,
                                     .column = 1,
                                     .source = printable(std::string_view(text).substr(0, longest)),
                                     .message = message,
                                     .pointer = reason,
                                     .cure = cure}});
}

TableLines::TableLines(const std::filesystem::path& file) : reader_(checked(file)) {
  if (reader_.size() > largest_table) {
    refuse_file(file, fmt::format("has {} bytes; {} are read at most", reader_.size(), largest_table),
                "keep every tenth row, or only the columns that you compare");
  }
  buffer_ = reader_.read(0, 4);
  if (buffer_.starts_with("\xff\xfe") || buffer_.starts_with("\xfe\xff")) {
    refuse_file(file, "is written in UTF-16", "save it as UTF-8 (or plain ASCII)");
  }
  position_ = buffer_.size();
  if (buffer_.starts_with("\xef\xbb\xbf")) begin_ = 3;
}

bool TableLines::any(TablePlace& place) {
  constexpr std::size_t piece = std::size_t{1} << 18;
  constexpr std::size_t longest_line = std::size_t{1} << 20;
  ++place.line;
  std::size_t end = buffer_.find('\n', begin_);
  while (end == std::string::npos && position_ < reader_.size()) {
    buffer_.erase(0, begin_);
    begin_ = 0;
    const std::size_t before = buffer_.size();
    buffer_ += reader_.read(position_, piece);
    if (buffer_.size() == before) break;  // it has become shorter
    position_ += buffer_.size() - before;
    end = buffer_.find('\n', before);
    if (end == std::string::npos && buffer_.size() > longest_line) {
      place.text.clear();
      place.refuse("this line is too long", "more than a million characters", "is it a table of text?");
    }
  }
  if (end == std::string::npos) {
    if (begin_ >= buffer_.size()) return false;
    end = buffer_.size();
  }
  place.text.assign(buffer_, begin_, end - begin_);
  begin_ = std::min(end + 1, buffer_.size());
  if (place.text.ends_with('\r')) place.text.pop_back();
  if (place.text.find('\0') != std::string::npos) {
    place.refuse("this is no text", "a line holds zero bytes", "save the table as text in UTF-8");
  }
  return true;
}

bool TableLines::next(TablePlace& place) {
  while (any(place)) {
    const std::size_t first = place.text.find_first_not_of(" \t");
    if (first != std::string::npos && place.text[first] != '#') return true;
  }
  return false;
}

char separator_of(std::string_view line) {
  for (const char separator : {'\t', ';', ','}) {
    bool quoted = false;
    int brackets = 0;
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      if (c == '[') ++brackets;
      if (c == ']') --brackets;
      if (!quoted && brackets <= 0 && c == separator) return separator;
    }
  }
  return 0;
}

bool split_fields(std::string_view line, char separator, std::vector<TableField>& fields, std::size_t& count) {
  count = 0;
  std::size_t at = 0;
  for (;;) {
    if (count == fields.size()) fields.emplace_back();
    TableField& field = fields[count++];
    field.text.clear();
    field.quoted = false;
    while (at < line.size() && line[at] != separator && is_space(line[at])) ++at;
    if (at < line.size() && line[at] == '"') {
      field.quoted = true;
      for (++at;; ++at) {
        if (at >= line.size()) return false;
        if (line[at] != '"') {
          field.text += line[at];
        } else if (at + 1 < line.size() && line[at + 1] == '"') {
          field.text += line[++at];
        } else {
          break;
        }
      }
      ++at;
      while (at < line.size() && line[at] != separator) field.text += line[at++];  // makes it no number, if it is text
    } else {
      const std::size_t end = std::min(line.find(separator, at), line.size());
      field.text.assign(line.substr(at, end - at));
      at = end;
    }
    while (!field.text.empty() && is_space(field.text.back())) field.text.pop_back();
    if (at >= line.size()) return true;
    ++at;
  }
}

bool read_number(const std::string& text, bool comma, double& value) {
  value = std::numeric_limits<double>::quiet_NaN();
  if (text.empty() || text == "-") return true;
  std::string changed;
  std::string_view number = text;
  if (const std::size_t at = text.find(','); at != std::string::npos) {
    if (!comma || text.find('.') != std::string::npos) return false;
    changed = text;
    changed[at] = '.';
    number = changed;
  }
  if (number.starts_with('+')) number.remove_prefix(1);
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  return error == std::errc() && end == number.data() + number.size();
}

}  // namespace udar

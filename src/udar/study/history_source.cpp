#include "udar/study/history_source.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "udar/base/error.hpp"
#include "udar/results/run_folder.hpp"

namespace udar {
namespace {

/// The columns of a history from the begin of its file; none where that is not written yet.
std::vector<Column> columns_in(const std::filesystem::path& file) {
  constexpr std::size_t longest_header = std::size_t{1} << 18;
  const std::string begin = PartReader(file).read(0, longest_header);
  const std::size_t end = begin.find('\n');
  if (end == std::string::npos) return {};
  std::vector<Column> columns = parse_csv(std::string_view(begin).substr(0, end + 1), file.string()).columns;
  columns.erase(columns.begin());
  return columns;
}

}  // namespace

HistorySource HistorySource::of_run(const std::filesystem::path& folder) {
  HistorySource source;
  source.path_ = folder;
  source.run_ = find_run_files(folder);
  for (const std::filesystem::path& file : source.run_->histories) {
    std::vector<Column> columns = columns_in(file);
    if (!columns.empty()) source.histories_.push_back({file.stem().string(), std::move(columns)});
  }
  return source;
}

HistorySource HistorySource::of_table(const std::filesystem::path& file, const TableRequest& request) {
  HistorySource source;
  source.path_ = file;
  source.table_ = read_table(file, request);
  source.histories_ = source.table_.histories;
  return source;
}

History HistorySource::read(const std::string& history) const {
  if (run_) return read_csv(run_->folder / RunFolder::histories / (history + ".csv"));
  const auto at =
      std::find_if(histories_.begin(), histories_.end(), [&](const HistoryColumns& h) { return h.history == history; });
  if (at == histories_.end()) throw OutputError(fmt::format("{} has no history `{}`", path_.string(), history));
  const auto& values = table_.values[static_cast<std::size_t>(at - histories_.begin())];
  History out{.columns = {{"time", "s"}}, .values = {table_.times}};
  out.columns.insert(out.columns.end(), at->columns.begin(), at->columns.end());
  out.values.insert(out.values.end(), values.begin(), values.end());
  return out;
}

bool is_table(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) return true;
  if (std::filesystem::is_directory(path, error)) return false;
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return ending == ".csv" || ending == ".tsv" || ending == ".txt";
}

std::vector<std::string> names_of(const std::vector<HistoryColumns>& histories) {
  std::vector<std::string> names;
  for (const HistoryColumns& h : histories) {
    for (const Column& column : h.columns) names.push_back(h.name_of(column));
  }
  return names;
}

}  // namespace udar

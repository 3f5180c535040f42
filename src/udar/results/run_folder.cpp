#include "udar/results/run_folder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <system_error>
#include <vector>

#include "udar/base/error.hpp"
#include "udar/results/file.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

constexpr std::array top_files{RunFolder::given_case,     RunFolder::resolved_case, RunFolder::version,
                               RunFolder::summary,        RunFolder::log,           RunFolder::setup_picture,
                               RunFolder::final_picture,  RunFolder::report,        RunFolder::fields_index,
                               RunFolder::checkpoints[0], RunFolder::checkpoints[1]};

/// `name` without the ending that a killed `write_file` leaves.
std::string_view without_temporary(std::string_view name) {
  return name.ends_with(".tmp") ? name.substr(0, name.size() - 4) : name;
}

bool is_own_top_file(std::string_view name) {
  return std::find(top_files.begin(), top_files.end(), without_temporary(name)) != top_files.end();
}
bool is_own_field(std::string_view name) { return without_temporary(name).ends_with(".vtu"); }
bool is_own_history(std::string_view name) { return without_temporary(name).ends_with(".csv"); }

[[noreturn]] void disk_refuses(std::string_view action, const fs::path& path, const std::error_code& error) {
  throw OutputError(
      fmt::format("cannot {} {}: {}; choose another folder with --output", action, path.string(), error.message()));
}

std::vector<fs::path> content(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    found.push_back(it->path());
  }
  if (error) disk_refuses("read folder", folder, error);
  return found;
}

/// Removes the files and links in `folder` whose name `is_own` knows. Never enters or removes a folder.
template <class IsOwn>
void remove_own(const fs::path& folder, IsOwn is_own) {
  std::error_code error;
  if (!fs::is_directory(fs::symlink_status(folder, error))) return;
  for (const fs::path& file : content(folder)) {
    if (!is_own(file.filename().string()) || fs::is_directory(fs::symlink_status(file, error))) continue;
    if (!fs::remove(file, error) && error) disk_refuses("remove", file, error);
  }
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error || !fs::is_directory(path, error)) disk_refuses("make folder", path, error);
}

void check_free(const fs::path& path, bool force) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) {
    throw UserError(ExitCode::usage, fmt::format("`{}` exists and is not a folder", path.string()),
                    "choose another folder with `--output`");
  }
  // All that is left of a run that was killed in its first moment is no result.
  const auto is_nothing = [](const fs::path& file) {
    return without_temporary(file.filename().string()) == RunFolder::marker;
  };
  const auto files = content(path);
  if (std::all_of(files.begin(), files.end(), is_nothing)) return;
  if (!fs::is_regular_file(fs::symlink_status(path / RunFolder::marker, error))) {
    throw UserError(ExitCode::usage,
                    fmt::format("the folder `{}` holds files that are not the results of a run", path.string()),
                    "choose an empty or new folder with `--output`");
  }
  if (!force) {
    throw UserError(ExitCode::usage, fmt::format("the folder `{}` holds the results of another run", path.string()),
                    "choose another folder with `--output`, or replace these results with `--force`");
  }
}

}  // namespace

void refuse_link(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(fs::symlink_status(path, error))) return;
  throw UserError(ExitCode::usage,
                  fmt::format("`{}` is a link; results are never written through a link", path.string()),
                  "remove it, or choose another folder with `--output`");
}

fs::path RunFolder::history(std::string_view observer) const {
  return path / histories / (safe_name(observer) + ".csv");
}

std::string RunFolder::frame_name(std::string_view part, int frame) {
  return fmt::format("{}/{}_{:06}.vtu", fields, safe_name(part), frame);
}

RunFolder create_run_folder(const fs::path& path, bool force) {
  refuse_link(path);
  std::error_code error;
  std::shared_ptr<const FolderLock> lock;
  if (fs::is_directory(path, error)) lock = std::make_shared<const FolderLock>(path);
  check_free(path, force);
  make_folder(path);
  if (!lock) lock = std::make_shared<const FolderLock>(path);
  refuse_link(path / RunFolder::fields);
  refuse_link(path / RunFolder::histories);
  remove_own(path, is_own_top_file);
  remove_own(path / RunFolder::fields, is_own_field);
  remove_own(path / RunFolder::histories, is_own_history);
  write_file(path / RunFolder::marker, "This folder was made by udar; `udar run --force` may replace its results.\n");
  make_folder(path / RunFolder::fields);
  make_folder(path / RunFolder::histories);
  return {path, std::move(lock)};
}

RunFolder reopen_run_folder(const fs::path& path) {
  refuse_link(path);
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(path / RunFolder::marker, error))) {
    throw UserError(ExitCode::usage, fmt::format("`{}` is not the folder of a run", path.string()),
                    "name a folder that `udar run` has made, such as runs/short-beam");
  }
  refuse_link(path / RunFolder::fields);
  refuse_link(path / RunFolder::histories);
  auto lock = std::make_shared<const FolderLock>(path);
  make_folder(path / RunFolder::fields);  // who removed the frames to save room does without them
  return {path, std::move(lock)};
}

std::string safe_name(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    const bool safe =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
    if (!safe) c = '_';
  }
  if (out.empty() || out.front() == '.' || out.front() == '-') out.insert(0, 1, '_');
  return out;
}

}  // namespace udar

#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "udar/results/folder_lock.hpp"

namespace udar {

/// The files of a run folder, by their names in it.
struct RunFolder {
  static constexpr std::string_view marker = ".udar-run";  ///< says that Udar made this folder and may clear it
  static constexpr std::string_view given_case = "case.toml";
  static constexpr std::string_view resolved_case = "resolved.toml";
  static constexpr std::string_view version = "version.txt";
  static constexpr std::string_view summary = "summary.json";
  static constexpr std::string_view log = "log.txt";
  static constexpr std::string_view setup_picture = "setup.svg";
  static constexpr std::string_view final_picture = "final.svg";
  static constexpr std::string_view report = "report.html";
  static constexpr std::string_view fields_index = "fields.pvd";
  /// Two generations, written in turn; there only while a run is under way or after one that was stopped.
  static constexpr std::array<std::string_view, 2> checkpoints{"checkpoint_a.bin", "checkpoint_b.bin"};
  static constexpr std::string_view fields = "fields";        ///< folder of `*.vtu`
  static constexpr std::string_view histories = "histories";  ///< folder of `*.csv`

  std::filesystem::path path;
  std::shared_ptr<const FolderLock> lock;  ///< held by a run that writes there
  [[nodiscard]] std::filesystem::path operator/(std::string_view name) const { return path / name; }
  /// histories/<observer>.csv
  [[nodiscard]] std::filesystem::path history(std::string_view observer) const;
  /// fields/<part>_000042.vtu, relative to the run folder: the index stays right when the folder is moved.
  [[nodiscard]] static std::string frame_name(std::string_view part, int frame);
};

/// Makes an empty run folder with its sub-folders. A folder that holds something is refused (UserError, usage) unless
/// `force`, and even then unless Udar made it: then the files that Udar writes are removed, and no others; links are
/// removed, not followed, and a folder that is a link is refused. Throws OutputError when the disk refuses.
RunFolder create_run_folder(const std::filesystem::path& path, bool force);

/// Throws UserError(usage) where `path` is a link: what is written into a folder that a stranger made must not leave
/// it.
void refuse_link(const std::filesystem::path& path);

/// Takes up a run folder again whose run was stopped. Throws UserError (usage) where it is none, or where the run is
/// still under way.
RunFolder reopen_run_folder(const std::filesystem::path& path);

/// `text` with everything but letters, digits, `_`, `-` and `.` replaced by `_`: safe as part of a file name, a column
/// or a field name.
std::string safe_name(std::string_view text);

}  // namespace udar

#include "udar/study/study_folder.hpp"

#include <fmt/core.h>

#include <system_error>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"
#include "udar/results/file.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/study/tables.hpp"

namespace udar {
namespace fs = std::filesystem;

StudyLock open_study_folder(const fs::path& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (fs::exists(status) && !fs::is_directory(status)) {
    throw UserError(ExitCode::usage, fmt::format("`{}` exists and is not a folder", folder.string()),
                    "choose another folder with `--output`");
  }
  const bool is_taken = fs::is_directory(status) && !fs::is_empty(folder, error) && !is_study_folder(folder);
  if (is_taken) {
    throw UserError(ExitCode::usage,
                    fmt::format("the folder `{}` holds files that are not a study of udar", folder.string()),
                    "choose an empty or new folder with `--output`");
  }
  const auto make = [&](const fs::path& path) {
    fs::create_directories(path, error);
    if (error) throw OutputError(fmt::format("cannot make folder {}: {}", path.string(), error.message()));
  };
  make(folder);
  StudyLock lock(folder / StudyFolder::marker);
  refuse_link(folder / StudyFolder::runs);
  make(folder / StudyFolder::runs);
  return lock;
}

std::size_t write_commands(const StudyInput& input, const fs::path& folder, const std::vector<PlannedRun>& plan) {
  std::string text;
  std::size_t count = 0;
  for (const PlannedRun& run : plan) {
    if (look_at(folder / StudyFolder::runs / run.name, run).state != Standing::State::missing) continue;
    text += "udar";
    for (const std::string& word : words_to_complete(input, folder, run, 0)) text += " " + shell_word(word);
    text += "\n";
    ++count;
  }
  write_file(folder / StudyFolder::commands, text);
  return count;
}

void write_study(const fs::path& folder, const Study& study) {
  write_file(folder / StudyFolder::table, to_csv(study));
  write_file(folder / StudyFolder::report, to_markdown(study));
  write_file(folder / StudyFolder::study, to_json(study));
}

}  // namespace udar

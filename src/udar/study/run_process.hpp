#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "udar/results/file.hpp"

namespace udar {

/// A process that computes a run: this program again, with these words. What it writes goes to a file.
class RunProcess {
 public:
  /// Throws OutputError where it cannot be started.
  RunProcess(const std::vector<std::string>& words, const std::filesystem::path& output);
  RunProcess(RunProcess&& other) noexcept;
  RunProcess& operator=(RunProcess&& other) noexcept;
  RunProcess(const RunProcess&) = delete;
  RunProcess& operator=(const RunProcess&) = delete;
  /// One that still runs is stopped, and waited for.
  ~RunProcess();

  /// How it ended: its exit code, or 128 and the number of the signal; none while it runs.
  std::optional<int> ended();
  /// Asks it to save everything and to end, as Ctrl-C does.
  void interrupt() const;

 private:
  pid_t pid_ = -1;
};

/// A file that only one process and those that it starts hold, until the last of them has ended.
class StudyLock {
 public:
  /// Throws UserError (usage) where another one holds it, OutputError where the file cannot be made.
  explicit StudyLock(const std::filesystem::path& file);

 private:
  Descriptor file_;
};

}  // namespace udar

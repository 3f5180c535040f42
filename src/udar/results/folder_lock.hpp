#pragma once

#include <filesystem>

#include "udar/results/file.hpp"

namespace udar {

/// A folder that only one process at a time writes its results to. The system lets go of it when the process ends,
/// however it ends. Where a network disk knows no locks, there is none.
class FolderLock {
 public:
  /// Throws UserError (usage) where another process has it, OutputError where the folder cannot be opened.
  explicit FolderLock(const std::filesystem::path& folder);

 private:
  Descriptor folder_;
};

}  // namespace udar

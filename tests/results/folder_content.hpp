#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "udar/results/file.hpp"

/// Every file below `folder` with its bytes, by its path in there.
inline std::map<std::string, std::string> content_of(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    all[fs::relative(entry.path(), folder).string()] = udar::read_file(entry.path(), 1 << 26);
  }
  return all;
}

#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace udar {

/// One file of the index.
struct PvdEntry {
  double time = 0;   ///< s
  int part = 0;      ///< 0: bodies, 1: obstacles
  std::string file;  ///< relative to the folder of the index

  friend bool operator==(const PvdEntry&, const PvdEntry&) = default;
};

/// The list of frames that ParaView opens. It is written anew, all or nothing, after each frame, so that a run that
/// fails can be looked at up to its last frame.
class PvdIndex {
 public:
  explicit PvdIndex(std::filesystem::path path) : path_(std::move(path)) {}
  /// Adds the files of one frame, which must already be on the disk. Throws OutputError.
  void add(const std::vector<PvdEntry>& frame);
  [[nodiscard]] const std::vector<PvdEntry>& entries() const { return entries_; }

 private:
  std::filesystem::path path_;
  std::vector<PvdEntry> entries_;
};

std::string to_pvd(const std::vector<PvdEntry>& entries);

/// Reads an index back. Throws OutputError, also for entries that lead out of the folder.
std::vector<PvdEntry> read_pvd(const std::filesystem::path& path);
std::vector<PvdEntry> parse_pvd(std::string_view text);

}  // namespace udar

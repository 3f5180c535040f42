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

/// The list of frames that ParaView opens. It is written anew, all or nothing, again and again while the run goes on,
/// so that one that fails can be looked at.
class PvdIndex {
 public:
  explicit PvdIndex(std::filesystem::path path) : path_(std::move(path)) {}
  /// Adds the files of one frame, for the next `write`.
  void add(const std::vector<PvdEntry>& frame) { entries_.insert(entries_.end(), frame.begin(), frame.end()); }
  /// Writes the list; all that it names must be on the disk. Throws OutputError.
  void write() const;
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

#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "udar/results/file.hpp"

namespace udar {

/// A checkpoint on the disk: a line that says what it is, then parts with a name and any bytes, each with a checksum
/// (CRC-32, ISO 3309) over all of it, then a part `end` that counts them. A file that was cut off or of which a single
/// bit is wrong is refused.
///
///     "udar checkpoint 1\n"
///     each part: u32 length of its name, u32 checksum, u64 length of its bytes, name, bytes (little-endian)
class CheckpointWriter {
 public:
  /// Begins one that takes the place of `path` when it is whole. Throws OutputError, as all of it does.
  explicit CheckpointWriter(const std::filesystem::path& path);
  void add(std::string_view name, std::string_view bytes);
  /// Writes the end, waits for the disk and puts the file in its place.
  void commit();

 private:
  FileReplacement file_;
  std::uint64_t parts_ = 0;
};

/// A checkpoint in memory, whole and undamaged.
class CheckpointFile {
 public:
  /// Throws OutputError with what is wrong.
  explicit CheckpointFile(std::string bytes);
  CheckpointFile(CheckpointFile&&) = default;  // parts stay where they are in memory
  CheckpointFile& operator=(CheckpointFile&&) = default;
  CheckpointFile(const CheckpointFile&) = delete;

  /// The bytes of a part; they live as long as this. Throws OutputError where there is none of that name.
  [[nodiscard]] std::string_view part(std::string_view name) const;
  /// Gives the memory back; no part is there any more.
  void clear();

 private:
  std::unique_ptr<const std::string> bytes_;
  std::map<std::string_view, std::string_view> parts_;
};

}  // namespace udar

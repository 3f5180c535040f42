#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace udar {

/// Makes `path` hold exactly `bytes`, or leaves it as it was: temporary file beside it, fsync, rename, fsync of the
/// folder. Whoever reads `path` at any moment, even after a power cut, finds the old or the new content, never a part.
/// Throws OutputError; refuses to replace anything but a regular file.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// The whole file. Throws OutputError where it cannot be read or is larger than `most_bytes`.
std::string read_file(const std::filesystem::path& path, std::size_t most_bytes);

/// The first bytes of a file, `most` of them or fewer. Of a pipe it waits for what is written; where nobody writes it,
/// that is nothing. Throws OutputError.
std::string read_beginning(const std::filesystem::path& path, std::size_t most);

/// Waits until what was written so far to these files is on the disk for good. Throws OutputError.
void sync_files(const std::vector<std::filesystem::path>& files);

/// An open file number, closed when it goes out of scope.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor();
  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }
  int release() { return std::exchange(number_, -1); }

 private:
  int number_ = -1;
};

/// A file of which parts are read. Every call throws OutputError when it fails.
class PartReader {
 public:
  explicit PartReader(std::filesystem::path path);
  /// Bytes of the file when it was opened.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// `count` bytes from byte `at` on; fewer where the file ends.
  [[nodiscard]] std::string read(std::size_t at, std::size_t count) const;

 private:
  std::filesystem::path path_;
  Descriptor file_;
  std::size_t size_ = 0;
};

/// Makes a file piece by piece, all or nothing as `write_file` does. Every call throws OutputError when it fails.
class FileReplacement {
 public:
  /// Begins a temporary file beside `path`.
  explicit FileReplacement(std::filesystem::path path);
  FileReplacement(const FileReplacement&) = delete;
  FileReplacement& operator=(const FileReplacement&) = delete;
  /// Removes the temporary file, if it was not put in its place.
  ~FileReplacement();

  void write(std::string_view bytes);
  /// Writes one piece after another.
  void write(std::span<const std::string_view> pieces);
  /// Waits for the disk and puts the file in its place.
  void commit();
  /// Puts the file in its place without waiting for the disk: whoever reads it, also after the program was killed,
  /// finds it whole; a power cut within the next half a minute may damage it.
  void commit_unsynced();
  /// Where it lies until then: another program may write there.
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  Descriptor file_;
};

/// A text file that grows at its end. Every call that reaches the disk throws OutputError when it fails; after that the
/// file takes no more.
class AppendFile {
 public:
  AppendFile() = default;
  /// Opens `path` for appending and creates it where it is missing; never follows a link.
  explicit AppendFile(std::filesystem::path path);
  /// Opens `path` to go on behind its first `size` bytes; what follows them is cut off. Refuses a shorter file.
  AppendFile(std::filesystem::path path, std::uint64_t size);
  AppendFile(AppendFile&&) noexcept = default;
  AppendFile& operator=(AppendFile&&) noexcept = default;
  /// Hands over what is left and ignores failures: call `close` where they matter.
  ~AppendFile();

  /// Takes `text` into the buffer, which goes out when it is full.
  void write(std::string_view text);
  /// Hands the buffer to the operating system: other programs see it, a killed process does not lose it.
  void flush();
  /// Flushes, waits for the disk and closes. A second call does nothing.
  void close();
  [[nodiscard]] bool is_open() const { return file_.is_open(); }
  /// Bytes that were handed to the operating system.
  [[nodiscard]] std::uint64_t size() const { return size_; }

 private:
  std::filesystem::path path_;
  Descriptor file_;
  std::string buffer_;
  std::uint64_t size_ = 0;
};

}  // namespace udar

#include "udar/results/file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include "udar/base/error.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

const char* cure(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "; free space on the disk, or choose another folder with --output";
    case EACCES:
    case EPERM:
    case EROFS:
      return "; you may not write there: choose another folder with --output";
    case ENOENT:
    case ENOTDIR:
      return "; the folder does not exist or was removed";
    case EFBIG:
      return "; a file size limit is reached: raise it with `ulimit -f`, or write fields less often";
    case EMFILE:
    case ENFILE:
      return "; too many files are open: raise the limit with `ulimit -n`";
    case EIO:
      return "; the disk reports a fault: check it, or choose another folder with --output";
    case ELOOP:
      return "; it is a link, and links are not followed";
    default:
      return "";
  }
}

[[noreturn]] void fail(std::string_view action, const fs::path& path, int error) {
  const bool reads = action == "open" || action == "read";  // the cures are for what is written
  throw OutputError(fmt::format("cannot {} {}: {}{}", action, path.string(), std::generic_category().message(error),
                                reads ? "" : cure(error)));
}

/// Calls again while a signal interrupts.
template <class Call>
auto retry(Call call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

void write_all(int file, std::string_view bytes, const fs::path& path) {
  while (!bytes.empty()) {
    const ssize_t count = retry([&] { return ::write(file, bytes.data(), bytes.size()); });
    if (count < 0) fail("write", path, errno);
    if (count == 0) fail("write", path, EIO);  // never for a regular file; without this the loop would not end
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

void sync(int file, const fs::path& path) {
  // Devices, pipes and some network folders cannot be synced; nothing can be done about it, and nothing is wrong.
  if (retry([&] { return ::fsync(file); }) < 0 && errno != EINVAL && errno != ENOTSUP) fail("write", path, errno);
}

void close_checked(Descriptor& file, const fs::path& path) {
  // Linux releases the number even when close is interrupted: a second close could hit someone else's file.
  if (::close(file.release()) < 0 && errno != EINTR) fail("close", path, errno);
}

/// Opens a new file; one that a killed run left is removed.
Descriptor create(const fs::path& path) {
  ::unlink(path.c_str());
  const int flags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  Descriptor file(retry([&] { return ::open(path.c_str(), flags, 0666); }));
  if (!file.is_open()) fail("create", path, errno);
  return file;
}

}  // namespace

Descriptor::~Descriptor() {
  if (is_open()) ::close(number_);
}

FileReplacement::FileReplacement(fs::path path) : path_(std::move(path)), temporary_(path_) {
  struct stat found {};
  if (::lstat(path_.c_str(), &found) == 0 && !S_ISREG(found.st_mode)) {
    throw OutputError(
        fmt::format("cannot write {}: it is not a regular file; remove it, or choose another folder with "
                    "--output",
                    path_.string()));
  }
  temporary_ += ".tmp";
  file_ = create(temporary_);
}

FileReplacement::~FileReplacement() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void FileReplacement::write(std::string_view bytes) { write_all(file_.number(), bytes, temporary_); }

void FileReplacement::write(std::span<const std::string_view> pieces) {
  constexpr std::size_t most = 256;  // the system takes 1024 at once
  std::array<iovec, most> parts;
  while (!pieces.empty()) {
    const std::size_t count = std::min(most, pieces.size());
    for (std::size_t k = 0; k < count; ++k) {
      parts[k] = {const_cast<char*>(pieces[k].data()), pieces[k].size()};  // which writev only reads
    }
    const ssize_t written = retry([&] { return ::writev(file_.number(), parts.data(), static_cast<int>(count)); });
    if (written < 0) fail("write", temporary_, errno);
    // A part of it only where the disk is full or a signal came: the rest, piece by piece, tells which.
    auto done = static_cast<std::size_t>(written);
    for (const std::string_view piece : pieces.first(count)) {
      const std::size_t here = std::min(done, piece.size());
      done -= here;
      if (here < piece.size()) write(piece.substr(here));
    }
    pieces = pieces.subspan(count);
  }
}

void FileReplacement::commit_unsynced() {
  close_checked(file_, temporary_);
  if (::rename(temporary_.c_str(), path_.c_str()) < 0) fail("rename a file to", path_, errno);
  temporary_.clear();
}

void FileReplacement::commit() {
  sync(file_.number(), temporary_);
  commit_unsynced();
  const fs::path folder = path_.has_parent_path() ? path_.parent_path() : fs::path(".");
  const Descriptor names(retry([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); }));
  if (!names.is_open()) fail("open folder", folder, errno);
  sync(names.number(), folder);
}

void sync_files(const std::vector<fs::path>& files) {
  // A run may have thousands of histories. That many are cheaper with everything else that the disk has to write.
  constexpr std::size_t most_one_by_one = 200;
  for (const fs::path& path : files) {
    const Descriptor file(retry([&] { return ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC); }));
    if (!file.is_open()) fail("open", path, errno);
#ifdef __linux__
    if (files.size() > most_one_by_one) {
      if (retry([&] { return ::syncfs(file.number()); }) < 0) fail("write", path, errno);
      return;
    }
#endif
    sync(file.number(), path);
  }
}

void write_file(const fs::path& path, std::string_view bytes) {
  FileReplacement file(path);
  file.write(bytes);
  file.commit();
}

std::string read_file(const fs::path& path, std::size_t most_bytes) {
  // Not to wait for a pipe that nobody writes.
  const Descriptor file(retry([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); }));
  if (!file.is_open()) fail("open", path, errno);
  std::string bytes;
  constexpr std::size_t piece = std::size_t{1} << 18;
  for (;;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + piece);
    const ssize_t count = retry([&] { return ::read(file.number(), bytes.data() + before, piece); });
    if (count < 0) fail("read", path, errno);
    bytes.resize(before + static_cast<std::size_t>(count));
    if (bytes.size() > most_bytes) {
      throw OutputError(fmt::format("cannot read {}: it is larger than {} bytes", path.string(), most_bytes));
    }
    if (count == 0) return bytes;
  }
}

std::string read_beginning(const fs::path& path, std::size_t most) {
  const Descriptor file(retry([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); }));
  if (!file.is_open()) fail("open", path, errno);
  std::string bytes(most, '\0');
  for (std::size_t done = 0; done < most;) {
    const ssize_t count = retry([&] { return ::read(file.number(), bytes.data() + done, most - done); });
    if (count < 0 && errno == EAGAIN) {
      pollfd wait{file.number(), POLLIN, 0};
      retry([&] { return ::poll(&wait, 1, -1); });
      continue;
    }
    if (count < 0) fail("read", path, errno);
    if (count == 0) {
      bytes.resize(done);
      break;
    }
    done += static_cast<std::size_t>(count);
  }
  return bytes;
}

PartReader::PartReader(fs::path path) : path_(std::move(path)) {
  file_ = Descriptor(retry([&] { return ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); }));
  struct stat found {};
  if (!file_.is_open() || ::fstat(file_.number(), &found) < 0) fail("open", path_, errno);
  if (S_ISREG(found.st_mode)) size_ = static_cast<std::size_t>(found.st_size);
}

std::string PartReader::read(std::size_t at, std::size_t count) const {
  std::string bytes(at < size_ ? std::min(count, size_ - at) : 0, '\0');
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got = retry([&] {
      return ::pread(file_.number(), bytes.data() + done, bytes.size() - done, static_cast<off_t>(at + done));
    });
    if (got < 0) fail("read", path_, errno);
    if (got == 0) bytes.resize(done);  // it has become shorter
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

AppendFile::AppendFile(fs::path path) : path_(std::move(path)) {
  const int flags = O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_CLOEXEC;
  file_ = Descriptor(retry([&] { return ::open(path_.c_str(), flags, 0666); }));
  struct stat found {};
  if (!file_.is_open() || ::fstat(file_.number(), &found) < 0) fail("create", path_, errno);
  size_ = static_cast<std::uint64_t>(found.st_size);
}

AppendFile::AppendFile(fs::path path, std::uint64_t size) : path_(std::move(path)), size_(size) {
  file_ = Descriptor(retry([&] { return ::open(path_.c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_CLOEXEC); }));
  struct stat found {};
  if (!file_.is_open() || ::fstat(file_.number(), &found) < 0) fail("open", path_, errno);
  if (!S_ISREG(found.st_mode) || static_cast<std::uint64_t>(found.st_size) < size) {
    throw OutputError(
        fmt::format("cannot go on with {}: it is shorter than it was; it was changed since", path_.string()));
  }
  if (retry([&] { return ::ftruncate(file_.number(), static_cast<off_t>(size)); }) < 0) fail("shorten", path_, errno);
}

AppendFile::~AppendFile() {
  try {
    if (is_open()) flush();
  } catch (const OutputError&) {
    // Reached only while another error is on its way out, or where the owner did not care to close.
  }
}

void AppendFile::write(std::string_view text) {
  constexpr std::size_t largest_buffer = 65536;
  if (!is_open()) throw OutputError(fmt::format("cannot write {}: it is closed", path_.string()));
  buffer_ += text;
  if (buffer_.size() >= largest_buffer) flush();
}

void AppendFile::flush() {
  if (!is_open()) return;
  const std::string bytes = std::exchange(buffer_, {});
  try {
    write_all(file_.number(), bytes, path_);
    size_ += bytes.size();
  } catch (const OutputError&) {
    file_ = Descriptor();  // a hole in the middle of a history would be worse than its end
    throw;
  }
}

void AppendFile::close() {
  if (!is_open()) return;
  flush();
  sync(file_.number(), path_);
  close_checked(file_, path_);
}

}  // namespace udar

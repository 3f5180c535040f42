// The k-th call to the operating system fails, for every k. This program's own write, fsync, rename and close stand
// before those of the C library: no second library and no special run are needed.

#include <doctest/doctest.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/results/scratch.hpp"
#include "udar/results/file.hpp"

namespace {

struct Fault {
  int calls_left = -1;  // calls that still succeed; -1: no fault planned
  int error = 0;
  bool short_writes = false;

  bool strikes() { return calls_left >= 0 && calls_left-- == 0; }
};
thread_local Fault fault;

/// What was called, while someone listens: "fsync a.txt.tmp".
thread_local std::vector<std::string>* heard = nullptr;

void tell(long number, long a, long b) {
  if (heard == nullptr) return;
  std::vector<std::string>& list = *std::exchange(heard, nullptr);  // not what telling itself calls
  namespace fs = std::filesystem;
  const auto name = [](const fs::path& path) { return path.filename().string(); };
  if (number == SYS_rename) {
    list.push_back("rename " + name(reinterpret_cast<const char*>(a)) + " " + name(reinterpret_cast<const char*>(b)));
  } else {
    const fs::path file = fs::read_symlink("/proc/self/fd/" + std::to_string(a));
    list.push_back((number == SYS_fsync ? "fsync " : number == SYS_close ? "close " : "write ") + name(file));
  }
  heard = &list;
}

long call_or_fail(long number, long a, long b = 0, long c = 0) {
  tell(number, a, b);
  if (fault.strikes()) {
    if (number == SYS_close) ::syscall(SYS_close, a);
    errno = fault.error;
    return -1;
  }
  return ::syscall(number, a, b, c);
}

}  // namespace

extern "C" {
ssize_t writev(int file, const struct iovec* parts, int count) {
  if (fault.short_writes && count > 0) {
    const size_t most = parts[0].iov_len > 3 ? 3 : parts[0].iov_len;
    return call_or_fail(SYS_write, file, reinterpret_cast<long>(parts[0].iov_base), static_cast<long>(most));
  }
  return call_or_fail(SYS_writev, file, reinterpret_cast<long>(parts), count);
}
ssize_t write(int file, const void* bytes, size_t size) {
  const size_t asked = fault.short_writes && size > 3 ? 3 : size;
  return call_or_fail(SYS_write, file, reinterpret_cast<long>(bytes), static_cast<long>(asked));
}
int fsync(int file) { return static_cast<int>(call_or_fail(SYS_fsync, file)); }
int close(int file) { return static_cast<int>(call_or_fail(SYS_close, file)); }
int rename(const char* from, const char* to) noexcept {
  return static_cast<int>(call_or_fail(SYS_rename, reinterpret_cast<long>(from), reinterpret_cast<long>(to)));
}
}

using namespace udar;

namespace {

/// What `write_file` throws when call `k` of its calls fails with `error`; "" where it succeeds.
std::string failing_write(const std::filesystem::path& path, int k, int error) {
  fault = {.calls_left = k, .error = error};
  const std::string text = message_of<OutputError>([&] { write_file(path, "new content"); });
  fault = {};
  return text;
}

}  // namespace

TEST_CASE("whatever call fails, the file is old or new, and the failure is reported") {
  const Scratch folder;
  const std::filesystem::path path = folder / "a.txt";
  int failures = 0;
  for (int k = 0; k < 8; ++k) {
    write_file(path, "old content");
    const std::string text = failing_write(path, k, ENOSPC);
    const std::string found = read_file(path, 100);
    CAPTURE(k);
    CHECK_FALSE(std::filesystem::exists(folder / "a.txt.tmp"));
    if (!text.empty()) {
      ++failures;
      CHECK(contains(text, "No space left on device; free space"));
      CHECK((found == "old content" || k >= 4));  // write, fsync, close, rename; then fsync of the folder
    } else {
      CHECK(found == "new content");
    }
  }
  CHECK(failures == 5);
}

TEST_CASE("bytes are on the disk before the name, and the name before the writer returns") {
  const Scratch folder;
  std::filesystem::create_directory(folder / "inner");
  std::vector<std::string> calls;
  heard = &calls;
  write_file(folder / "inner/a.txt", "content");
  heard = nullptr;
  CHECK(calls == std::vector<std::string>{"write a.txt.tmp", "fsync a.txt.tmp", "close a.txt.tmp",
                                          "rename a.txt.tmp a.txt", "fsync inner", "close inner"});
}

TEST_CASE("a file made in pieces is there when it is whole, or never") {
  const Scratch folder;
  const std::filesystem::path path = folder / "a.txt";
  write_file(path, "old content");
  {
    FileReplacement file(path);
    file.write("size: 7 ");
    file.write("content");
    CHECK(read_file(path, 100) == "old content");
    file.commit();
    CHECK(read_file(path, 100) == "size: 7 content");
  }
  {
    FileReplacement given_up(path);
    given_up.write("half of");
  }
  CHECK(read_file(path, 100) == "size: 7 content");
  CHECK_FALSE(std::filesystem::exists(folder / "a.txt.tmp"));
}

/// What pieces written at once, and put in their place without waiting for the disk, throw when call `k` fails.
std::string failing_pieces(const std::filesystem::path& path, int k, int error) {
  constexpr std::array<std::string_view, 4> pieces{"pieces ", "", "of a ", "frame"};
  fault = {.calls_left = k, .error = error};
  const std::string text = message_of<OutputError>([&] {
    FileReplacement file(path);
    file.write(pieces);
    file.commit_unsynced();
  });
  fault = {};
  return text;
}

TEST_CASE("pieces are written at once, all or none of them") {
  const Scratch folder;
  for (int k = 0; k < 3; ++k) {  // write, close, rename
    CHECK(contains(failing_pieces(folder / "a.txt", k, ENOSPC), "No space left"));
    CHECK_FALSE(std::filesystem::exists(folder / "a.txt"));
    CHECK_FALSE(std::filesystem::exists(folder / "a.txt.tmp"));
  }
  CHECK(failing_pieces(folder / "a.txt", 3, EIO) == "");  // nothing is left that could fail
  CHECK(read_file(folder / "a.txt", 100) == "pieces of a frame");
  CHECK(failing_pieces(folder / "b.txt", 0, EINTR) == "");
  CHECK(read_file(folder / "b.txt", 100) == "pieces of a frame");
  fault = {.short_writes = true};
  {
    std::vector<std::string_view> many(700, "0123456789");
    FileReplacement file(folder / "d.txt");
    file.write(many);
    file.commit_unsynced();
  }
  fault = {};
  CHECK(read_file(folder / "d.txt", 10000).size() == 7000);
}

TEST_CASE("an interrupted call and short writes lose nothing") {
  const Scratch folder;
  for (int k = 0; k < 6; ++k) {
    if (k == 3) continue;  // rename is never interrupted
    CHECK(failing_write(folder / "a.txt", k, EINTR) == "");
    CHECK(read_file(folder / "a.txt", 100) == "new content");
  }
  fault = {.short_writes = true};
  write_file(folder / "b.txt", "in pieces of three");
  fault = {};
  CHECK(read_file(folder / "b.txt", 100) == "in pieces of three");
}

TEST_CASE("a history that cannot be closed says so") {
  const Scratch folder;
  for (int k = 0; k < 3; ++k) {  // write, fsync, close
    AppendFile file(folder / "log.txt");
    file.write("text");
    fault = {.calls_left = k, .error = EIO};
    const std::string text = message_of<OutputError>([&] { file.close(); });
    fault = {};
    CHECK(contains(text, "the disk reports a fault"));
  }
}

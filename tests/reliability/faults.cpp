// Stands before the file calls of the C library (LD_PRELOAD) and lets one of them fail, or kills the program in it.
//
//   UDAR_FAULT=k:error     call number k, from 1, of all that change files fails: EIO, ENOSPC, ... by number
//   UDAR_FAULT=k:before    the program is killed (SIGKILL) in front of it; a write gets half of its bytes out first
//   UDAR_FAULT=k:after     ... behind it
//   UDAR_FAULT_COUNT=file  how many calls there were, written when the program ends
//
// Counted are open for writing, write, writev, fsync, syncfs, ftruncate, rename, mkdir, unlink, and close of files that
// were opened for writing; standard output is none of them.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

enum class Action { none, fail, kill_before, kill_after };

struct Plan {
  long call = 0;
  Action action = Action::none;
  int error = 0;

  Plan() {
    const char* text = std::getenv("UDAR_FAULT");
    if (text == nullptr) return;
    char* rest = nullptr;
    call = std::strtol(text, &rest, 10);
    if (*rest == ':') ++rest;
    if (std::strcmp(rest, "before") == 0) {
      action = Action::kill_before;
    } else if (std::strcmp(rest, "after") == 0) {
      action = Action::kill_after;
    } else {
      action = Action::fail;
      error = std::atoi(rest);
    }
  }
};

std::atomic<long> calls{0};
std::array<std::atomic<bool>, 4096> written{};  // by number of the file

bool is_written(int file) { return file > 2 && file < static_cast<int>(written.size()) && written[file]; }

void die() {
  ::kill(::getpid(), SIGKILL);
  for (;;) ::pause();
}

/// Does `call`, or what is planned instead of it. `half` comes before a kill.
template <class Call, class Half>
long strike(Call call, Half half) {
  static const Plan plan;
  if (++calls != plan.call) return call();
  switch (plan.action) {
    case Action::fail:
      errno = plan.error;
      return -1;
    case Action::kill_before:
      half();
      die();
      return -1;
    case Action::kill_after: {
      call();
      die();
      return -1;
    }
    case Action::none:
      break;
  }
  return call();
}

template <class Call>
long strike(Call call) {
  return strike(call, [] {});
}

struct Report {
  ~Report() {
    const char* path = std::getenv("UDAR_FAULT_COUNT");
    if (path == nullptr) return;
    std::FILE* file = std::fopen(path, "w");
    if (file == nullptr) return;
    std::fprintf(file, "%ld\n", calls.load());
    std::fclose(file);
  }
} report;

int open_it(int folder, const char* path, int flags, unsigned mode) {
  const auto call = [&] { return ::syscall(SYS_openat, folder, path, flags, mode); };
  const bool writes = (flags & O_ACCMODE) != O_RDONLY;
  const long file = writes ? strike(call) : call();
  if (file >= 0 && file < static_cast<long>(written.size())) written[file] = writes;
  return static_cast<int>(file);
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  std::va_list rest;
  va_start(rest, flags);
  const unsigned mode = (flags & O_CREAT) != 0 ? va_arg(rest, unsigned) : 0;
  va_end(rest);
  return open_it(AT_FDCWD, path, flags, mode);
}
int open64(const char* path, int flags, ...) __attribute__((alias("open")));

ssize_t write(int file, const void* bytes, size_t size) {
  const auto call = [&](size_t count) { return ::syscall(SYS_write, file, bytes, count); };
  if (!is_written(file)) return call(size);
  return strike([&] { return call(size); }, [&] { call(size / 2); });
}
ssize_t writev(int file, const struct iovec* parts, int count) {
  const auto call = [&](int some) { return ::syscall(SYS_writev, file, parts, some); };
  if (!is_written(file)) return call(count);
  return strike([&] { return call(count); },
                [&] { ::syscall(SYS_write, file, parts[0].iov_base, parts[0].iov_len / 2); });
}
int fsync(int file) {
  return static_cast<int>(strike([&] { return ::syscall(SYS_fsync, file); }));
}
int syncfs(int file) {
  return static_cast<int>(strike([&] { return ::syscall(SYS_syncfs, file); }));
}
int ftruncate(int file, off_t size) {
  return static_cast<int>(strike([&] { return ::syscall(SYS_ftruncate, file, size); }));
}
int ftruncate64(int file, off_t size) __attribute__((alias("ftruncate")));
int rename(const char* from, const char* to) {
  return static_cast<int>(strike([&] { return ::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0); }));
}
int mkdir(const char* path, mode_t mode) {
  return static_cast<int>(strike([&] { return ::syscall(SYS_mkdirat, AT_FDCWD, path, mode); }));
}
int unlink(const char* path) {
  return static_cast<int>(strike([&] { return ::syscall(SYS_unlinkat, AT_FDCWD, path, 0); }));
}
int remove(const char* path) { return unlink(path); }  // never called for a folder
int close(int file) {
  const bool counts = is_written(file);
  if (counts) written[file] = false;
  const auto call = [&] { return ::syscall(SYS_close, file); };
  if (!counts) return static_cast<int>(call());
  const long result = strike(call);
  if (result < 0) call();  // the number is released all the same
  return static_cast<int>(result);
}
}

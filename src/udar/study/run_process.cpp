#include "udar/study/run_process.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>
#include <utility>

#include "udar/base/error.hpp"

namespace udar {
namespace {

constexpr const char* this_program = "/proc/self/exe";

}  // namespace

RunProcess::RunProcess(const std::vector<std::string>& words, const std::filesystem::path& output) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW,
                                   0666);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  std::vector<std::string> all{"udar"};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> list;
  for (std::string& word : all) list.push_back(word.data());
  list.push_back(nullptr);
  const int error = ::posix_spawn(&pid_, this_program, &files, nullptr, list.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error == 0) return;
  pid_ = -1;
  throw OutputError(fmt::format("cannot start a run that writes {}: {}", output.string(), std::strerror(error)));
}

RunProcess::RunProcess(RunProcess&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}

RunProcess& RunProcess::operator=(RunProcess&& other) noexcept {
  std::swap(pid_, other.pid_);
  return *this;
}

RunProcess::~RunProcess() {
  if (pid_ < 0) return;
  interrupt();
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

std::optional<int> RunProcess::ended() {
  int status = 0;
  const pid_t found = ::waitpid(pid_, &status, WNOHANG);
  if (found == 0 || (found < 0 && errno == EINTR)) return std::nullopt;
  pid_ = -1;
  if (found < 0) return 1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void RunProcess::interrupt() const {
  if (pid_ > 0) ::kill(pid_, SIGINT);
}

// The lock belongs to the open file, which the processes that are started inherit: it is let go when all have ended,
// also where this one was killed.
StudyLock::StudyLock(const std::filesystem::path& file)
    : file_(::open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW, 0666)) {  // NOLINT(cppcoreguidelines-pro-type-vararg)
  if (!file_.is_open()) {
    throw OutputError(fmt::format("cannot write {}: {}", file.string(), std::strerror(errno)));
  }
  if (::flock(file_.number(), LOCK_EX | LOCK_NB) != 0) {
    throw UserError(
        ExitCode::usage,
        fmt::format("another udar works in `{}`, or runs that it began still go on", file.parent_path().string()),
        "wait for them, or choose another folder with `--output`");
  }
  constexpr std::string_view words = "This folder was made by udar: a study of many runs.\n";
  if (::lseek(file_.number(), 0, SEEK_END) == 0 &&
      ::write(file_.number(), words.data(), words.size()) != static_cast<ssize_t>(words.size())) {
    throw OutputError(fmt::format("cannot write {}: {}", file.string(), std::strerror(errno)));
  }
}

}  // namespace udar

#include "udar/results/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>

#include <cerrno>
#include <cstring>

#include "udar/base/error.hpp"

namespace udar {

FolderLock::FolderLock(const std::filesystem::path& folder)
    : folder_(
          ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {  // NOLINT(cppcoreguidelines-pro-type-vararg)
  if (!folder_.is_open()) {
    throw OutputError(fmt::format("cannot open folder {}: {}", folder.string(), std::strerror(errno)));
  }
  if (::flock(folder_.number(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  throw UserError(ExitCode::usage, fmt::format("a run that is under way writes to `{}`", folder.string()),
                  "wait for its end or stop it with Ctrl-C, or choose another folder");
}

}  // namespace udar

#include "udar/report/program.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <deque>

#include "udar/base/error.hpp"

namespace udar {
namespace {

[[noreturn]] void missing(const Program& program) {
  throw OutputError(fmt::format("the program `{}` is not installed\n  = install the Debian package {}, or {}",
                                program.words[0], program.package, program.cure));
}

[[noreturn]] void cannot_start(const std::string& name, int error) {
  throw OutputError(fmt::format("cannot start `{}`: {}", name, std::strerror(error)));
}

struct Pipe {
  Descriptor from;
  Descriptor to;
};

Pipe make_pipe(const std::string& name) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) cannot_start(name, errno);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

/// A way to the program: a socket, since writing to a pipe that nobody reads ends the whole process by a signal unless
/// that is ignored everywhere.
Pipe make_input(const std::string& name) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) cannot_start(name, errno);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

void never_wait(const Descriptor& end) { ::fcntl(end.number(), F_SETFL, ::fcntl(end.number(), F_GETFL) | O_NONBLOCK); }

/// Starts a program with these pipes as standard input, output and error.
pid_t spawn(const Program& program, const Descriptor& in, const Descriptor& out, const Descriptor& err, int& error) {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&files, in.number(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, out.number(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, err.number(), STDERR_FILENO);
  // Udar passes some signals over; other programs are not made for that.
  sigset_t usual;
  sigfillset(&usual);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  std::vector<std::string> words = program.words;
  std::vector<char*> list;
  list.reserve(words.size() + 1);
  for (std::string& word : words) list.push_back(word.data());
  list.push_back(nullptr);
  pid_t pid = -1;
  error = ::posix_spawnp(&pid, list[0], &files, &attributes, list.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return error == 0 ? pid : -1;
}

/// The last line that is not empty.
std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' ')) text.pop_back();
  const std::size_t begin = text.rfind('\n');
  return begin == std::string::npos ? text : text.substr(begin + 1);
}

}  // namespace

bool is_installed(const Program& program) {
  const char* const path = std::getenv("PATH");
  std::string_view rest = path != nullptr ? path : "/usr/bin:/bin";
  while (!rest.empty()) {
    const std::size_t end = rest.find(':');
    const std::string file = std::string(rest.substr(0, end)) + "/" + program.words[0];
    if (::access(file.c_str(), X_OK) == 0) return true;
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  }
  return false;
}

void require(const Program& program) {
  if (!is_installed(program)) missing(program);
}

Child::Child(const Program& program) : name_(program.words[0]) {
  Pipe in = make_input(name_);
  Pipe out = make_pipe(name_);
  Pipe err = make_pipe(name_);
  int error = 0;
  pid_ = spawn(program, in.from, out.to, err.to, error);
  if (error == ENOENT) missing(program);
  if (error != 0) cannot_start(name_, error);
  in_ = std::move(in.to);
  out_ = std::move(out.from);
  err_ = std::move(err.from);
  for (const Descriptor* end : {&in_, &out_, &err_}) never_wait(*end);
}

Child::Child(Child&& other) noexcept
    : name_(std::move(other.name_)),
      pid_(std::exchange(other.pid_, -1)),
      in_(std::move(other.in_)),
      out_(std::move(other.out_)),
      err_(std::move(other.err_)),
      input_(std::move(other.input_)),
      given_(other.given_),
      ends_(other.ends_),
      output_(std::move(other.output_)),
      complaint_(std::move(other.complaint_)) {}

Child::~Child() {
  if (pid_ < 0) return;
  ::kill(pid_, SIGKILL);
  reap();
}

void Child::give(std::string bytes) {
  if (is_fed()) {
    input_ = std::move(bytes);
    given_ = 0;
  } else {
    input_ += bytes;
  }
}

void Child::end_input() { ends_ = true; }

void Child::add_to(std::vector<pollfd>& waits) const {
  if (in_.is_open() && (!is_fed() || ends_)) waits.push_back({in_.number(), POLLOUT, 0});
  if (out_.is_open()) waits.push_back({out_.number(), POLLIN, 0});
  if (err_.is_open()) waits.push_back({err_.number(), POLLIN, 0});
}

void Child::feed() {
  while (in_.is_open() && !is_fed()) {
    const ssize_t count = ::send(in_.number(), input_.data() + given_, input_.size() - given_, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) return;
    if (count < 0) {  // it has ended, and will tell why
      in_ = Descriptor();
      given_ = input_.size();
      return;
    }
    given_ += static_cast<std::size_t>(count);
  }
  if (ends_) in_ = Descriptor();
}

void Child::read(Descriptor& from, std::string& to) {
  std::array<char, 65536> piece{};
  while (from.is_open()) {
    const ssize_t count = ::read(from.number(), piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) return;
    if (count <= 0) {
      from = Descriptor();
      return;
    }
    to.append(piece.data(), static_cast<std::size_t>(count));
  }
}

void Child::serve() {
  feed();
  read(out_, output_);
  read(err_, complaint_);
}

int Child::reap() {
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return status;
}

std::string Child::finish() {
  const int status = reap();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return std::move(output_);
  const std::string words = last_line(complaint_);
  throw OutputError(fmt::format("`{}` failed: {}", name_, words.empty() ? "it does not say why" : words));
}

void serve_until(const std::vector<Child*>& children, const std::function<bool()>& done,
                 const std::function<bool()>& interrupted) {
  constexpr int look_every = 200;  // ms, at a signal that came before poll began to wait
  while (!done()) {
    if (interrupted()) throw Interrupted();
    std::vector<pollfd> waits;
    for (const Child* child : children) child->add_to(waits);
    ::poll(waits.data(), waits.size(), look_every);
    for (Child* child : children) child->serve();
  }
}

std::string run_program(const Program& program, std::string input) {
  Child child(program);
  child.give(std::move(input));
  child.end_input();
  serve_until(
      {&child}, [&] { return child.is_silent(); }, [] { return false; });
  return child.finish();
}

void run_programs(const Program& program, std::size_t count, std::size_t at_once,
                  const std::function<std::string(std::size_t)>& input,
                  const std::function<void(std::size_t, std::string)>& take, const std::function<bool()>& interrupted) {
  std::deque<Child> running;
  for (std::size_t begun = 0, taken = 0; taken < count; ++taken) {
    while (begun < count && running.size() < std::max<std::size_t>(at_once, 1)) {
      if (interrupted()) throw Interrupted();
      Child& child = running.emplace_back(program);
      child.give(input(begun++));
      child.end_input();
      child.serve();
    }
    std::vector<Child*> all;
    for (Child& child : running) all.push_back(&child);
    serve_until(
        all, [&] { return running.front().is_silent(); }, interrupted);
    std::string output = running.front().finish();
    running.pop_front();
    take(taken, std::move(output));
  }
}

}  // namespace udar

#pragma once

#include <poll.h>
#include <sys/types.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "udar/results/file.hpp"

namespace udar {

/// Another program that turns bytes into bytes. It is started with these words, without a shell.
struct Program {
  std::vector<std::string> words;  ///< its name, looked for along PATH, and its arguments
  std::string package;             ///< the Debian package that has it
  std::string cure;                ///< what can be done without it
};

/// Is it to be found along PATH?
bool is_installed(const Program& program);
/// Throws OutputError, with the package and the cure, where it is not to be found.
void require(const Program& program);

/// The user stopped what went on.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// A program that was started, with its standard input and output as pipes. It is ended with this object if it did not
/// end before. Signals of the terminal do not reach it: whoever started it says when it ends.
class Child {
 public:
  /// Throws OutputError where it cannot be started.
  explicit Child(const Program& program);
  Child(Child&& other) noexcept;
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  Child& operator=(Child&&) = delete;
  ~Child();

  /// Bytes for its standard input, after those given before.
  void give(std::string bytes);
  /// No more will come.
  void end_input();
  /// Is there input that it has not taken yet?
  [[nodiscard]] bool is_fed() const { return given_ == input_.size(); }
  /// What to wait for: pipes that can be read or written.
  void add_to(std::vector<pollfd>& waits) const;
  /// Reads and writes as much as goes without waiting.
  void serve();
  /// It has closed its output.
  [[nodiscard]] bool is_silent() const { return !out_.is_open() && !err_.is_open(); }
  /// Waits for its end and takes what it wrote. Throws OutputError with its last words where it failed.
  std::string finish();

 private:
  void feed();
  /// Appends what there is to read; closes the pipe at its end.
  static void read(Descriptor& from, std::string& to);
  /// Waits for its end; how it ended, as waitpid tells it.
  int reap();

  std::string name_;
  pid_t pid_ = -1;
  Descriptor in_;
  Descriptor out_;
  Descriptor err_;
  std::string input_;
  std::size_t given_ = 0;
  bool ends_ = false;
  std::string output_;
  std::string complaint_;
};

/// Serves the programs until `done()`; throws Interrupted once `interrupted()`.
void serve_until(const std::vector<Child*>& children, const std::function<bool()>& done,
                 const std::function<bool()>& interrupted);

/// Runs a program on `input` and returns what it writes. Throws OutputError.
std::string run_program(const Program& program, std::string input);

/// Runs a program `count` times, `at_once` at a time: run k works on input(k), and take(k, output) gets what it wrote,
/// in the order of k. Throws OutputError, or Interrupted once `interrupted()`.
void run_programs(const Program& program, std::size_t count, std::size_t at_once,
                  const std::function<std::string(std::size_t)>& input,
                  const std::function<void(std::size_t, std::string)>& take, const std::function<bool()>& interrupted);

}  // namespace udar

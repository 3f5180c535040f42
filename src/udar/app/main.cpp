#include <malloc.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

#include "udar/app/command_line.hpp"
#include "udar/app/terminal.hpp"
#include "udar/base/error.hpp"

namespace {

using namespace udar;

ExitCode run_program(int count, char** words) {
  CommandLine line;
  const Reading reading = line.read({words + std::min(count, 1), words + count});
  if (reading.command == nullptr) {
    say_text(reading.answer);
    complain("{}", reading.mistake);
    return reading.mistake.empty() ? ExitCode::done : ExitCode::usage;
  }
  try {
    return reading.command->run();
  } catch (const UserError& error) {
    const auto count_of_errors = static_cast<long long>(error.diagnostics.size());
    complain("{}{}; nothing was {}\n", error.what(), counted(count_of_errors, "error"), reading.command->undone);
    return error.code;
  }
}

/// Runs the program and tells what it throws.
ExitCode run_and_tell(int count, char** words) {
  try {
    return run_program(count, words);
  } catch (const OutputError& error) {
    complain("error: {}\n", error.what());
    return ExitCode::output;
  } catch (const NumericalError& error) {
    complain("error: {}\n", error.what());
    return ExitCode::numerical;
  } catch (const std::bad_alloc&) {
    complain("error: not enough memory for this case\n  = take larger elements\n");
    return ExitCode::resources;
  } catch (const std::length_error&) {
    complain("error: this case is too large for any memory\n  = take larger elements\n");
    return ExitCode::resources;
  } catch (const std::exception& error) {
    complain("internal error: {}\n  = this is a bug of Udar; please report it with the case\n", error.what());
    return ExitCode::internal;
  }
}

}  // namespace

int main(int count, char** words) {
#ifdef __GLIBC__
  // Large arrays of the set-up go back to the system when they are done with. By itself the library comes to keep what
  // is freed below 32 MB, and a run of 200 000 or of 3 million elements would hold a tenth more.
  ::mallopt(M_MMAP_THRESHOLD, 1 << 18);
#endif
  // A full disk or a closed pipe must come back as an error of write(), with a message, not kill the run.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  const ExitCode code = run_and_tell(count, words);
  const int refused = flush_terminal();
  // Whoever closes a pipe, as `head` does, has seen enough.
  if (refused == 0 || refused == EPIPE || code != ExitCode::done) return static_cast<int>(code);
  complain("error: cannot write to the standard output: {}\n", std::strerror(refused));
  return static_cast<int>(ExitCode::output);
}

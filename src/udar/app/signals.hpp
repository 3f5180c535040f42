#pragma once

#include "udar/base/error.hpp"

namespace udar {

/// From now on Ctrl-C, SIGTERM and the end of the terminal (SIGHUP) are noted instead of ending the program; a second
/// one, more than a second later, ends it at once.
void catch_signals();
/// Has one come?
bool is_interrupted();
/// The exit code for it.
ExitCode code_of_signal();

/// While it lives only new signals count, so that what is still made of an interrupted run does not stop at the old
/// one; at its end the old one counts again where none came.
class OnlyNewSignals {
 public:
  OnlyNewSignals();
  OnlyNewSignals(const OnlyNewSignals&) = delete;
  OnlyNewSignals& operator=(const OnlyNewSignals&) = delete;
  ~OnlyNewSignals();

 private:
  int before_;
};

}  // namespace udar

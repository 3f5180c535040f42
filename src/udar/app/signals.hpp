#pragma once

#include "udar/base/error.hpp"

namespace udar {

/// From now on Ctrl-C and SIGTERM are noted instead of ending the program; a second one, more than a second later, ends
/// it at once.
void catch_signals();
/// Has one come?
bool is_interrupted();
/// The exit code for it.
ExitCode code_of_signal();

}  // namespace udar

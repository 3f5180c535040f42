#pragma once

#include <string>

#include "udar/results/verification.hpp"

namespace udar {

/// "bar-on-wall       72 of 72 checks hold   2.1 s", a line.
std::string line_of(const VerifiedProblem& problem);

/// The problem with its checks, a line each, for a terminal.
std::string table_of(const VerifiedProblem& problem);

/// The checks that fail, with their problems; "" where all hold.
std::string failures_of(const Verification& verification);

}  // namespace udar

#pragma once

#include <string>

#include "udar/results/summary.hpp"

namespace udar {

/// Now, in UTC: "2025-07-01T12:34:56Z".
std::string now_text();

/// The processor and how many threads it runs at once.
MachineSummary this_machine();

}  // namespace udar

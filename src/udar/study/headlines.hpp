#pragma once

#include <string>
#include <vector>

#include "udar/results/study.hpp"

namespace udar {

/// Marks the numbers that are shown first and writes their lines. `asked`: names of numbers, or parts of them; empty:
/// contact times and restitution, dissipated energy, how far observed nodes went, plastic strain of observed elements.
/// A name that no number has becomes a warning of the study, with the one that may be meant: the runs are done.
void mark_headlines(Study& study, const std::vector<std::string>& asked);

/// "contact time of stop (to 99 % of the push) = 1.303 ms ± 0.012 ms (mesh) ± 0.002 ms (step)".
std::string headline_of(const StudyQuantity& quantity);

/// What a number of summary.json is, in words: "contact time of stop".
std::string words_of(const std::string& name);

}  // namespace udar

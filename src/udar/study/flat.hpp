#pragma once

#include <string>
#include <utility>
#include <vector>

namespace udar {

/// Values of a tree by their flat names, in its order: {"contacts.stop.impulse.y", "-6.1"}.
using FlatValues = std::vector<std::pair<std::string, std::string>>;

/// The values of summary.json as JSON text, without what depends on the machine. Lists of two numbers are vectors, .x
/// and .y; items of other lists have numbers, or their names. Throws OutputError where it is no JSON.
FlatValues flat_summary(const std::string& text);

/// The values of a case file; lists of plain values are one value. Empty where it cannot be read.
FlatValues flat_case(const std::string& text);

/// The first name whose value is not the same in both, "" where all are.
std::string first_difference(const FlatValues& a, const FlatValues& b);

}  // namespace udar

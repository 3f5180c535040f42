#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace udar {

/// The candidate most like `word` (optimal string alignment distance, at most a third of its length), or "".
std::string nearest_word(std::string_view word, std::span<const std::string> candidates);

/// "a, b or c".
std::string one_of(std::span<const std::string> words);

/// A word as a POSIX shell reads it back: quoted where that is needed.
std::string shell_word(std::string_view word);

/// Shortest decimal that reads back as the same double: "0.0025", "6.4e-08".
std::string shortest(double value);

/// A number with four digits and the prefix that suits it: "264 ns", "1.567 MN"; "-" where there is none.
std::string in_units(double value, std::string_view unit);

}  // namespace udar

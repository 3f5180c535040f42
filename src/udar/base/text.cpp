#include "udar/base/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace udar {
namespace {

std::size_t alignment_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + change});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearest_word(std::string_view word, std::span<const std::string> candidates) {
  constexpr std::size_t longest = 64;  // nothing longer is a misspelt key, and the distance costs length squared
  if (word.size() > longest) return "";
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > longest) continue;
    const std::size_t added = std::max(word.size(), candidate.size()) - std::min(word.size(), candidate.size());
    if (added >= best_distance) continue;
    const std::size_t distance = alignment_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string one_of(std::span<const std::string> words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) out += i + 1 == words.size() ? " or " : ", ";
    out += words[i];
  }
  return out;
}

std::string shell_word(std::string_view word) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return std::string(word);
  std::string out = "'";
  for (const char c : word) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      out += c;
    }
  }
  return out + "'";
}

std::string shortest(double value) { return fmt::format("{}", value); }

std::string in_units(double value, std::string_view unit) {
  constexpr std::string_view prefixes = "pnum kMGT";
  if (!std::isfinite(value)) return "-";
  if (value == 0) return fmt::format("0 {}", unit);
  // Four digits first: 999.96 is 1000, and that is 1 k.
  const double rounded = std::stod(fmt::format("{:.3e}", value));
  const int thousands = std::clamp(static_cast<int>(std::floor(std::log10(std::fabs(rounded)) / 3)), -4, 4);
  const int place = thousands + 4;
  const char prefix = prefixes[static_cast<std::size_t>(place)];
  return fmt::format("{:.4g} {}{}", value / std::pow(1000.0, thousands), prefix == ' ' ? "" : std::string(1, prefix),
                     unit);
}

}  // namespace udar

#include "udar/app/terminal.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>

namespace udar {
namespace {

int first_error = 0;

void note_error() {
  if (first_error == 0) first_error = errno;
}

}  // namespace

void say_text(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) < text.size()) note_error();
}

int flush_terminal() {
  if (std::fflush(stdout) != 0) note_error();
  if (first_error == 0 && std::ferror(stdout) != 0) first_error = EIO;
  return first_error;
}

void print_warnings(const std::vector<Diagnostic>& warnings) {
  constexpr std::size_t word = std::string_view("error").size();
  for (const Diagnostic& w : warnings) fmt::print(stderr, "warning{}", to_text(w).substr(word));
}

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

std::string counted(long long count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace udar

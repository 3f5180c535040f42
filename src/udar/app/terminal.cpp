#include "udar/app/terminal.hpp"

#include <cerrno>
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

std::string counted(long long count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace udar

#include "udar/app/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>

#include "udar/case/ascii.hpp"

namespace udar {
namespace {

int first_error = 0;

void note_error() {
  if (first_error == 0) first_error = errno;
}

/// Characters in a row of the terminal; a longer line would wrap and could not be rewritten.
std::size_t terminal_width() {
  winsize size{};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
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

void complain_text(std::string_view text) {
  std::string lines;
  for (;;) {
    const std::size_t end = text.find('\n');
    lines += printable(text.substr(0, end));
    if (end == std::string_view::npos) break;
    lines += '\n';
    text.remove_prefix(end + 1);
  }
  std::fwrite(lines.data(), 1, lines.size(), stderr);
}

void print_warnings(const std::vector<Diagnostic>& warnings) {
  constexpr std::size_t word = std::string_view("error").size();
  for (const Diagnostic& w : warnings) complain("warning{}", to_text(w).substr(word));
}

bool is_terminal() { return isatty(STDOUT_FILENO) == 1; }

void say_in_place(const std::string& line) {
  if (is_terminal()) {
    say("\r{}\x1b[K", line.substr(0, terminal_width() - 1));
  } else {
    say("{}\n", line);
  }
  flush_terminal();
}

std::string clock_text(double seconds) {
  constexpr double longest = 100 * 3600;
  if (!(seconds < longest)) return "> 99 h";
  const auto whole = std::llround(seconds);
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{:02}:{:02}", whole / 60, whole % 60);
}

std::string counted(long long count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace udar

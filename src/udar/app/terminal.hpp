#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>
#include <vector>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"

namespace udar {

/// Writes to the standard output. What it refuses (a full disk, a closed pipe) never stops a run; `flush_terminal`
/// tells of it.
void say_text(std::string_view text);

template <class... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
  say_text(fmt::format(format, std::forward<Values>(values)...));
}

/// The first error number of the standard output; 0: everything was written.
int flush_terminal();

/// Writes to the standard error, free of what a terminal could take as a command: names of files may hold anything.
void complain_text(std::string_view text);

template <class... Values>
void complain(fmt::format_string<Values...> format, Values&&... values) {
  complain_text(fmt::format(format, std::forward<Values>(values)...));
}

/// To the standard error, as mistakes are told.
void print_warnings(const std::vector<Diagnostic>& warnings);

/// Is the standard output a terminal?
bool is_terminal();
/// A line that on a terminal takes the place of the one before; elsewhere one more line.
void say_in_place(const std::string& line);
/// "02:05", "1:00:00".
std::string clock_text(double seconds);

/// "1 thread", "2 threads".
std::string counted(long long count, std::string_view what);

}  // namespace udar

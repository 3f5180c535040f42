#include "udar/simulation/machine.hpp"

#include <fmt/core.h>

#include <ctime>

#include "udar/base/error.hpp"
#include "udar/parallel/for_each.hpp"
#include "udar/results/file.hpp"

namespace udar {

std::string now_text() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday,
                     parts.tm_hour, parts.tm_min, parts.tm_sec);
}

MachineSummary this_machine() {
  MachineSummary machine{.processor = "", .threads = available_threads()};
  std::string text;
  try {
    text = read_file("/proc/cpuinfo", std::size_t{1} << 24);
  } catch (const OutputError&) {
    return machine;  // other systems have no such file
  }
  const std::size_t row = text.find("model name");
  const std::size_t colon = text.find(": ", row);
  if (row != std::string::npos && colon < text.find('\n', row)) {
    machine.processor = text.substr(colon + 2, text.find('\n', colon) - colon - 2);
  }
  return machine;
}

}  // namespace udar

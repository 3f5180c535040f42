#include "udar/base/memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace udar {
namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

/// What /proc/meminfo says is free for a new program, and free swap.
double memory_of_system() {
  std::ifstream file("/proc/meminfo");
  double sum = 0;
  bool known = false;
  std::string name;
  for (double kilobytes = 0; file >> name >> kilobytes;) {
    if (name == "MemAvailable:" || name == "SwapFree:") sum += 1024 * kilobytes;
    known = known || name == "MemAvailable:";
    file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return known ? sum : unknown;
}

/// What is left of the limit on addresses.
double memory_of_process() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unknown;
  double pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const double taken = pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - taken);
}

/// The limit of a container.
double memory_of_group() {
  double bytes = 0;
  std::ifstream file("/sys/fs/cgroup/memory.max");  // "max" where there is no limit
  return file >> bytes ? bytes : unknown;
}

}  // namespace

double memory_there() { return std::min({memory_of_system(), memory_of_process(), memory_of_group()}); }

}  // namespace udar

#include <fmt/core.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fuzz/target.hpp"

/// Gives a fuzz target every file of some folders, without libFuzzer, and measures the processor time of each.
/// usage: replay FOLDER...; exit status 1 where an input took longer than it may, or where there is none.
int main(int count, char** words) {
  namespace fs = std::filesystem;
  constexpr double longest = 1;  // s
  std::vector<fs::path> files;
  for (int k = 1; k < count; ++k) {
    for (const fs::directory_entry& entry : fs::directory_iterator(words[k])) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  int slow = 0;
  double slowest = 0;
  for (const fs::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    const std::clock_t begin = std::clock();
    // What crashes is the last file that was named.
    fmt::print("{}\n", file.filename().string());
    std::fflush(stdout);
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    const double spent = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    slowest = std::max(slowest, spent);
    if (spent <= longest) continue;
    ++slow;
    fmt::print("{} took {:.2f} s\n", file.string(), spent);
  }
  fmt::print("{} inputs, the slowest took {:.3f} s\n", files.size(), slowest);
  return slow == 0 && !files.empty() ? 0 : 1;
}

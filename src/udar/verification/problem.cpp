#include "udar/verification/problem.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <stdexcept>

#include "udar/case/case_file.hpp"

namespace udar::verification {
namespace {

std::string_view embedded(std::string_view name) {
  for (const EmbeddedFile& file : embedded_files()) {
    if (file.name == name) return file.text;
  }
  throw std::logic_error(fmt::format("the program carries no file {}", name));
}

/// Title and text of a page whose first line is "# id: title".
void read_page(Problem& problem) {
  const std::string_view page = embedded(problem.id + "/README.md");
  const std::size_t end = std::min(page.find('\n'), page.size());
  const std::string_view first = page.substr(0, end);
  const std::size_t colon = first.find(": ");
  problem.title = colon == first.npos ? problem.id : first.substr(colon + 2);
  problem.text = page.substr(std::min(page.find_first_not_of('\n', end), page.size()));
}

}  // namespace

std::string_view title_of(Topic topic) {
  constexpr std::array<std::string_view, 9> titles{
      "Waves",        "Vibration and bending", "Plastic flow", "Rotation and large shear", "Contact", "Friction",
      "Conservation", "Scheme and symmetry",   "Whole cases"};
  return titles.at(static_cast<std::size_t>(topic));
}

std::vector<Problem> all_problems() {
  std::vector<Problem> problems;
  for (const Registered& registered : registered_problems()) {
    problems.push_back(registered.make());
    problems.back().id = registered.id;
    read_page(problems.back());
  }
  std::stable_sort(problems.begin(), problems.end(),
                   [](const Problem& a, const Problem& b) { return a.topic < b.topic; });
  return problems;
}

Case load(const std::string& file, const std::vector<std::string>& changes) {
  return read_case(embedded(file), file, changes);
}

VerifiedPart run_part(const Part& part) {
  VerifiedPart result{.name = part.name, .is_long = part.is_long};
  const auto begin = std::chrono::steady_clock::now();
  try {
    Checks checks{result};
    part.check(checks);
    if (result.rows.empty()) checks.holds("checks something", false);
  } catch (const std::exception& error) {
    result.rows.push_back({.what = fmt::format("goes to its end ({})", error.what())});
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace udar::verification

#include <fmt/core.h>

#include <set>
#include <string>
#include <string_view>

#include "udar/case/reference.hpp"
#include "udar/units/unit_table.hpp"

/// Prints a dictionary for libFuzzer: the words of docs/case-file.md that stand in `...`, which are the keys of a case
/// file, their values and examples, and the names of units.
int main() {
  std::set<std::string> words;
  const std::string page = udar::case_file_reference();
  for (std::string_view rest = page; !rest.empty();) {
    const std::size_t open = rest.find('`');
    if (open == std::string_view::npos) break;
    const std::size_t close = rest.find('`', open + 1);
    if (close == std::string_view::npos) break;
    const std::string_view word = rest.substr(open + 1, close - open - 1);
    if (!word.empty() && word.size() <= 64 && word.find('\n') == std::string_view::npos) words.emplace(word);
    rest.remove_prefix(close + 1);
  }
  for (const std::string& unit : udar::unit_names()) {
    if (unit.size() <= 3) words.insert(unit);
  }
  for (const std::string& word : words) {
    std::string escaped;
    for (const char c : word) escaped += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    fmt::print("\"{}\"\n", escaped);
  }
}

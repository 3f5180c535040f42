#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/target.hpp"
#include "udar/case/reference.hpp"

/// Bytes changed at random hardly ever get beyond the TOML parser. This changes whole lines and values as well: three
/// of four times the text stays TOML.

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed);

namespace {

using Random = std::minstd_rand;
using Lines = std::vector<std::string>;

std::size_t below(Random& random, std::size_t count) { return count == 0 ? 0 : random() % count; }

Lines lines_of(std::string_view text) {
  Lines lines;
  for (;;) {
    const std::size_t end = text.find('\n');
    lines.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return lines;
    text.remove_prefix(end + 1);
  }
}

/// The examples of the documentation as "key = value", and headers of tables.
const Lines& known_lines() {
  static const Lines lines = [] {
    Lines out;
    for (const std::string& line : lines_of(udar::case_file_reference())) {
      if (line.starts_with("## `[")) {
        std::string header = line.substr(4, line.rfind('`') - 4);
        for (auto at = header.find("NAME"); at != std::string::npos; at = header.find("NAME"))
          header.replace(at, 4, "a");
        out.push_back(header);
      }
      if (!line.starts_with("| `")) continue;
      const std::string key = line.substr(3, line.find('`', 3) - 3);
      const std::size_t end = line.rfind("` |");
      const std::size_t begin = end == std::string::npos || end == 0 ? end : line.rfind('`', end - 1);
      if (begin != std::string::npos) out.push_back(key + " = " + line.substr(begin + 1, end - begin - 1));
    }
    for (const std::string& line : lines_of(udar::example_case())) out.push_back(line);
    return out;
  }();
  return lines;
}

constexpr std::array<std::string_view, 30> values{
    "0",           "-0.0",        "1e300",
    "-1",          "nan",         "inf",
    "\"0 m\"",     "\"-1 m\"",    "\"1e29 m\"",
    "\"1e-30 m\"", "\"1 s\"",     "\"1e-9 s\"",
    "\"0 Pa\"",    "\"1e12 Pa\"", "\"0 kg/m^3\"",
    "[]",          "{}",          "[[\"0 m\", \"0 m\"]]",
    "true",        "\"\"",        "\"none\"",
    "\"left\"",    "\"crossed\"", "[\"1 m\", \"1 m\"]",
    "[0, 1]",      "[0, 0]",      "\"beam\"",
    "\"a\"",       "\"1 cm\"",    "{ times = [\"0 s\", \"1 s\"], values = [\"0 m\", \"1 m\"] }"};

/// Another value behind the `=` of a line.
void change_value(std::string& line, Random& random) {
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos) return;
  std::string value = line.substr(equals + 1);
  switch (below(random, 3)) {
    case 0:
      value = std::string(values[below(random, values.size())]);
      break;
    case 1: {  // one of its quantities
      const std::size_t open = value.find('"', below(random, value.size()));
      const std::size_t close = open == std::string::npos ? open : value.find('"', open + 1);
      if (close == std::string::npos) return;
      value.replace(open, close - open + 1, values[below(random, values.size())]);
      break;
    }
    default: {
      std::array<std::uint8_t, 256> room{};
      const std::size_t size = std::min(value.size(), room.size());
      std::memcpy(room.data(), value.data(), size);
      value.assign(reinterpret_cast<const char*>(room.data()), LLVMFuzzerMutate(room.data(), size, room.size()));
    }
  }
  line = line.substr(0, equals + 1) + value;
}

void change_lines(Lines& lines, Random& random) {
  const std::size_t at = below(random, lines.size());
  const std::size_t other = below(random, lines.size());
  const auto place = [&](std::size_t k) { return lines.begin() + static_cast<std::ptrdiff_t>(k); };
  switch (below(random, 8)) {
    case 0:
      lines.erase(place(at));
      break;
    case 1: {
      const std::string copy = lines[at];
      lines.insert(place(other), copy);
      break;
    }
    case 2:
      std::swap(lines[at], lines[other]);
      break;
    case 3:
    case 4: {
      const Lines& known = known_lines();
      lines.insert(place(at), known[below(random, known.size())]);
      break;
    }
    default:
      change_value(lines[at], random);
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  Random random(seed);
  if (size == 0 || below(random, 4) == 0) return LLVMFuzzerMutate(data, size, most);
  Lines lines = lines_of(udar::fuzz::text_of(data, size));
  for (std::size_t k = 1 + below(random, 3); k > 0 && !lines.empty(); --k) change_lines(lines, random);
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  const std::size_t length = std::min(text.size(), most);
  std::memcpy(data, text.data(), length);
  return length;
}

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace udar {

/// Paths name a value of a case: "bodies.beam.mesh.element_size", "observe.nodes.0.at.1".

/// The parts between the dots.
inline std::vector<std::string_view> parts_of(std::string_view path) {
  std::vector<std::string_view> parts;
  while (true) {
    const auto dot = path.find('.');
    parts.push_back(path.substr(0, dot));
    if (dot == std::string_view::npos) return parts;
    path.remove_prefix(dot + 1);
  }
}

inline std::string join(std::string_view path, std::string_view part) {
  std::string out(path);
  if (!out.empty()) out += '.';
  return out += part;
}

/// The last part that is not the number of an item: what the user calls the key.
inline std::string key_of(std::string_view path) {
  std::string_view key = path;
  for (const std::string_view part : parts_of(path)) {
    if (part.find_first_not_of("0123456789") != std::string_view::npos) key = part;
  }
  return std::string(key);
}

}  // namespace udar

#include "udar/case/mistakes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace udar {
namespace {

constexpr std::size_t most_shown = 50;

std::string other_lines(const std::vector<Place>& others) {
  constexpr std::size_t most_listed = 5;
  std::vector<std::string> lines;
  for (const Place& place : others) {
    const std::string line = std::to_string(place.line);
    if (lines.empty() || lines.back() != line) lines.push_back(line);
  }
  if (lines.size() > most_listed) return fmt::format("and {} more like it", others.size());
  std::string listed;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    listed += (i == 0 ? "" : i + 1 == lines.size() ? " and " : ", ") + lines[i];
  }
  return fmt::format("and {} more like it on line{} {}", others.size(), lines.size() == 1 ? "" : "s", listed);
}

}  // namespace

void Mistakes::add(Mistake mistake) {
  touched_.insert(mistake.path);
  if (full()) {
    ++left_out_;
  } else {
    found_.push_back(std::move(mistake));
  }
}

void Mistakes::add_unless_touched(Mistake mistake) {
  if (!touched(mistake.path)) add(std::move(mistake));
}

bool Mistakes::touched(std::string_view path) const {
  if (touched_.empty()) return false;
  const std::string below = std::string(path) + ".";
  const auto next = touched_.lower_bound(below);
  if (next != touched_.end() && next->starts_with(below)) return true;
  while (true) {
    if (touched_.contains(path)) return true;
    const auto dot = path.rfind('.');
    if (dot == std::string_view::npos) return false;
    path = path.substr(0, dot);
  }
}

std::vector<Diagnostic> Mistakes::diagnostics(const Document* document) const {
  std::vector<Diagnostic> out;
  if (document == nullptr) {
    for (const Mistake& m : found_) {
      out.push_back({.message = fmt::format("{} (`{}`)", m.message, m.path), .pointer = m.pointer, .cure = m.cure});
    }
    return out;
  }

  std::vector<std::pair<Place, const Mistake*>> placed;
  for (const Mistake& m : found_) placed.emplace_back(m.place ? *m.place : document->place_of(m.path), &m);
  std::ranges::stable_sort(placed, {},
                           [](const auto& p) { return std::tuple(p.first.source, p.first.line, p.first.column); });

  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> groups;
  std::vector<std::vector<Place>> others;
  std::size_t hidden = left_out_;
  for (const auto& [place, m] : placed) {
    const auto [group, is_new] = groups.try_emplace({m->message, m->pointer, m->cure}, out.size());
    if (group->second >= most_shown) {
      ++hidden;
    } else if (is_new) {
      out.push_back(diagnostic_at(document->sources, place, m->message, m->pointer, m->cure));
      others.emplace_back();
    } else {
      others[group->second].push_back(place);
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (others[i].empty()) continue;
    const std::string rest = other_lines(others[i]);
    out[i].cure = out[i].cure.empty() ? rest : fmt::format("{} ({})", out[i].cure, rest);
  }
  if (hidden > 0)
    out.push_back({.file = document->sources[0].name, .message = fmt::format("and {} more mistakes", hidden)});
  return out;
}

}  // namespace udar

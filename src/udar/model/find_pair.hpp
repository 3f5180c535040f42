#pragma once

#include <algorithm>
#include <utility>

#include "udar/mesh/mesh.hpp"

namespace udar {

/// Two bodies, or a body twice, the one that comes first in the case in front.
using BodyNumbers = std::pair<Index, Index>;

inline BodyNumbers in_order(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// The bodies of an entry of a list by pairs.
template <class Entry>
BodyNumbers bodies_of(const Entry& entry) {
  return {entry.first, entry.second};
}

/// The first entry that is not before the pair, in a list in the order of first, then second body. Lists of the few
/// pairs that matter stand in for tables of all, which would grow with the square of the number of bodies.
template <class Iterator>
Iterator find_pair(Iterator begin, Iterator end, BodyNumbers pair) {
  return std::lower_bound(begin, end, pair,
                          [](const auto& entry, const BodyNumbers& wanted) { return bodies_of(entry) < wanted; });
}

/// The entry of a pair, or nullptr where it has none.
template <class Entries>
auto entry_of(Entries& entries, BodyNumbers pair) -> decltype(entries.data()) {
  const auto found = find_pair(entries.begin(), entries.end(), pair);
  return found != entries.end() && bodies_of(*found) == pair ? &*found : nullptr;
}

}  // namespace udar

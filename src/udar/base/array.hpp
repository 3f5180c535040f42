#pragma once

#include <cstddef>
#include <vector>

namespace udar {

/// Memory that begins on a cache line; from a few megabytes on it asks the system for large pages, of which a loop over
/// all arrays needs far fewer. Throws std::bad_alloc.
void* allocate_lines(std::size_t bytes);
void free_lines(void* memory);

/// Memory for the arrays of the hot loops: begins on a cache line, so that no vector of eight doubles lies across two.
/// Where two arrays began at any two addresses, reads and writes would; measured: 9 % of the speed.
template <class T>
struct CacheLineAllocator {
  using value_type = T;

  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}

  T* allocate(std::size_t count) { return static_cast<T*>(allocate_lines(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t) { free_lines(memory); }

  template <class U>
  bool operator==(const CacheLineAllocator<U>&) const {
    return true;
  }
};

/// A vector that begins on a cache line.
template <class T>
using Array = std::vector<T, CacheLineAllocator<T>>;

}  // namespace udar

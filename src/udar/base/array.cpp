#include "udar/base/array.hpp"

#include <cstdlib>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace udar {

void* allocate_lines(std::size_t bytes) {
  constexpr std::size_t line = 64;
  constexpr std::size_t large_page = std::size_t{1} << 21;
  const bool large = bytes >= 2 * large_page;
  const std::size_t unit = large ? large_page : line;
  const std::size_t whole = (bytes + unit - 1) / unit * unit;
  void* memory = std::aligned_alloc(unit, whole);
  if (memory == nullptr) throw std::bad_alloc();
#if defined(__linux__)
  if (large) madvise(memory, whole, MADV_HUGEPAGE);  // only a wish
#endif
  return memory;
}

// The allocator's own counterpart of std::aligned_alloc.
void free_lines(void* memory) { std::free(memory); }  // NOLINT(cppcoreguidelines-no-malloc)

}  // namespace udar

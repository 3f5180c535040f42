#include "udar/report/report.hpp"

#ifdef UDAR_VIEWER_PAGE
// The file as it is: compilers take long for a literal of this size, and clang warns of it.
asm(".section .rodata\n"
    ".global udar_viewer_begin\n"
    "udar_viewer_begin:\n"
    ".incbin \"" UDAR_VIEWER_PAGE
    "\"\n"
    ".global udar_viewer_end\n"
    "udar_viewer_end:\n"
    ".byte 0\n"
    ".previous\n");
extern "C" {
extern const char udar_viewer_begin[];
extern const char udar_viewer_end[];
}

namespace udar {

std::string_view viewer_page() {
  return {udar_viewer_begin, static_cast<std::size_t>(udar_viewer_end - udar_viewer_begin)};
}

}  // namespace udar
#else
namespace udar {

std::string_view viewer_page() { return {}; }

}  // namespace udar
#endif

#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

/// What every fuzz target defines: libFuzzer calls it with one input after another, and so does replay.cpp with the
/// files of the corpus. It must return 0, never crash, and take less than a second for 1 MiB.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace udar::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A promise of the program that no input may break. An assert would not be there in a release build.
inline void require(bool kept) {
  if (!kept) std::abort();
}

/// Text that may go to a terminal: lines without control characters.
inline bool is_harmless(std::string_view text) {
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\n') || byte == 0x7f) return false;
  }
  return true;
}

}  // namespace udar::fuzz

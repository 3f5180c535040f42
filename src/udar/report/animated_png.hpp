#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "udar/results/file.hpp"

namespace udar {

/// An animated PNG that plays for ever (APNG 1.0, part of the third edition of the PNG specification), put together of
/// PNG images of one size and kind without packing them anew. All or nothing, as FileReplacement does.
class AnimatedPng {
 public:
  AnimatedPng(const std::filesystem::path& path, std::size_t frames, double frames_per_second);
  /// Adds a frame. Throws OutputError where it is no PNG, not like the first one, or cannot be written.
  void add(std::string_view png);
  /// After the last frame.
  void commit();

 private:
  FileReplacement file_;
  std::size_t frames_;
  std::uint16_t delay_;     ///< ms
  std::string head_;        ///< IHDR of the first frame
  std::uint32_t next_ = 0;  ///< number of the next piece of the animation
};

}  // namespace udar

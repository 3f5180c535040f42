#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace udar {

/// Dots, row by row from the top, each with the number of its colour; 0 is nothing.
struct DotImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint8_t> dots;
};

/// The image as a PNG file. Dot k has colour k - 1 of `colours`, each "#rrggbb"; there may be 255.
std::string to_png(const DotImage& image, std::span<const std::string_view> colours);

/// Four bytes, the highest first, as PNG has all its numbers.
void append_big_endian(std::string& out, std::size_t value);
/// A piece of a PNG file: its length, kind, data and checksum.
void append_png_chunk(std::string& out, std::string_view kind, std::string_view data);
inline constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n";

/// Bytes as text, as data: addresses have them (RFC 4648).
std::string to_base64(std::string_view bytes);

}  // namespace udar

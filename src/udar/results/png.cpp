#include "udar/results/png.hpp"

#include <zlib.h>

#include <array>
#include <charconv>
#include <new>

namespace udar {
namespace {

std::string palette(std::span<const std::string_view> colours) {
  std::string bytes(3, '\0');
  for (const std::string_view colour : colours) {
    for (std::size_t k = 1; k < 7; k += 2) {
      std::uint8_t value = 0;
      std::from_chars(colour.data() + k, colour.data() + k + 2, value, 16);
      bytes += static_cast<char>(value);
    }
  }
  return bytes;
}

std::string compressed(const std::string& bytes) {
  uLongf size = ::compressBound(bytes.size());
  std::string out(size, '\0');
  const auto* source = reinterpret_cast<const Bytef*>(bytes.data());
  if (::compress(reinterpret_cast<Bytef*>(out.data()), &size, source, bytes.size()) != Z_OK) throw std::bad_alloc();
  out.resize(size);
  return out;
}

}  // namespace

void append_big_endian(std::string& out, std::size_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xff);
}

void append_png_chunk(std::string& out, std::string_view kind, std::string_view data) {
  append_big_endian(out, data.size());
  const std::size_t begin = out.size();
  out += kind;
  out += data;
  const auto* bytes = reinterpret_cast<const Bytef*>(out.data() + begin);
  append_big_endian(out, ::crc32(0, bytes, static_cast<uInt>(out.size() - begin)));
}

std::string to_png(const DotImage& image, std::span<const std::string_view> colours) {
  std::string head;
  append_big_endian(head, image.width);
  append_big_endian(head, image.height);
  head.append({8, 3, 0, 0, 0});  // bits of a dot, colours by number, and what there is no choice of
  std::string rows;
  rows.reserve((image.width + 1) * image.height);
  for (std::size_t y = 0; y < image.height; ++y) {
    rows += '\0';  // no prediction: numbers of colours have no slope
    rows.append(reinterpret_cast<const char*>(image.dots.data() + y * image.width), image.width);
  }
  std::string out(png_signature);
  append_png_chunk(out, "IHDR", head);
  append_png_chunk(out, "PLTE", palette(colours));
  append_png_chunk(out, "tRNS", std::string_view("\0", 1));
  append_png_chunk(out, "IDAT", compressed(rows));
  append_png_chunk(out, "IEND", "");
  return out;
}

std::string to_base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::string_view three = bytes.substr(i, 3);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (k < three.size() ? static_cast<std::uint8_t>(three[k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += k <= three.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

}  // namespace udar

#include "udar/report/animated_png.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "udar/base/error.hpp"
#include "udar/results/png.hpp"

namespace udar {
namespace {

struct Chunk {
  std::string_view kind;
  std::string_view data;
};

[[noreturn]] void refuse() { throw OutputError("a frame of the animation is not a whole PNG image"); }

std::size_t big_endian(std::string_view bytes) {
  std::size_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<std::uint8_t>(bytes[k]);
  return value;
}

std::vector<Chunk> chunks_of(std::string_view png) {
  if (!png.starts_with(png_signature)) refuse();
  png.remove_prefix(png_signature.size());
  std::vector<Chunk> chunks;
  while (!png.empty()) {
    constexpr std::size_t around = 12;  // length, kind, checksum
    if (png.size() < around || big_endian(png) > png.size() - around) refuse();
    const std::size_t size = big_endian(png);
    chunks.push_back({png.substr(4, 4), png.substr(8, size)});
    png.remove_prefix(size + around);
  }
  if (chunks.empty() || chunks.front().kind != "IHDR" || chunks.front().data.size() != 13) refuse();
  return chunks;
}

/// When and where a frame is shown: for `delay` ms, over the whole image, which it replaces.
std::string frame_control(std::uint32_t number, std::string_view head, std::uint16_t delay) {
  std::string data;
  append_big_endian(data, number);
  data += head.substr(0, 8);  // width and height
  append_big_endian(data, 0);
  append_big_endian(data, 0);
  data += static_cast<char>(delay >> 8);
  data += static_cast<char>(delay & 0xff);
  data.append({'\x03', '\xe8', 0, 0});  // of 1000 a second; left as it is; not blended
  return data;
}

}  // namespace

AnimatedPng::AnimatedPng(const std::filesystem::path& path, std::size_t frames, double frames_per_second)
    : file_(path),
      frames_(frames),
      delay_(static_cast<std::uint16_t>(std::clamp(std::lround(1000 / frames_per_second), 1L, 65535L))) {}

void AnimatedPng::add(std::string_view png) {
  const std::vector<Chunk> chunks = chunks_of(png);
  const std::string_view head = chunks.front().data;
  std::string out;
  const bool first = head_.empty();
  if (first) {
    head_ = head;
    out = png_signature;
    for (const Chunk& chunk : chunks) {
      if (chunk.kind == "IHDR" || chunk.kind == "PLTE" || chunk.kind == "tRNS") {
        append_png_chunk(out, chunk.kind, chunk.data);
      }
    }
    std::string control;
    append_big_endian(control, frames_);
    append_big_endian(control, 0);  // for ever
    append_png_chunk(out, "acTL", control);
  } else if (head != head_) {
    throw OutputError("the frames of the animation are not of one size");
  }
  append_png_chunk(out, "fcTL", frame_control(next_++, head_, delay_));
  for (const Chunk& chunk : chunks) {
    if (chunk.kind != "IDAT") continue;
    if (first) {
      append_png_chunk(out, "IDAT", chunk.data);
    } else {
      std::string data;
      append_big_endian(data, next_++);
      append_png_chunk(out, "fdAT", data.append(chunk.data));
    }
  }
  file_.write(out);
}

void AnimatedPng::commit() {
  std::string out;
  append_png_chunk(out, "IEND", "");
  file_.write(out);
  file_.commit();
}

}  // namespace udar

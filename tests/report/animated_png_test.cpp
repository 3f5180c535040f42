#include "udar/report/animated_png.hpp"

#include <doctest/doctest.h>
#include <zlib.h>

#include <array>

#include "tests/results/scratch.hpp"
#include "udar/results/png.hpp"

using namespace udar;

namespace {

constexpr std::array<std::string_view, 3> colours{"#ff0000", "#00ff00", "#0000ff"};

std::string image(std::uint8_t dot, std::size_t width = 5) {
  return to_png({.width = width, .height = 4, .dots = std::vector<std::uint8_t>(width * 4, dot)}, colours);
}

std::size_t number(std::string_view bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<std::uint8_t>(bytes[at + k]);
  return value;
}

struct Piece {
  std::string kind;
  std::string data;
};

std::vector<Piece> pieces_of(const std::string& bytes) {
  REQUIRE(bytes.starts_with(png_signature));
  std::vector<Piece> pieces;
  for (std::size_t at = 8; at < bytes.size();) {
    const std::size_t size = number(bytes, at);
    REQUIRE(at + 12 + size <= bytes.size());
    const auto* body = reinterpret_cast<const Bytef*>(bytes.data() + at + 4);
    CHECK(::crc32(0, body, static_cast<uInt>(size + 4)) == number(bytes, at + 8 + size));
    pieces.push_back({bytes.substr(at + 4, 4), bytes.substr(at + 8, size)});
    at += 12 + size;
  }
  return pieces;
}

}  // namespace

TEST_CASE("an animated PNG has all frames in order, each piece with its checksum and number") {
  const Scratch scratch;
  AnimatedPng file(scratch / "a.png", 3, 12.5);
  for (std::uint8_t dot = 1; dot <= 3; ++dot) file.add(image(dot));
  CHECK_FALSE(std::filesystem::exists(scratch / "a.png"));
  file.commit();
  const std::vector<Piece> pieces = pieces_of(read_file(scratch / "a.png", 1 << 20));
  std::string kinds;
  for (const Piece& piece : pieces) kinds += piece.kind + " ";
  CHECK(kinds == "IHDR PLTE tRNS acTL fcTL IDAT fcTL fdAT fcTL fdAT IEND ");
  CHECK(number(pieces[3].data, 0) == 3);  // frames
  CHECK(number(pieces[3].data, 4) == 0);  // for ever
  std::size_t next = 0;
  std::vector<std::string> images;
  for (const Piece& piece : pieces) {
    if (piece.kind == "fcTL") {
      CHECK(number(piece.data, 0) == next++);
      CHECK(number(piece.data, 4) == 5);
      CHECK(number(piece.data, 8) == 4);
      CHECK(piece.data.substr(20, 4) == std::string("\0\x50\x03\xe8", 4));  // 80 ms
    }
    if (piece.kind == "fdAT") CHECK(number(piece.data, 0) == next++);
    if (piece.kind == "IDAT") images.push_back(piece.data);
    if (piece.kind == "fdAT") images.push_back(piece.data.substr(4));
  }
  REQUIRE(images.size() == 3);
  for (std::uint8_t k = 0; k < 3; ++k) {
    for (const Piece& piece : pieces_of(image(static_cast<std::uint8_t>(k + 1)))) {
      if (piece.kind == "IDAT") CHECK(images[k] == piece.data);
    }
  }
}

TEST_CASE("what is no PNG or has another size is refused, and no part of a file is left") {
  const Scratch scratch;
  {
    AnimatedPng file(scratch / "a.png", 2, 10);
    file.add(image(1));
    CHECK_THROWS_AS(file.add(image(1, 6)), OutputError);
    CHECK_THROWS_AS(file.add("GIF89a"), OutputError);
    CHECK_THROWS_AS(file.add(image(1).substr(0, 50)), OutputError);
  }
  CHECK(std::filesystem::is_empty(scratch.path));
}

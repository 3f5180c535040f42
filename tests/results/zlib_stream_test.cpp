#include "udar/results/zlib_stream.hpp"

#include <doctest/doctest.h>
#include <zlib.h>

#include <random>
#include <string>
#include <vector>

using namespace udar;

namespace {

using Packing = std::size_t (*)(std::string_view, std::span<char>);

std::string packed(std::string_view bytes, Packing pack, std::size_t room) {
  std::vector<char> out(room, '\x55');
  const std::size_t size = pack(bytes, out);
  REQUIRE(size <= out.size());
  return {out.data(), size};
}
std::string quick(std::string_view bytes) { return packed(bytes, pack_quickly, quick_bound(bytes.size())); }

/// What zlib makes of a stream, which must be whole and no longer than it says.
std::string unpacked(std::string_view stream, std::size_t size) {
  std::string out(size + 1, '\0');
  uLongf found = out.size();
  uLong taken = stream.size();
  REQUIRE(uncompress2(reinterpret_cast<Bytef*>(out.data()), &found, reinterpret_cast<const Bytef*>(stream.data()),
                      &taken) == Z_OK);
  CHECK(taken == stream.size());
  out.resize(found);
  return out;
}

std::string noise(std::mt19937& random, std::size_t size) {
  std::string bytes(size, '\0');
  for (char& c : bytes) c = static_cast<char>(random());
  return bytes;
}

}  // namespace

TEST_CASE("the checksum is that of zlib") {
  std::mt19937 random(1);
  for (const std::size_t size : {0, 1, 31, 32, 33, 4095, 4096, 4097, 98304, 1000003}) {
    CAPTURE(size);
    for (const std::string& bytes : {noise(random, size), std::string(size, '\xff')}) {
      CHECK(adler32_of(bytes) == ::adler32(1, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(size)));
    }
  }
}

TEST_CASE("runs of every length come back, also where they do not end on a number") {
  std::mt19937 random(2);
  for (std::size_t size = 0; size < 1200; ++size) {
    CAPTURE(size);
    const std::string text = noise(random, 7) + std::string(size, 'a') + noise(random, size % 5);
    CHECK(unpacked(quick(text), text.size()) == text);
  }
}

TEST_CASE("repeats from every distance come back, near, at and beyond what a reference reaches") {
  std::mt19937 random(3);
  for (const std::size_t distance :
       {4, 5, 8, 12, 24, 28, 100, 1000, 4096, 24576, 32764, 32768, 32772, 40000, 65535, 65536, 98304, 262144}) {
    CAPTURE(distance);
    const std::string pattern = noise(random, distance);
    const std::string text = pattern + pattern + pattern.substr(0, distance / 3);
    const std::string stream = quick(text);
    CHECK(unpacked(stream, text.size()) == text);
    if (distance % 4 == 0 && distance >= 100 && distance <= 24576) CHECK(stream.size() < text.size() * 6 / 10);
  }
}

TEST_CASE("anything comes back, in no more room than was said") {
  std::mt19937 random(4);
  for (int trial = 0; trial < 400; ++trial) {
    CAPTURE(trial);
    std::string text;
    const std::size_t parts = random() % 40;
    for (std::size_t k = 0; k < parts; ++k) {
      const std::size_t size = random() % (trial % 4 == 0 ? 20000 : 200);
      const std::size_t from = text.empty() ? 0 : random() % text.size();
      if (random() % 2 == 0) {
        text += noise(random, size);
      } else if (random() % 2 == 0) {
        text += std::string(size, static_cast<char>(random() % 3));
      } else {
        text += text.substr(from, size);
      }
    }
    CHECK(unpacked(quick(text), text.size()) == text);
    const std::string tight = packed(text, pack_tightly, tight_bound(text.size()));
    CHECK(unpacked(tight, text.size()) == text);
  }
}

TEST_CASE("what is the same everywhere takes next to no room, noise hardly more than itself") {
  const std::string zeros(98304, '\0');
  CHECK(quick(zeros).size() < zeros.size() / 100);
  std::mt19937 random(5);
  const std::string bytes = noise(random, 98304);
  CHECK(quick(bytes).size() < bytes.size() + 32);
}

#include "udar/results/zlib_stream.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <new>

namespace udar {
namespace {

std::uint64_t load8(const char* from) {
  std::uint64_t value = 0;
  std::memcpy(&value, from, sizeof value);
  return value;
}

constexpr std::uint32_t reversed(std::uint32_t code, int bits) {
  std::uint32_t out = 0;
  for (int k = 0; k < bits; ++k) out |= (code >> k & 1U) << (bits - 1 - k);
  return out;
}

/// Bits as they follow each other in the stream, the first one lowest.
struct Bits {
  std::uint64_t value = 0;
  int count = 0;

  constexpr void add(std::uint64_t more, int many) {
    value |= more << count;
    count += many;
  }
};

constexpr std::size_t longest_reference = 258;
constexpr std::size_t farthest_reference = 32768;

/// A repeat of `length` bytes from `distance` bytes back, in the fixed codes of RFC 1951, 3.2.5 and 3.2.6.
constexpr Bits reference(std::size_t length, std::size_t distance) {
  Bits bits;
  const auto l = static_cast<std::uint32_t>(length - 3);
  const int more_l = l < 8 ? 0 : std::bit_width(l) - 3;
  const std::uint32_t symbol = length == longest_reference ? 285 : 257 + 4 * more_l + (l >> more_l);
  if (symbol < 280) {
    bits.add(reversed(symbol - 256, 7), 7);
  } else {
    bits.add(reversed(symbol - 280 + 0xC0, 8), 8);
  }
  if (length != longest_reference) bits.add(l & ((1U << more_l) - 1), more_l);
  const auto d = static_cast<std::uint32_t>(distance - 1);
  const int more_d = d < 4 ? 0 : std::bit_width(d) - 2;
  bits.add(reversed(2 * more_d + (d >> more_d), 5), 5);
  bits.add(d & ((1U << more_d) - 1), more_d);
  return bits;
}

/// Writes a stream; checks no bounds.
class Stream {
 public:
  explicit Stream(char* begin) : begin_(begin), at_(begin) {
    *at_++ = 0x78;  // deflate with a window of 32 KB; with the next byte a multiple of 31
    *at_++ = 0x01;
  }

  void copy(std::string_view bytes) {
    while (!bytes.empty()) {
      const auto size = static_cast<std::uint16_t>(std::min<std::size_t>(bytes.size(), 65535));
      put(0, 3);  // a stored block, not the last one
      align();
      const std::array<std::uint16_t, 2> sizes{size, static_cast<std::uint16_t>(~size)};
      std::memcpy(at_, sizes.data(), 4);
      std::memcpy(at_ + 4, bytes.data(), size);
      at_ += 4 + size;
      bytes.remove_prefix(size);
    }
  }

  void repeat(std::size_t length, std::size_t distance) {
    put(2, 3);  // a block in fixed codes, not the last one
    const Bits longest = reference(longest_reference, distance);
    for (; length >= longest_reference + 3; length -= longest_reference) put(longest.value, longest.count);
    if (length > longest_reference) {  // no reference is shorter than 3
      const Bits part = reference(length - 3, distance);
      put(part.value, part.count);
      length = 3;
    }
    const Bits rest = reference(length, distance);
    put(rest.value, rest.count);
    put(0, 7);  // end of the block
  }

  /// Returns the length of all.
  std::size_t end(std::uint32_t checksum) {
    put(3, 3);  // the last block, with nothing in it
    put(0, 7);
    align();
    for (int shift = 24; shift >= 0; shift -= 8) *at_++ = static_cast<char>(checksum >> shift & 0xff);
    return static_cast<std::size_t>(at_ - begin_);
  }

 private:
  void put(std::uint64_t value, int count) {
    bits_.add(value, count);
    std::memcpy(at_, &bits_.value, sizeof bits_.value);
    at_ += bits_.count / 8;
    bits_.value >>= bits_.count / 8 * 8;
    bits_.count %= 8;
  }
  void align() {
    if (bits_.count > 0) *at_++ = static_cast<char>(bits_.value);
    bits_ = {};
  }

  char* begin_;
  char* at_;
  Bits bits_;  ///< fewer than 8 that are not written yet
};

/// Where eight bytes were seen last, at a multiple of four.
class Seen {
 public:
  /// Enters `at` and returns where the same bytes may have been before.
  std::size_t exchange(std::uint64_t bytes, std::size_t at) {
    std::uint16_t& place = places_[bytes * 0x9E3779B97F4A7C15ULL >> (64 - log_size)];
    const std::size_t before = 4 * std::size_t{place};
    place = static_cast<std::uint16_t>(at / 4);
    return before;
  }

 private:
  static constexpr int log_size = 12;
  std::array<std::uint16_t, std::size_t{1} << log_size> places_{};
};

/// Bytes from `first` on that are the same as those `distance` before.
std::size_t length_of_repeat(std::string_view bytes, std::size_t first, std::size_t distance) {
  std::size_t end = first;
  const char* data = bytes.data();
  while (end + 8 <= bytes.size() && load8(data + end) == load8(data + end - distance)) end += 8;
  while (end < bytes.size() && data[end] == data[end - distance]) ++end;
  return end - first;
}

}  // namespace

std::uint32_t adler32_of(std::string_view bytes) {
  constexpr std::size_t lanes = 32;
  constexpr std::size_t most_rows = 128;  // 128 * 255 fits into 16 bits
  constexpr std::uint64_t modulus = 65521;
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  std::size_t left = bytes.size();
  std::uint64_t sum = 1;
  std::uint64_t sum_of_sums = 0;
  while (left >= lanes) {
    const std::size_t rows = std::min(left / lanes, most_rows);
    std::array<std::uint16_t, lanes> sums{};
    std::array<std::uint32_t, lanes> above{};  // sums of the sums above
    for (std::size_t row = 0; row < rows; ++row, data += lanes) {
      for (std::size_t k = 0; k < lanes; ++k) {
        above[k] += sums[k];
        sums[k] = static_cast<std::uint16_t>(sums[k] + data[k]);
      }
    }
    const std::size_t count = rows * lanes;
    sum_of_sums += count * sum;
    for (std::size_t k = 0; k < lanes; ++k) {
      sum_of_sums += lanes * (std::uint64_t{above[k]} + sums[k]) - k * sums[k];
      sum += sums[k];
    }
    sum %= modulus;
    sum_of_sums %= modulus;
    left -= count;
  }
  for (; left > 0; --left, ++data) {
    sum += *data;
    sum_of_sums += sum;
  }
  return static_cast<std::uint32_t>(sum_of_sums % modulus << 16 | sum % modulus);
}

std::size_t pack_quickly(std::string_view bytes, std::span<char> out) {
  constexpr std::size_t piece = std::size_t{1} << 18;  // what Seen can tell apart
  constexpr std::size_t shortest = 32;                 // below, two headers cost what is won
  Stream stream(out.data());
  for (std::size_t begin = 0; begin < bytes.size(); begin += piece) {
    const std::string_view part = bytes.substr(begin, piece);
    const char* data = part.data();
    Seen seen;
    std::size_t copied = 0;
    std::size_t misses = 0;
    for (std::size_t at = 4; at + shortest <= part.size();) {
      const std::uint64_t here = load8(data + at);
      const std::size_t before = seen.exchange(here, at);
      const std::size_t distance = at - before;
      if (before < at && distance <= farthest_reference && load8(data + before) == here) {
        std::size_t first = at;
        while (first > copied && first > distance && data[first - 1] == data[first - 1 - distance]) --first;
        const std::size_t length = at - first + length_of_repeat(part, at, distance);
        if (length >= shortest) {
          stream.copy(part.substr(copied, first - copied));
          stream.repeat(length, distance);
          copied = first + length;
          at = (copied + 3) / 4 * 4;
          misses = 0;
          continue;
        }
      }
      at += 4 + 4 * (misses++ / 64);  // where nothing repeats, look less often
    }
    stream.copy(part.substr(copied));
  }
  return stream.end(adler32_of(bytes));
}

std::size_t tight_bound(std::size_t bytes) { return ::compressBound(bytes); }

std::size_t pack_tightly(std::string_view bytes, std::span<char> out) {
  uLongf size = out.size();
  const auto* source = reinterpret_cast<const Bytef*>(bytes.data());
  const int level = 4;  // the higher ones make connectivity 5 % smaller and take twice the time
  if (::compress2(reinterpret_cast<Bytef*>(out.data()), &size, source, bytes.size(), level) != Z_OK) {
    throw std::bad_alloc();
  }
  return size;
}

}  // namespace udar

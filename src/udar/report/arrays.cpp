#include "udar/report/arrays.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <type_traits>

namespace udar {
namespace {

/// The differences from above and from the left, as unsigned numbers, parted into bytes: the lowest of all numbers
/// first. Most are zero, and zeros lie together.
template <class Number>
std::string differences(std::span<const Number> numbers, std::size_t columns) {
  constexpr int bits = 8 * sizeof(Number);
  if (columns == 0) return {};
  std::string planes(numbers.size() * sizeof(Number), '\0');
  Number left = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i % columns == 0) left = 0;
    const Number above = i < columns ? Number{0} : numbers[i - columns];
    const auto difference = static_cast<Number>(numbers[i] - above);
    const auto r = static_cast<Number>(difference - left);
    left = difference;
    const bool negative = (r >> (bits - 1)) != 0;
    const auto code = static_cast<Number>((r << 1) ^ (negative ? static_cast<Number>(-1) : Number{0}));
    for (std::size_t b = 0; b < sizeof(Number); ++b) {
      planes[b * numbers.size() + i] = static_cast<char>((code >> (8 * b)) & 0xFFU);
    }
  }
  return planes;
}

std::string deflated(std::string_view bytes) {
  // Level 6: higher ones take several times as long for a hundredth of the size.
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(6), &libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  std::string out(libdeflate_deflate_compress_bound(compressor.get(), bytes.size()), '\0');
  out.resize(libdeflate_deflate_compress(compressor.get(), bytes.data(), bytes.size(), out.data(), out.size()));
  return out;
}

template <class Number>
PackedArray packed(std::span<const Number> numbers, std::size_t columns) {
  assert(columns > 0 ? numbers.size() % columns == 0 : numbers.empty());
  PackedArray out;
  out.rows = columns > 0 ? numbers.size() / columns : 0;
  out.columns = columns;
  out.bytes = sizeof(Number);
  out.text = base64(deflated(differences(numbers, columns)));
  return out;
}

/// Is it a number that low + step q can reach? Nothing that moves is as large as this limit.
template <class Value>
bool is_number(Value value) {
  constexpr double largest = 0.5 * std::numeric_limits<double>::max();
  return std::fabs(static_cast<double>(value)) < largest;  // not so for NaN
}

struct Range {
  double low = 0;
  double high = 0;
  bool has_none = false;
};

template <class Value>
Range range_of(std::span<const Value> values) {
  Range range;
  bool any = false;
  for (const Value value : values) {
    if (!is_number(value)) {
      range.has_none = true;
    } else if (!any) {
      range.low = range.high = value;
      any = true;
    } else {
      range.low = std::min<double>(range.low, value);
      range.high = std::max<double>(range.high, value);
    }
  }
  return range;
}

template <class Number, class Value>
PackedArray rounded(std::span<const Value> values, std::size_t columns, int bits) {
  constexpr auto none = static_cast<Number>(-1);
  const Range range = range_of(values);
  auto most = static_cast<Number>(none >> (8 * static_cast<int>(sizeof(Number)) - bits));
  if (range.has_none && most == none) --most;
  // Between values of both signs 0 has a number of its own: what is nothing stays nothing.
  const bool both_signs = range.low < 0 && range.high > 0 && most > 1;
  const double step = (range.high - range.low) / (both_signs ? most - 1 : most);
  const double low = both_signs ? -step * std::ceil(-range.low / step) : range.low;
  std::vector<Number> numbers(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!is_number(values[i])) {
      numbers[i] = none;
    } else if (step > 0) {
      const double q = (values[i] - low) / step + 0.5;  // cut to the whole number below
      numbers[i] = static_cast<Number>(std::clamp(q, 0.0, static_cast<double>(most)));
    }
  }
  PackedArray out = packed<Number>(numbers, columns);
  out.low = low;
  out.step = step;
  if (range.has_none) out.none = none;
  return out;
}

template <class Value>
PackedArray rounded_in(std::span<const Value> values, std::size_t columns, int bits) {
  assert(bits >= 1 && bits <= 32);
  if (bits <= 8) return rounded<std::uint8_t>(values, columns, bits);
  if (bits <= 16) return rounded<std::uint16_t>(values, columns, bits);
  return rounded<std::uint32_t>(values, columns, bits);
}

template <class Number>
PackedArray narrowed(std::span<const std::uint32_t> values, std::size_t columns) {
  std::vector<Number> numbers(values.size());
  std::transform(values.begin(), values.end(), numbers.begin(), [](std::uint32_t v) { return static_cast<Number>(v); });
  return packed<Number>(numbers, columns);
}

}  // namespace

PackedArray pack_numbers(std::span<const std::uint32_t> values, std::size_t columns) {
  const std::uint32_t largest = values.empty() ? 0 : *std::max_element(values.begin(), values.end());
  if (largest <= 0xFF) return narrowed<std::uint8_t>(values, columns);
  if (largest <= 0xFFFF) return narrowed<std::uint16_t>(values, columns);
  return packed(values, columns);
}

PackedArray pack_floats(std::span<const float> values, std::size_t columns) {
  std::vector<std::uint32_t> numbers(values.size());
  std::transform(values.begin(), values.end(), numbers.begin(),
                 [](float v) { return std::bit_cast<std::uint32_t>(v); });
  PackedArray out = packed<std::uint32_t>(numbers, columns);
  out.is_float = true;
  return out;
}

PackedArray pack_rounded(std::span<const float> values, std::size_t columns, int bits) {
  return rounded_in(values, columns, bits);
}
PackedArray pack_rounded(std::span<const double> values, std::size_t columns, int bits) {
  return rounded_in(values, columns, bits);
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out((bytes.size() + 2) / 3 * 4, '=');
  const auto byte = [&](std::size_t i) -> std::uint32_t {
    return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U;
  };
  for (std::size_t i = 0, to = 0; i < bytes.size(); i += 3, to += 4) {
    const std::uint32_t three = (byte(i) << 16) | (byte(i + 1) << 8) | byte(i + 2);
    const std::size_t letters_here = std::min<std::size_t>(bytes.size() - i, 3) + 1;
    for (std::size_t k = 0; k < letters_here; ++k) out[to + k] = letters[(three >> (18 - 6 * k)) & 63U];
  }
  return out;
}

}  // namespace udar

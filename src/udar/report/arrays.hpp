#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace udar {

/// A table of whole numbers, packed as docs/report-format.md tells.
struct PackedArray {
  std::size_t rows = 0;
  std::size_t columns = 0;
  int bytes = 1;                      ///< of each number: 1, 2 or 4
  bool is_float = false;              ///< the four bytes are those of a 32-bit floating-point number
  std::optional<double> low;          ///< value of number 0, unit of the quantity; none: the number is the value
  double step = 0;                    ///< from number to number
  std::optional<std::uint32_t> none;  ///< the number that stands for NaN and infinities, where there are any
  std::string text;                   ///< base64 of the deflated bytes
};

/// Whole numbers, row by row, in as few bytes as hold the largest. `values.size()` is a multiple of `columns`.
PackedArray pack_numbers(std::span<const std::uint32_t> values, std::size_t columns);
/// Numbers of 32 bits, bit by bit.
PackedArray pack_floats(std::span<const float> values, std::size_t columns);
/// The numbers of a table in 2^bits - 1 equal steps from its least to its largest: none is off by more than half a
/// step. `bits` from 1 to 32; up to 8 are stored in one byte, up to 16 in two.
PackedArray pack_rounded(std::span<const float> values, std::size_t columns, int bits);
PackedArray pack_rounded(std::span<const double> values, std::size_t columns, int bits);

/// Bytes as text (RFC 4648).
std::string base64(std::string_view bytes);

}  // namespace udar

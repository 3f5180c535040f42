#include <array>
#include <bit>
#include <cmath>
#include <string>

#include "fuzz/target.hpp"
#include "udar/units/quantity.hpp"

using namespace udar;

namespace {

constexpr std::array dimensions{dimension::number,      dimension::angle,    dimension::length, dimension::time,
                                dimension::mass,        dimension::velocity, dimension::spin,   dimension::density,
                                dimension::force,       dimension::stress,   dimension::rate,   dimension::stiffness,
                                dimension::acceleration};

void check_error(const UnitError& error) { fuzz::require(!error.what.empty()); }

/// A value that was read is written so that the same double is read back.
void check_round_trip(double value, Dimension dimension) {
  const auto again = parse_si(si_text(value, dimension), dimension);
  fuzz::require(again.has_value());
  fuzz::require(std::bit_cast<std::uint64_t>(*again) == std::bit_cast<std::uint64_t>(value));
}

}  // namespace

/// The first byte chooses the dimension that is needed, the others are the text of a quantity.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text = fuzz::text_of(data + 1, size - 1);
  const auto quantity = parse_quantity(text);
  if (quantity) {
    fuzz::require(std::isfinite(quantity->value));
  } else {
    check_error(quantity.error());
  }
  const Dimension needed = dimensions[data[0] % dimensions.size()];
  const auto value = parse_si(text, needed);
  if (!value) {
    check_error(value.error());
    return 0;
  }
  fuzz::require(quantity.has_value() && fits(quantity->dimension, needed));
  check_round_trip(*value, needed);
  return 0;
}

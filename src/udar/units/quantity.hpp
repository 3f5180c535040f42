#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "udar/units/dimension.hpp"

namespace udar {

/// A number with its unit, turned into SI.
struct Quantity {
  double value = 0;  ///< in SI units
  Dimension dimension;
  bool bare = false;  ///< no unit was given
};

/// Why a text is no quantity, or not the one that is needed.
struct UnitError {
  std::string what;    ///< "wrong unit"; goes before "for `velocity`"
  std::string reason;  ///< "this is a length; a velocity is needed"
  std::string cure;    ///< "did you mean \"80 m/s\"?"
};

/// Longest text that is looked at.
inline constexpr std::size_t longest_quantity = 100;

/// Reads "80 m/s", "-9.81 m/s^2", "2400 kgf/cm^2", "5 1/s", "1e-3 kg/(m s)", "0.35". Units are multiplied by a space or
/// `*`, divided by `/`; an exponent is written m^2 or m2. After a `/` no more multiplication is taken ("kg/m s" could
/// mean two things); parentheses say what is meant. Numbers are decimal; hex, inf and nan are no numbers here.
tl::expected<Quantity, UnitError> parse_quantity(std::string_view text);

/// The SI value of a text that must have dimension `needed`. A unit is required unless a plain number is needed.
tl::expected<double, UnitError> parse_si(std::string_view text, Dimension needed);

/// What to say of a number without unit where `needed` is asked for.
UnitError missing_unit(std::string_view number, Dimension needed);

/// "80 m/s": a value in SI, with as many digits as it takes to read the same double back.
std::string si_text(double value, Dimension dimension);

}  // namespace udar

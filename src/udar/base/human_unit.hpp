#pragma once

#include <string>
#include <string_view>

namespace udar {

/// A unit as people like to read it: `name` is `size` SI units.
struct HumanUnit {
  std::string name;  ///< "MPa", "10⁶ m/s²"; "" for plain numbers
  double size = 1;
};

/// The unit for values up to `largest` in an SI unit: numbers from about 0.1 to 1000. Prefixes where people use them
/// (mm, kN, MPa, kJ), else powers of ten.
HumanUnit human_unit(std::string_view si_unit, double largest);

/// "m/s^2" -> "m/s²".
std::string typeset(std::string_view unit);

/// "0.52 ms", "1.24 MN", "0.031": a value in a unit that suits it, three digits or as many as told.
std::string human_text(double value, std::string_view si_unit, int digits = 3);

}  // namespace udar

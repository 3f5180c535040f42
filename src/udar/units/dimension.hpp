#pragma once

#include <string>

namespace udar {

/// Exponents of kilogram, metre, second and radian. Radians are counted only to tell an angle from a plain number
/// (`turn = 35` must not mean 35 rad); beside other units they may be left out: 5 1/s is as good a spin as 5 rad/s.
struct Dimension {
  int mass = 0;
  int length = 0;
  int time = 0;
  int angle = 0;
  friend constexpr bool operator==(const Dimension&, const Dimension&) = default;
};

namespace dimension {
inline constexpr Dimension number{};
inline constexpr Dimension angle{0, 0, 0, 1};
inline constexpr Dimension length{0, 1, 0};
inline constexpr Dimension time{0, 0, 1};
inline constexpr Dimension mass{1, 0, 0};
inline constexpr Dimension velocity{0, 1, -1};
inline constexpr Dimension acceleration{0, 1, -2};
inline constexpr Dimension rate{0, 0, -1};
inline constexpr Dimension spin{0, 0, -1, 1};
inline constexpr Dimension wave_number{0, -1, 0, 1};
inline constexpr Dimension density{1, -3, 0};
inline constexpr Dimension force{1, 1, -2};
inline constexpr Dimension stress{1, -1, -2};
inline constexpr Dimension stiffness{1, 0, -2};
}  // namespace dimension

constexpr Dimension operator+(Dimension a, Dimension b) {
  return {a.mass + b.mass, a.length + b.length, a.time + b.time, a.angle + b.angle};
}
constexpr Dimension operator*(int n, Dimension a) { return {n * a.mass, n * a.length, n * a.time, n * a.angle}; }

/// Whether a quantity of dimension `given` may stand where `needed` is asked for.
constexpr bool fits(Dimension given, Dimension needed) {
  const bool same = given.mass == needed.mass && given.length == needed.length && given.time == needed.time;
  return same && !(needed == dimension::number && given.angle != 0);
}

/// "a velocity", "an angle", "a plain number"; "a quantity in kg m^2/s^3" where it has no name of its own.
std::string dimension_name(Dimension dimension);

/// "m/s", "kg/m^3"; "" for a plain number.
std::string si_unit(Dimension dimension);

/// A typical value as a case file writes it, quotes included: "\"80 m/s\"", "0.25".
std::string example_of(Dimension dimension);

}  // namespace udar

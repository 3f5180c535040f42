#pragma once

namespace udar {

/// Exponents of kilogram, metre and second. Angles and plain numbers have none.
struct Dimension {
  int mass = 0;
  int length = 0;
  int time = 0;
  friend constexpr bool operator==(const Dimension&, const Dimension&) = default;
};

namespace dimension {
inline constexpr Dimension number{};
inline constexpr Dimension angle{};
inline constexpr Dimension length{0, 1, 0};
inline constexpr Dimension time{0, 0, 1};
inline constexpr Dimension velocity{0, 1, -1};
inline constexpr Dimension acceleration{0, 1, -2};
inline constexpr Dimension rate{0, 0, -1};        // spin (rad/s), damping
inline constexpr Dimension wave_number{0, -1, 0};
inline constexpr Dimension density{1, -3, 0};
inline constexpr Dimension force{1, 1, -2};
inline constexpr Dimension stress{1, -1, -2};
inline constexpr Dimension stiffness{1, 0, -2};
}  // namespace dimension

}  // namespace udar

#pragma once

#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "udar/base/vec2.hpp"
#include "udar/units/dimension.hpp"

namespace udar {

/// What values make sense: `low` to `high`, each end included or not.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_included = true;
  bool high_included = true;

  [[nodiscard]] constexpr bool hold(double v) const {
    return (low_included ? v >= low : v > low) && (high_included ? v <= high : v < high);
  }
};

namespace limits {
inline constexpr Limits any{};
inline constexpr Limits positive{.low = 0, .low_included = false};
inline constexpr Limits not_negative{.low = 0};
}  // namespace limits

/// A word out of a fixed list, kept in an enum of `Owner`.
template <class Owner>
struct Choice {
  std::vector<std::string> words;
  void (*set)(Owner&, int word);
  int (*get)(const Owner&);
};

/// One value that a law, an obstacle shape or a mesh generator wants from the user. The case file's reader, its
/// documentation and resolved.toml are all made from these, so a new law is described only where it is written.
template <class Owner>
struct Parameter {
  std::string name;
  std::variant<double Owner::*, std::optional<double> Owner::*, Vec2 Owner::*, std::optional<Vec2> Owner::*,
               std::vector<Vec2> Owner::*, Choice<Owner>>
      member;
  Dimension dimension{};
  Limits limits{};
  std::string doc;
  bool required = true;  ///< otherwise the value of a default-constructed Owner holds
  std::string example;   ///< "2400 kgf/cm^2"; empty: one that shows the unit
};

}  // namespace udar

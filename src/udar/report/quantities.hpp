#pragma once

#include <array>
#include <string_view>

namespace udar {

/// A quantity of the report and where a frame has it.
struct Quantity {
  std::string_view name;  ///< in the report
  std::string_view word;  ///< what a user calls it; empty: always there
  std::string_view unit;
  bool on_nodes = false;   ///< else on elements
  std::string_view field;  ///< in the frame; empty: the place against the body's centre of mass
  int component = 0;
  int bits = 0;  ///< always stored in so many; 0: as the limit of size allows
};

inline constexpr int place_bits = 16;

/// All there are, in the order of the report.
inline constexpr std::array<Quantity, 13> all_quantities{{
    {"x", "", "m", true, "", 0, place_bits},
    {"y", "", "m", true, "", 1, place_bits},
    {"velocity_x", "velocity", "m/s", true, "velocity_m_per_s", 0},
    {"velocity_y", "velocity", "m/s", true, "velocity_m_per_s", 1},
    {"acceleration_x", "acceleration", "m/s^2", true, "acceleration_m_per_s2", 0},
    {"acceleration_y", "acceleration", "m/s^2", true, "acceleration_m_per_s2", 1},
    {"plastic_strain", "plastic_strain", "", false, "plastic_strain"},
    {"flows_now", "flows_now", "", false, "flows_now", 0, 1},
    {"principal_1", "principal_1", "Pa", false, "principal_1_Pa"},
    {"principal_2", "principal_2", "Pa", false, "principal_2_Pa"},
    {"principal_3", "principal_3", "Pa", false, "principal_3_Pa"},
    {"max_shear", "max_shear", "Pa", false, "max_shear_Pa"},
    {"pressure", "pressure", "Pa", false, "pressure_Pa"},
}};

/// What a user calls the forces of contact, which are no quantity of all nodes.
inline constexpr std::string_view contact_force_word = "contact_force";

}  // namespace udar

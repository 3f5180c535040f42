#pragma once

#include <string>
#include <string_view>

#include "udar/base/error.hpp"
#include "udar/case/case_file.hpp"

namespace udar {

/// The short beam, with every comment and line where the tests expect it.
inline constexpr std::string_view short_beam = R"([run]
end_time = "2 ms"
integrator = "central_difference"
time_step = "auto"                       # or "6.4e-8 s"
gravity = ["0 m/s^2", "-9.81 m/s^2"]
[materials.steel]
law = "tresca"
density = "7850 kg/m^3"
young_modulus = "2e6 kgf/cm^2"
poisson_ratio = 0.25
yield_stress = "2400 kgf/cm^2"
[bodies.beam]
material = "steel"
thickness = "1 cm"
velocity = ["0 m/s", "-80 m/s"]
mesh = { shape = "rectangle", size = ["40 cm", "10 cm"], at = ["-20 cm", "0 cm"], element_size = "0.25 cm", diagonals = "alternating" }
[obstacles.stop]
shape = "polygon"
points = [["-3 cm", "0 cm"], ["-23 cm", "-20 cm"], ["23 cm", "-20 cm"], ["3 cm", "0 cm"]]
friction = 0.35
stiffness = "2e6 kgf/cm"                 # or "auto"
[[observe.nodes]]
name = "corner"
body = "beam"
at = ["-20 cm", "10 cm"]                 # also [[observe.elements]], [[observe.regions]]
[output]
fields_every = "20 us"
)";

/// The short beam with `from` replaced by `to`; `from` must be there.
inline std::string beam_with(std::string_view from, std::string_view to) {
  std::string text(short_beam);
  const auto at = text.find(from);
  return at == std::string::npos ? std::string() : text.replace(at, from.size(), to);
}

inline std::string repeated(std::string_view piece, int times) {
  std::string out;
  for (int i = 0; i < times; ++i) out += piece;
  return out;
}

/// What is said of a case; "" where nothing is wrong.
inline std::string complaints(std::string_view text, std::vector<std::string> assignments = {}) {
  try {
    read_case(text, "bad.toml", assignments);
    return "";
  } catch (const UserError& error) {
    return error.code == ExitCode::bad_case ? error.what() : "wrong exit code";
  }
}

}  // namespace udar

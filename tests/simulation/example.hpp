#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>
#include <type_traits>

#include "udar/case/case.hpp"
#include "udar/model/model.hpp"
#include "udar/model/state.hpp"

namespace udar {

/// A steel block of 4 x 2 cm falls on a flat stop, flows, rebounds: contact, friction, plastic flow and free flight in
/// a hundred steps of a hundred elements.
inline Case falling_block(double element_size = 0.005) {
  return {.run = {.end_time = 60e-6, .gravity = {0, -9.81}},
          .materials = {{.name = "steel",
                         .density = 7850,
                         .law = Tresca{.young_modulus = 196e9, .poisson_ratio = 0.25, .yield_stress = 235e6}}},
          .bodies = {{.name = "block",
                      .material = "steel",
                      .thickness = 0.01,
                      .velocity = {5, -80},
                      .mesh = RectangleMesh{.size = {0.04, 0.02}, .at = {-0.02, 0}, .element_size = element_size}}},
          .obstacles = {{.name = "stop", .shape = HalfPlane{}, .friction = 0.35}},
          .observed_nodes = {{.name = "corner", .body = "block", .at = {-0.02, 0.02}}},
          .observed_elements = {{.name = "bottom", .body = "block", .at = {0.001, 0.001}}},
          .observed_regions = {{.name = "left_half",
                                .body = "block",
                                .polygon = {{-0.021, -0.001}, {0, -0.001}, {0, 0.021}, {-0.021, 0.021}}}}};
}

/// The same as a case file.
inline constexpr const char* falling_block_text = R"([run]
end_time = "60 us"
gravity = ["0 m/s^2", "-9.81 m/s^2"]
[materials.steel]
law = "tresca"
density = "7850 kg/m^3"
young_modulus = "196 GPa"
poisson_ratio = 0.25
yield_stress = "235 MPa"
[bodies.block]
material = "steel"
thickness = "1 cm"
velocity = ["5 m/s", "-80 m/s"]
mesh = { shape = "rectangle", size = ["4 cm", "2 cm"], at = ["-2 cm", "0 cm"], element_size = "0.5 cm" }
[obstacles.stop]
shape = "half_plane"
point = ["0 m", "0 m"]
normal = [0, 1]
friction = 0.35
[[observe.nodes]]
name = "corner"
body = "block"
at = ["-2 cm", "2 cm"]
[[observe.elements]]
name = "bottom"
body = "block"
at = ["1 mm", "1 mm"]
[[observe.regions]]
name = "left_half"
body = "block"
polygon = [["-21 mm", "-1 mm"], ["0 mm", "-1 mm"], ["0 mm", "21 mm"], ["-21 mm", "21 mm"]]
)";

// No byte of these is padding: every byte is the same in two equal states.
static_assert(sizeof(StepLimit) == sizeof(double) + 2 * sizeof(std::uint32_t));
static_assert(sizeof(Clock) ==
              sizeof(CompensatedSum) + 5 * sizeof(std::uint64_t) + 15 * sizeof(double) + 2 * sizeof(StepLimit));
static_assert(sizeof(FrequencyBound) == 2 * sizeof(double) + 2 * sizeof(std::uint32_t));
static_assert(sizeof(BodySums) == 3 * sizeof(Vec2) + sizeof(double));
static_assert(sizeof(NodeRecord) == 4 * sizeof(double));
static_assert(sizeof(SpringState) ==
              2 * sizeof(double) + 4 * sizeof(Vec2) + sizeof(std::uint32_t) + 2 * sizeof(std::uint16_t));
static_assert(sizeof(BodyTouch) == 4 * sizeof(std::uint32_t) + 4 * sizeof(double) + sizeof(SpringState));
static_assert(sizeof(ForceBook) == 4 * sizeof(Vec2) + 3 * sizeof(CompensatedSum) + sizeof(double));
static_assert(sizeof(ContactBook) == 2 * sizeof(ForceBook) + sizeof(std::uint64_t));
static_assert(sizeof(Sinking) == 2 * sizeof(double) + sizeof(std::uint64_t));
static_assert(sizeof(DeepestTouch) ==
              3 * sizeof(double) + sizeof(Vec2) + 2 * sizeof(std::uint32_t) + sizeof(std::uint64_t));
static_assert(sizeof(PairBook) == 2 * sizeof(Index) + sizeof(ContactBook));
static_assert(sizeof(SpinBook) == 4 * sizeof(double) + sizeof(CompensatedSum));
static_assert(sizeof(Ledger) == force_kinds * sizeof(ForceBook) + spin_kinds * sizeof(SpinBook) +
                                    7 * sizeof(CompensatedSum) + 17 * sizeof(double) + 3 * sizeof(Vec2));

/// Momentum and spin of all bodies, with the velocity of the coming step.
struct Totals {
  Vec2 momentum{};  ///< kg m/s
  double spin = 0;  ///< kg m2/s
  double size = 0;  ///< kg m/s, sum of |m v|
};

inline Totals totals(const Model& model, const State& state) {
  Totals t;
  for (Index i = 0; i < model.node_count; ++i) {
    const NodeRecord& r = state.nodes[i];
    const Vec2 p = model.mass[i] * Vec2{r.vx, r.vy};
    t.momentum += p;
    t.spin += cross(Vec2{r.x, r.y}, p);
    t.size += length(p);
  }
  return t;
}

/// Hash of every bit of a state (FNV-1a), in the order of `for_each_field`.
inline std::uint64_t hash_of(const State& state) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  const auto add = [&](const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t k = 0; k < size; ++k) hash = (hash ^ bytes[k]) * 0x100000001b3U;
  };
  for_each_field(state, [&](const char*, const auto& field) {
    using Field = std::decay_t<decltype(field)>;
    if constexpr (requires { field.data(); }) {
      static_assert(std::is_trivially_copyable_v<typename Field::value_type>);
      const std::size_t count = field.size();
      add(&count, sizeof count);
      add(field.data(), count * sizeof(typename Field::value_type));
    } else {
      static_assert(std::is_trivially_copyable_v<Field>);
      add(&field, sizeof field);
    }
  });
  return hash;
}

/// An environment variable that is set while the object lives.
struct Environment {
  Environment(const char* name, const char* value) : name_(name) { ::setenv(name, value, 1); }
  ~Environment() { ::unsetenv(name_); }
  Environment(const Environment&) = delete;

 private:
  const char* name_;
};

}  // namespace udar

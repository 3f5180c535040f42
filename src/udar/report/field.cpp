#include "udar/report/field.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>

#include "udar/base/error.hpp"
#include "udar/base/text.hpp"

namespace udar {
namespace {

using Of = FieldKind::Of;

constexpr std::array kinds{
    FieldKind{"plastic_strain", "plastic", "plastic strain", "plastic_strain", "", Of::elements},
    FieldKind{"principal_1", "sigma1", "first principal stress", "principal_1_Pa", "Pa", Of::elements},
    FieldKind{"principal_2", "sigma2", "second principal stress", "principal_2_Pa", "Pa", Of::elements},
    FieldKind{"principal_3", "sigma3", "third principal stress", "principal_3_Pa", "Pa", Of::elements},
    FieldKind{"max_shear", "shear", "largest shear stress", "max_shear_Pa", "Pa", Of::elements},
    FieldKind{"pressure", "", "pressure", "pressure_Pa", "Pa", Of::elements},
    FieldKind{"stress_x", "sigma_x", "stress x", "stress_x_Pa", "Pa", Of::elements},
    FieldKind{"stress_y", "sigma_y", "stress y", "stress_y_Pa", "Pa", Of::elements},
    FieldKind{"stress_xy", "sigma_xy", "shear stress xy", "stress_xy_Pa", "Pa", Of::elements},
    FieldKind{"stress_z", "sigma_z", "stress z", "stress_z_Pa", "Pa", Of::elements},
    FieldKind{"displacement", "", "displacement", "displacement_m", "m", Of::size},
    FieldKind{"displacement_x", "", "displacement x", "displacement_m", "m", Of::x},
    FieldKind{"displacement_y", "", "displacement y", "displacement_m", "m", Of::y},
    FieldKind{"velocity", "", "velocity", "velocity_m_per_s", "m/s", Of::size},
    FieldKind{"velocity_x", "", "velocity x", "velocity_m_per_s", "m/s", Of::x},
    FieldKind{"velocity_y", "", "velocity y", "velocity_m_per_s", "m/s", Of::y},
    FieldKind{"acceleration", "", "acceleration", "acceleration_m_per_s2", "m/s^2", Of::size},
    FieldKind{"acceleration_x", "", "acceleration x", "acceleration_m_per_s2", "m/s^2", Of::x},
    FieldKind{"acceleration_y", "", "acceleration y", "acceleration_m_per_s2", "m/s^2", Of::y},
    FieldKind{"flows_now", "flows", "plastic zone", "flows_now", "", Of::flow},
    FieldKind{"contact_force", "contact", "contact force", "contact_force_N", "N", Of::contact},
    FieldKind{"none", "", "", "", "", Of::no_values},
};

/// An array of the frame with this many components for each of `count` points or cells.
const VtuArray& find_array(const Frame& frame, const std::vector<VtuArray>& arrays, std::string_view name,
                           int components, std::size_t count) {
  const auto at = std::find_if(arrays.begin(), arrays.end(), [&](const VtuArray& a) { return a.name == name; });
  if (at == arrays.end()) {
    throw OutputError(fmt::format(
        "the frame at {} s has no field `{}`\n  = run the case again with this version of Udar", frame.time, name));
  }
  const std::size_t size = std::visit([](const auto& values) { return values.size(); }, at->values);
  if (at->components != components || size != static_cast<std::size_t>(components) * count) {
    throw OutputError(fmt::format("the field `{}` of the frame at {} s has the wrong length", name, frame.time));
  }
  return *at;
}

std::vector<double> cell_numbers(const Frame& frame, std::string_view name) {
  const VtuArray& array = find_array(frame, frame.bodies.cell_fields, name, 1, frame.triangles.size());
  return std::visit([](const auto& values) { return std::vector<double>(values.begin(), values.end()); }, array.values);
}

/// The same; none on rigid bodies, which have no stress.
std::vector<double> solid_numbers(const Frame& frame, std::string_view name) {
  std::vector<double> values = cell_numbers(frame, name);
  if (std::find(frame.rigid.begin(), frame.rigid.end(), 1) == frame.rigid.end()) return values;
  const std::vector<std::int32_t> bodies = bodies_of_triangles(frame);
  for (std::size_t t = 0; t < values.size(); ++t) {
    const auto body = static_cast<std::size_t>(bodies[t]);
    if (body < frame.rigid.size() && frame.rigid[body] != 0) values[t] = std::numeric_limits<double>::quiet_NaN();
  }
  return values;
}

double part_of(Vec2 vector, Of of) {
  if (of == Of::x) return vector.x;
  if (of == Of::y) return vector.y;
  return length(vector);
}

}  // namespace

std::span<const FieldKind> field_kinds() { return kinds; }

const FieldKind& find_field(std::string_view name) {
  std::vector<std::string> names;
  for (const FieldKind& kind : kinds) {
    if (name == kind.name || (!kind.short_name.empty() && name == kind.short_name)) return kind;
    names.emplace_back(kind.name);
    if (!kind.short_name.empty()) names.emplace_back(kind.short_name);
  }
  std::string near = nearest_word(name, names);
  const auto begun = std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.starts_with(name); });
  if (near.empty() && !name.empty() && begun != names.end()) near = *begun;
  names.clear();
  for (const FieldKind& kind : kinds) names.emplace_back(kind.short_name.empty() ? kind.name : kind.short_name);
  throw UserError(ExitCode::usage, fmt::format("there is no field `{}`", name),
                  near.empty() ? "write " + one_of(names) : fmt::format("did you mean `{}`?", near));
}

std::vector<Vec2> node_vectors(const Frame& frame, std::string_view name) {
  const std::size_t count = frame.bodies.points.size();
  const VtuArray& array = find_array(frame, frame.bodies.point_fields, name, 3, count);
  std::vector<Vec2> vectors(count);
  std::visit(
      [&](const auto& values) {
        for (std::size_t i = 0; i < count; ++i) {
          vectors[i] = {static_cast<double>(values[3 * i]), static_cast<double>(values[3 * i + 1])};
        }
      },
      array.values);
  return vectors;
}

std::vector<double> element_values(const Frame& frame, const FieldKind& kind) {
  if (kind.of == Of::elements) return solid_numbers(frame, kind.array);
  const std::vector<Vec2> vectors = node_vectors(frame, kind.array);
  std::vector<double> values;
  values.reserve(frame.triangles.size());
  for (const auto& triangle : frame.triangles) {
    double sum = 0;
    for (const std::int32_t corner : triangle) sum += part_of(vectors[static_cast<std::size_t>(corner)], kind.of);
    values.push_back(sum / 3);
  }
  return values;
}

std::vector<double> node_values(const Frame& frame, const FieldKind& kind) {
  std::vector<double> values(frame.bodies.points.size());
  if (kind.of != Of::elements) {
    const std::vector<Vec2> vectors = node_vectors(frame, kind.array);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = part_of(vectors[i], kind.of);
    return values;
  }
  const std::vector<double> of_cells = solid_numbers(frame, kind.array);
  std::vector<int> counts(values.size());
  for (std::size_t t = 0; t < frame.triangles.size(); ++t) {
    for (const std::int32_t corner : frame.triangles[t]) {
      values[static_cast<std::size_t>(corner)] += of_cells[t];
      ++counts[static_cast<std::size_t>(corner)];
    }
  }
  for (std::size_t i = 0; i < values.size(); ++i) values[i] /= std::max(1, counts[i]);
  return values;
}

std::vector<std::uint8_t> flow_flags(const Frame& frame) {
  const std::vector<double> now = cell_numbers(frame, "flows_now");
  const std::vector<double> strain = cell_numbers(frame, "plastic_strain");
  std::vector<std::uint8_t> flags(now.size());
  for (std::size_t t = 0; t < flags.size(); ++t) {
    flags[t] = now[t] != 0 ? 1 : strain[t] > 0 ? 2 : 0;
  }
  return flags;
}

std::vector<std::int32_t> bodies_of_triangles(const Frame& frame) {
  const std::vector<double> numbers = cell_numbers(frame, "body");
  return {numbers.begin(), numbers.end()};
}

}  // namespace udar

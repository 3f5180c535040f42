#include "udar/mesh/cells.hpp"

#include <fmt/core.h>

#include <cmath>
#include <numeric>

#include "udar/base/error.hpp"
#include "udar/base/memory.hpp"
#include "udar/base/text.hpp"

namespace udar {

Index cells_along(double length, double element_size, std::string_view what) {
  for (const double size : {length, element_size}) {
    if (std::isfinite(size) && size > 0) continue;
    throw UserError(ExitCode::bad_mesh, fmt::format("the {} of a mesh and its element size must be above 0", what));
  }
  const double cells = std::round(length / element_size);
  if (cells < 1) {
    throw UserError(ExitCode::bad_mesh,
                    fmt::format("not one whole element fits into the {}: {} m for elements of {} m", what,
                                shortest(length), shortest(element_size)),
                    fmt::format("take an `element_size` of {} m or less", shortest(length)));
  }
  check_triangle_count(cells);
  return static_cast<Index>(cells);
}

void check_memory_for(double elements, double bytes) {
  // Of what is small the system need not be asked.
  constexpr double always_there = 1 << 26;
  if (bytes <= always_there) return;
  const double there = memory_there();
  if (bytes <= there) return;
  throw UserError(ExitCode::resources,
                  fmt::format("about {} elements need {} of memory at least; {} are there", in_units(elements, ""),
                              in_units(bytes, "B"), in_units(there, "B")),
                  "take a larger `element_size`, or fewer obstacles and bodies; is a unit wrong?");
}

void check_triangle_count(double triangles) {
  if (3 * triangles > most_corners) {
    throw UserError(ExitCode::bad_mesh,
                    fmt::format("the mesh would have {:.3g} triangles; {:.0f} are the most", triangles,
                                std::floor(most_corners / 3)),
                    "take a larger `element_size`");
  }
  check_memory_for(triangles, least_bytes_per_element * triangles);
}

void check_placement(Vec2 at, double turn) {
  if (std::isfinite(at.x) && std::isfinite(at.y) && std::fabs(turn) <= 1e5) return;
  throw UserError(ExitCode::bad_mesh, "a mesh must be placed at a finite point and turned by at most 1e5 rad");
}

Vec2 on_circle(Vec2 p, Vec2 centre, double radius) {
  const Vec2 arm = p - centre;
  return centre + (radius / length(arm)) * arm;
}

void number_as_generated(Mesh& mesh) {
  mesh.node_numbers.resize(mesh.nodes.size());
  std::iota(mesh.node_numbers.begin(), mesh.node_numbers.end(), Index{0});
  mesh.triangle_numbers.resize(mesh.triangles.size());
  std::iota(mesh.triangle_numbers.begin(), mesh.triangle_numbers.end(), Index{0});
}

NamedEdges named_path(std::string_view name, const std::vector<Index>& path) {
  NamedEdges side{std::string(name), {}};
  for (std::size_t i = 1; i < path.size(); ++i) side.edges.push_back({path[i - 1], path[i]});
  return side;
}

}  // namespace udar

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "udar/base/compensated_sum.hpp"
#include "udar/base/vec2.hpp"

namespace udar {

/// The triangles of one body of a frame, as they lay before the run.
struct BodyMesh {
  std::vector<std::array<std::int32_t, 3>> nodes;  ///< for each triangle, as the frame counts them
  std::vector<std::int32_t> numbers;               ///< for each triangle its number in the frame
  std::vector<std::array<Vec2, 3>> corners;        ///< m, for each triangle
};

/// The places where fields of a body on a coarse mesh and on a fine one are compared, and what is found there on
/// either. The meshes need not be nested.
struct Projection {
  /// A fine triangle, by its centroid: for fields that are constant in an element.
  struct Element {
    double area = 0;  ///< m2, undeformed
    std::int32_t fine = 0;
    std::int32_t coarse = 0;
    bool outside = false;  ///< of all coarse triangles: then the nearest one
  };
  /// A side of fine triangles, by its midpoint: for fields that are linear in an element. A third of the area times the
  /// sum over the three midpoints is the exact integral of a quadratic over a triangle (Strang and Fix 1973).
  struct Side {
    double area = 0;                     ///< m2, a third of that of the triangles at it
    std::array<std::int32_t, 2> fine{};  ///< nodes; the value is their mean
    std::array<std::int32_t, 3> coarse{};
    std::array<double, 3> weights{};  ///< of the coarse nodes
    bool outside = false;
  };
  std::vector<Element> elements;  ///< in the order of the fine triangles
  std::vector<Side> sides;        ///< in the order of their nodes
};

/// Finds every fine triangle and side on the coarse mesh. Places that are `blur` (m) or less apart are the same; meshes
/// with the same corners are not searched, so that equal fields differ by exactly nothing. Throws OutputError where a
/// mesh has no area.
Projection project(const BodyMesh& coarse, const BodyMesh& fine, double blur);

/// Sums over the points of comparison, of one body after another. A difference that is no number makes all that is
/// asked of it no number.
struct DifferenceSums {
  CompensatedSum area;        ///< m2
  CompensatedSum difference;  ///< of area times square
  CompensatedSum size;        ///< of the fine field
  double max_squared = 0;
  double largest_squared = 0;
  std::size_t outside = 0;  ///< points

  void add(double area_here, double difference_squared, double fine_squared, bool is_outside);
  [[nodiscard]] double l2() const;       ///< sqrt(int |a - b|^2 dA / A), in the unit of the field
  [[nodiscard]] double fine_l2() const;  ///< sqrt(int |b|^2 dA / A)
  [[nodiscard]] double max() const;      ///< the largest |a - b|
  [[nodiscard]] double largest() const;  ///< the largest |b|
};

/// Adds a field with a number for each triangle of a frame.
void add_elements(const Projection& projection, std::span<const double> coarse, std::span<const double> fine,
                  DifferenceSums& sums);
/// Adds a field with so many components for each node of a frame, one node after another; |a - b| is their length.
void add_nodes(const Projection& projection, std::size_t components, std::span<const double> coarse,
               std::span<const double> fine, DifferenceSums& sums);

}  // namespace udar

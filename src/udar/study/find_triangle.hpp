#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "udar/base/box.hpp"
#include "udar/base/vec2.hpp"

namespace udar {

/// A triangle, and where in it a point is.
struct TriangleAt {
  std::int32_t triangle = -1;
  /// For each corner its part of a linear function's value at the point; they sum to 1, and one is negative outside.
  std::array<double, 3> weights{};
  bool outside = false;  ///< the point is in no triangle, and this is the nearest one
};

/// Finds triangles of one mesh by place. What it finds depends on the mesh and the point only, not on what was asked
/// before: a walk from the last triangle would be as fast, but picks by its way among those that share an edge.
class TriangleFinder {
 public:
  using Corners = std::array<Vec2, 3>;

  /// `blur` (m) is how well the places are known: a point that near counts as inside. Triangles without area are never
  /// found. Throws OutputError where no other ones are there, or where a place is no number.
  TriangleFinder(std::vector<Corners> triangles, double blur);

  /// The triangle that holds the point, of several (on an edge) the first; else the one nearest to it.
  [[nodiscard]] TriangleAt find(Vec2 point) const;

 private:
  void make_bins();
  void fill_bins();
  [[nodiscard]] std::int32_t column(double x) const;
  [[nodiscard]] std::int32_t row(double y) const;
  [[nodiscard]] bool holds(std::int32_t triangle, Vec2 point) const;
  [[nodiscard]] std::int32_t nearest(Vec2 point) const;
  template <class Visit>
  void for_each_in(std::int32_t i, std::int32_t j, Visit visit) const;
  template <class Visit>
  void for_each_in_ring(std::int32_t i, std::int32_t j, std::int32_t ring, Visit visit) const;

  std::vector<Corners> triangles_;
  double blur_ = 0;
  // Bins of one size over the mesh, row by row; begins_[b] to begins_[b + 1] in members_ are the triangles of bin b.
  Box box_;
  std::int32_t columns_ = 1;
  std::int32_t rows_ = 1;
  Vec2 bin_size_{};  ///< m
  std::vector<std::size_t> begins_;
  std::vector<std::int32_t> members_;
};

}  // namespace udar

#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "udar/mesh/mesh.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// Where a mesh is finer than elsewhere. The generators have the same members, with `finest_` before the first four.
struct Grading {
  std::optional<double> size;  ///< m, of the finest elements, as the shape measures its element_size; none: no grading
  std::optional<Vec2> at;      ///< m, the point where they are, of the placed body
  std::string side;            ///< or the named side along which they are
  double within = 0;           ///< m, as far from the point or side as this all are of the finest size
  double growth = 1.2;         ///< beyond that, elements grow by this factor from each to the next
};

/// Why a shape cannot be graded so: the key that is wrong, and what, why and the cure.
struct GradingFault {
  std::string key;
  std::string message;
  std::string reason;
  std::string cure;
};

/// What `grading_fault` must know of a shape.
struct GradedShape {
  double element_size = 0;         ///< m
  std::vector<std::string> sides;  ///< those that it has
  double outside = 0;              ///< m, how far the point lies outside the shape; 0 or less inside
};

std::optional<GradingFault> grading_fault(const Grading& grading, const GradedShape& shape);
[[noreturn]] void throw_fault(const GradingFault& fault);

/// Distance of a place from the finest place, m. May be too small, never too large, and must change by no more than the
/// place moves.
using DistanceTo = std::function<double(Vec2)>;
/// Where the middle of an edge of the named side belongs: on a circle, say.
using OntoSide = std::function<Vec2(const std::string& side, Vec2 middle)>;

/// Size of the elements that refinement starts from: the largest of size, 2 size, 4 size, ... that is not above
/// `element_size`. Halving it leads back to the finest size exactly.
double coarse_size(const Grading& grading, double element_size);

/// Splits the triangles of a mesh, all of about coarse_size, until none is larger than the grading allows: its finest
/// size up to `within`, and beyond that larger by (growth - 1) times the distance.
///
/// A triangle is halved from its first corner to the middle of the opposite side, its base; so are its halves, from the
/// new corner (newest vertex bisection: Mitchell, ACM Trans. Math. Softw. 15 (1989) 326). Where all three sides are
/// halved the middles are joined instead if they are nearer to each other (red; Bank et al. 1983). The base must be
/// that of the neighbour behind it too, or bad shapes may come out. Right isosceles triangles upon their hypotenuse
/// then have only such parts, of 45 degrees; equilateral ones have none below 30. A tensor grid, graded in rows and
/// columns, was rejected: it carries its fine rows and columns through the whole body, as needles.
///
/// Nothing depends on the order of triangles, so a symmetric mesh stays symmetric. Named sides stay themselves. Nodes
/// and triangles are numbered as they come, those of the mesh first. Throws UserError(bad_mesh) where there are too
/// many triangles.
Mesh refine(Mesh mesh, const Grading& grading, double element_size, const DistanceTo& distance,
            const OntoSide& onto = nullptr);

/// Turns the corners of every triangle so that its longest side comes to be its base.
void longest_side_as_base(Mesh& mesh);

// --- for the generators

template <class Shape>
Grading grading_of(const Shape& s) {
  return {s.finest_size, s.finest_at, s.finest_side, s.finest_within, s.growth};
}

template <class Shape>
std::optional<GradingFault> grading_fault(const Shape& s) {
  return grading_fault(grading_of(s), {s.element_size,
                                       {Shape::side_names.begin(), Shape::side_names.end()},
                                       s.finest_at ? s.distance_outside(*s.finest_at) : 0});
}

/// Throws UserError(bad_mesh) for the first such fault.
template <class Shape>
void check_grading(const Shape& s) {
  if (const auto fault = grading_fault(s)) throw_fault(*fault);
}

/// The mesh that is refined.
template <class Shape>
Shape ungraded(Shape s) {
  s.element_size = coarse_size(grading_of(s), s.element_size);
  s.finest_size.reset();
  s.finest_at.reset();
  s.finest_side.clear();
  return s;
}

/// The keys of a grading.
template <class Shape>
void add_grading_parameters(std::vector<Parameter<Shape>>& all) {
  Choice<Shape> sides{
      {"none"},
      [](Shape& s, int word) {
        s.finest_side = word == 0 ? "" : Shape::side_names[static_cast<std::size_t>(word) - 1];
      },
      [](const Shape& s) {
        const auto found = std::ranges::find(Shape::side_names, s.finest_side);
        return found == Shape::side_names.end() ? 0 : static_cast<int>(found - Shape::side_names.begin()) + 1;
      }};
  sides.words.insert(sides.words.end(), Shape::side_names.begin(), Shape::side_names.end());
  all.push_back({"finest_size", &Shape::finest_size, dimension::length, limits::positive,
                 "a smaller element_size near finest_at or finest_side; elsewhere elements are 2, 4, 8, ... times as "
                 "large, up to element_size",
                 false, "\"0.25 mm\""});
  all.push_back({"finest_at",
                 &Shape::finest_at,
                 dimension::length,
                 {},
                 "the point of the body where elements are finest",
                 false});
  all.push_back({"finest_side",
                 sides,
                 dimension::number,
                 {},
                 "the side along which elements are finest",
                 false,
                 "\"" + std::string(Shape::side_names.front()) + "\""});
  all.push_back({"finest_within", &Shape::finest_within, dimension::length, limits::not_negative,
                 "how far from the point or side elements are still of the finest size", false});
  all.push_back({"growth", &Shape::growth, dimension::number, Limits{.low = 1, .high = 2, .low_included = false},
                 "beyond that, size of an element over that of the one before it, on the mean", false, "1.3"});
}

}  // namespace udar

#pragma once

#include <type_traits>
#include <variant>

#include "udar/contact/circle.hpp"
#include "udar/contact/half_plane.hpp"
#include "udar/contact/polygon.hpp"

namespace udar {

/// Every shape of a rigid obstacle. A new one is added here and nowhere else: a struct with keyword, doc, parameters()
/// and prepared(), whose result has gap(point), holds(point), inner_radius(), is_crossed(from, to), outline(view) and
/// bounds().
using Shape = std::variant<HalfPlane, Rectangle, Polygon, Circle>;

/// A variant of the distinct types among those already in `Done` and `Rest`.
template <class Done, class... Rest>
struct Distinct {
  using type = Done;
};
template <class... Done, class First, class... Rest>
struct Distinct<std::variant<Done...>, First, Rest...>
    : std::conditional_t<(std::is_same_v<First, Done> || ...), Distinct<std::variant<Done...>, Rest...>,
                         Distinct<std::variant<Done..., First>, Rest...>> {};

template <class Shapes>
struct PreparedShapes;
template <class First, class... Rest>
struct PreparedShapes<std::variant<First, Rest...>>
    : Distinct<std::variant<decltype(First{}.prepared())>, decltype(Rest{}.prepared())...> {};

/// A shape made ready once for many questions: unit normals known, corners counter-clockwise. Hot loops visit it once,
/// outside of the loop, and call gap() of what they find.
using PreparedShape = PreparedShapes<Shape>::type;

/// Throws UserError(bad_case) where the shape makes no sense (no direction, no area, not convex).
PreparedShape prepare(const Shape& shape);

/// Where `point` (m) stands to the boundary. Of pieces equally near, the lower one counts.
Gap gap(const PreparedShape& shape, Vec2 point);

/// The boundary for drawing (m); what is endless is cut at `view`.
std::vector<Polyline> outline(const PreparedShape& shape, const Box& view);

/// The largest depth that a point in it can have, m; endless where the obstacle is.
double inner_radius(const PreparedShape& shape);

/// A box that holds the obstacle; endless where it is.
Box bounds(const PreparedShape& shape);

}  // namespace udar

#pragma once

#include "udar/case/case.hpp"

namespace udar::heap {

/// How the discs lie.
enum class Layout {
  heap,   ///< in a box, nearly touching, each with a velocity of its own: most touch neighbours soon
  apart,  ///< the same discs far from each other, without the box: nothing touches
};

inline constexpr double radius = 0.005;  ///< m
inline constexpr int rings = 6;          ///< of elements in a disc: 216 triangles

/// Discs of plastic in a hexagonal packing, a little irregular, falling in a box of three planes; friction and damping
/// of contact. The same case for the same number on every machine.
Case case_of(int discs, Layout layout);

/// The triangles of all discs as a single body that is not to touch itself: what they cost without contact and without
/// bodies to keep books of.
struct OneBody {
  Case input;
  Mesh mesh;
};
OneBody one_body(int discs);

}  // namespace udar::heap

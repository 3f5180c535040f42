#pragma once

#include <cmath>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace udar {

// Physics is written once on a number type: a double, or a pack of lanes that a processor computes at the same time.
// Branches become `select`. Only + - * / and sqrt, which every processor rounds alike: the bits do not depend on how
// many lanes there are.

/// `a` where the mask holds, else `b`.
inline double select(bool mask, double a, double b) { return mask ? a : b; }
inline double larger(double a, double b) { return a > b ? a : b; }
inline double smaller(double a, double b) { return a < b ? a : b; }

/// Lanes of one vector register of any x86-64 or 64-bit ARM: two doubles. GCC's and clang's vector extension, not left
/// to the compiler's own vectoriser, which gives up on loops as long as ours without saying so.
struct Pack {
  static constexpr int lanes = 2;
  using Vector = double __attribute__((vector_size(lanes * sizeof(double))));
  using Mask = decltype(Vector{} > Vector{});
  Vector v;

  Pack() = default;
  Pack(Vector vector) : v(vector) {}
  explicit Pack(double s) : v{s, s} {}

  static Pack load(const double* from) { return Pack(*reinterpret_cast<const Vector*>(from)); }
  void store(double* to) const { *reinterpret_cast<Vector*>(to) = v; }

  friend Pack operator+(Pack a, Pack b) { return a.v + b.v; }
  friend Pack operator-(Pack a, Pack b) { return a.v - b.v; }
  friend Pack operator*(Pack a, Pack b) { return a.v * b.v; }
  friend Pack operator/(Pack a, Pack b) { return a.v / b.v; }
  friend Pack operator-(Pack a) { return -a.v; }
  friend Mask operator>(Pack a, Pack b) { return a.v > b.v; }
  friend Mask operator<(Pack a, Pack b) { return a.v < b.v; }

  friend Pack select(Mask mask, Pack a, Pack b) { return mask ? a.v : b.v; }
  friend Pack larger(Pack a, Pack b) { return a.v > b.v ? a.v : b.v; }
  friend Pack smaller(Pack a, Pack b) { return a.v < b.v ? a.v : b.v; }
  friend Pack fabs(Pack a) { return a.v < 0 ? -a.v : a.v; }
  friend Pack sqrt(Pack a) {
#if defined(__SSE2__)
    return Vector(_mm_sqrt_pd(a.v));
#else
    return Vector{std::sqrt(a.v[0]), std::sqrt(a.v[1])};
#endif
  }
};

}  // namespace udar

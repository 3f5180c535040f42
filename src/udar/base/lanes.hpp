#pragma once

#include <cmath>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

// The instruction set that the including unit is compiled for. It names a namespace, so that functions compiled for one
// never take the place of those for another when the program is linked.
#ifndef UDAR_ISA
#define UDAR_ISA baseline
#endif

namespace udar {

// Physics is written once on a number type: a double, or a pack of lanes that a processor computes at the same time.
// Branches become `select`. Only + - * / and sqrt, which every processor rounds alike: the bits do not depend on how
// many lanes there are.

/// `a` where the mask holds, else `b`.
[[gnu::always_inline]] inline double select(bool mask, double a, double b) { return mask ? a : b; }
[[gnu::always_inline]] inline double larger(double a, double b) { return a > b ? a : b; }
[[gnu::always_inline]] inline double smaller(double a, double b) { return a < b ? a : b; }

namespace UDAR_ISA {

/// As many doubles as one vector register holds. GCC's and clang's vector extension: not left to the compiler's own
/// vectoriser, which gives up on loops as long as ours without saying so.
struct Pack {
#if defined(__AVX512F__)
  static constexpr int lanes = 8;
#elif defined(__AVX2__)
  static constexpr int lanes = 4;
#else
  static constexpr int lanes = 2;
#endif
  using Vector = double __attribute__((vector_size(lanes * sizeof(double))));
  using Mask = decltype(Vector{} > Vector{});
  Vector v;

  Pack() = default;
  Pack(Vector vector) : v(vector) {}
  explicit Pack(double s) : v(Vector{} + s) {}

  // Arrays begin where the allocator says. A builtin, so that no library function is compiled for these instructions.
  static Pack load(const double* from) {
    Vector vector;
    __builtin_memcpy(&vector, from, sizeof vector);
    return vector;
  }
  void store(double* to) const { __builtin_memcpy(to, &v, sizeof v); }

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
#if defined(__AVX512F__)
    return Vector(_mm512_sqrt_pd(a.v));
#elif defined(__AVX2__)
    return Vector(_mm256_sqrt_pd(a.v));
#elif defined(__SSE2__)
    return Vector(_mm_sqrt_pd(a.v));
#else
    return Vector{std::sqrt(a.v[0]), std::sqrt(a.v[1])};
#endif
  }
};

}  // namespace UDAR_ISA

}  // namespace udar

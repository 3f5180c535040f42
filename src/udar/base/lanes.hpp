#pragma once

#include <cmath>

#if defined(__AVX2__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>  // most units include a law, and that one takes a third of a second
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
/// Does the mask hold in any lane?
[[gnu::always_inline]] inline bool any(bool mask) { return mask; }

namespace UDAR_ISA {

using udar::any;
using udar::larger;
using udar::select;
using udar::smaller;

/// As many doubles as one vector register holds. GCC's and clang's vector extension: not left to the compiler's own
/// vectoriser, which gives up on loops as long as ours without saying so. Comparisons, `larger` and `sqrt` are named
/// instructions, since g++ 12 makes several of each out of the extension's.
struct Pack {
#if defined(__AVX512F__)
  static constexpr int lanes = 8;
#elif defined(__AVX2__)
  static constexpr int lanes = 4;
#else
  static constexpr int lanes = 2;
#endif
  using Vector = double __attribute__((vector_size(lanes * sizeof(double))));
  Vector v;

  Pack() = default;
  Pack(Vector vector) : v(vector) {}
  explicit Pack(double s) : v(s - Vector{}) {}  // + would lose the sign of a zero

  // Arrays begin where the allocator says. Named instructions, since g++ 12 may make two halves of a copy of 32 bytes,
  // which the next reader then has to wait for.
#if defined(__AVX512F__)
  static Pack load(const double* from) { return Vector(_mm512_loadu_pd(from)); }
  void store(double* to) const { _mm512_storeu_pd(to, v); }
#elif defined(__AVX2__)
  static Pack load(const double* from) { return Vector(_mm256_loadu_pd(from)); }
  void store(double* to) const { _mm256_storeu_pd(to, v); }
#elif defined(__SSE2__)
  static Pack load(const double* from) { return Vector(_mm_loadu_pd(from)); }
  void store(double* to) const { _mm_storeu_pd(to, v); }
#else
  static Pack load(const double* from) { return Vector{from[0], from[1]}; }
  void store(double* to) const { to[0] = v[0], to[1] = v[1]; }
#endif

  friend Pack operator+(Pack a, Pack b) { return a.v + b.v; }
  friend Pack operator-(Pack a, Pack b) { return a.v - b.v; }
  friend Pack operator*(Pack a, Pack b) { return a.v * b.v; }
  friend Pack operator/(Pack a, Pack b) { return a.v / b.v; }
  friend Pack operator-(Pack a) { return -a.v; }
};

#if defined(__AVX512F__)

struct Mask {
  __mmask8 lanes;

  friend bool any(Mask m) { return m.lanes != 0; }
  /// Bit i is lane i.
  friend unsigned bits(Mask m) { return m.lanes; }
};
inline Mask operator>(Pack a, Pack b) { return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_GT_OQ)}; }
inline Mask operator<(Pack a, Pack b) { return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ)}; }
inline Pack select(Mask m, Pack a, Pack b) { return Pack::Vector(_mm512_mask_blend_pd(m.lanes, b.v, a.v)); }
inline Pack larger(Pack a, Pack b) { return Pack::Vector(_mm512_max_pd(a.v, b.v)); }
inline Pack smaller(Pack a, Pack b) { return Pack::Vector(_mm512_min_pd(a.v, b.v)); }
inline Pack fabs(Pack a) { return Pack::Vector(_mm512_abs_pd(a.v)); }
inline Pack sqrt(Pack a) { return Pack::Vector(_mm512_sqrt_pd(a.v)); }

#else

struct Mask {
  Pack::Vector lanes;  ///< all bits of a lane, or none

  friend bool any(Mask m) { return bits(m) != 0; }
  /// Bit i is lane i.
  friend unsigned bits(Mask m) {
#if defined(__AVX2__)
    return static_cast<unsigned>(_mm256_movemask_pd(m.lanes));
#elif defined(__SSE2__)
    return static_cast<unsigned>(_mm_movemask_pd(m.lanes));
#else
    const auto lane = decltype(Pack::Vector{} > Pack::Vector{})(m.lanes);
    return static_cast<unsigned>((lane[0] & 1) | (lane[1] & 2));
#endif
  }
};
inline Mask operator>(Pack a, Pack b) { return {Pack::Vector(a.v > b.v)}; }
inline Mask operator<(Pack a, Pack b) { return {Pack::Vector(a.v < b.v)}; }
inline Pack select(Mask m, Pack a, Pack b) { return decltype(Pack::Vector{} > Pack::Vector{})(m.lanes) ? a.v : b.v; }
inline Pack fabs(Pack a) {
  using Bits = decltype(Pack::Vector{} > Pack::Vector{});
  return Pack::Vector(Bits(a.v) & ~Bits(Pack(-0.0).v));  // a comparison would leave the sign of a zero
}
#if defined(__AVX2__)
inline Pack larger(Pack a, Pack b) { return Pack::Vector(_mm256_max_pd(a.v, b.v)); }
inline Pack smaller(Pack a, Pack b) { return Pack::Vector(_mm256_min_pd(a.v, b.v)); }
inline Pack sqrt(Pack a) { return Pack::Vector(_mm256_sqrt_pd(a.v)); }
#elif defined(__SSE2__)
inline Pack larger(Pack a, Pack b) { return Pack::Vector(_mm_max_pd(a.v, b.v)); }
inline Pack smaller(Pack a, Pack b) { return Pack::Vector(_mm_min_pd(a.v, b.v)); }
inline Pack sqrt(Pack a) { return Pack::Vector(_mm_sqrt_pd(a.v)); }
#else
inline Pack larger(Pack a, Pack b) { return a.v > b.v ? a.v : b.v; }
inline Pack smaller(Pack a, Pack b) { return a.v < b.v ? a.v : b.v; }
inline Pack sqrt(Pack a) { return Pack::Vector{std::sqrt(a.v[0]), std::sqrt(a.v[1])}; }
#endif

#endif

}  // namespace UDAR_ISA

}  // namespace udar

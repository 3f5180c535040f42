#pragma once

#include "beam.hpp"
#include "udar/base/lanes.hpp"

// Between memory, where a node's numbers stand side by side, and registers, where those of different nodes do. Lane l
// of a pack belongs to pair l of the group whatever the width.

namespace roof::UDAR_ISA {

using udar::UDAR_ISA::Pack;
using Vector = Pack::Vector;

/// A side of triangles, m, and its velocity, m/s.
struct Side {
  Pack x, y, vx, vy;
};

struct PackForce {
  Pack x, y;
};

// Four registers hold the records of as many nodes as there are lanes. Nodes are told by their offsets in bytes.

#if defined(__AVX512F__)
// An insert straight from memory: the general shuffle that the compilers make of two loads takes the one port that the
// transposes need.
[[gnu::always_inline]] inline Vector two(const char* nodes, Index low, Index high) {
  const auto at = [&](Index offset) { return _mm256_load_pd(reinterpret_cast<const double*>(nodes + offset)); };
  return _mm512_insertf64x4(_mm512_castpd256_pd512(at(low)), at(high), 1);
}

struct Records {
  Vector r[4];

  [[gnu::always_inline]] static Records load(const char* nodes, const Index* i) {
    return {{two(nodes, i[0], i[2]), two(nodes, i[1], i[3]), two(nodes, i[4], i[6]), two(nodes, i[5], i[7])}};
  }
  [[gnu::always_inline]] Side transposed() const {
    const Vector x01 = __builtin_shufflevector(r[0], r[1], 0, 8, 2, 10, 4, 12, 6, 14);
    const Vector y01 = __builtin_shufflevector(r[0], r[1], 1, 9, 3, 11, 5, 13, 7, 15);
    const Vector x23 = __builtin_shufflevector(r[2], r[3], 0, 8, 2, 10, 4, 12, 6, 14);
    const Vector y23 = __builtin_shufflevector(r[2], r[3], 1, 9, 3, 11, 5, 13, 7, 15);
    return {Vector(__builtin_shufflevector(x01, x23, 0, 1, 4, 5, 8, 9, 12, 13)),
            Vector(__builtin_shufflevector(y01, y23, 0, 1, 4, 5, 8, 9, 12, 13)),
            Vector(__builtin_shufflevector(x01, x23, 2, 3, 6, 7, 10, 11, 14, 15)),
            Vector(__builtin_shufflevector(y01, y23, 2, 3, 6, 7, 10, 11, 14, 15))};
  }
};

[[gnu::always_inline]] inline Pack magnitude(Pack a) { return Vector(_mm512_abs_pd(a.v)); }
[[gnu::always_inline]] inline bool any_larger(Pack a, Pack b) { return _mm512_cmp_pd_mask(a.v, b.v, _CMP_GT_OQ) != 0; }

/// x and y side by side, 16 bytes a node.
[[gnu::always_inline]] inline void store_interleaved(Force* to, PackForce f) {
  const Vector even = __builtin_shufflevector(f.x.v, f.y.v, 0, 8, 2, 10, 4, 12, 6, 14);
  const Vector odd = __builtin_shufflevector(f.x.v, f.y.v, 1, 9, 3, 11, 5, 13, 7, 15);
  __builtin_memcpy(to, &even, sizeof even);
  __builtin_memcpy(to + 4, &odd, sizeof odd);
}
inline constexpr Index slot_of_lane[] = {0, 4, 1, 5, 2, 6, 3, 7};

#elif defined(__AVX2__)
struct Records {
  Vector r[4];

  [[gnu::always_inline]] static Records load(const char* nodes, const Index* i) {
    // A memcpy would go through memory in halves, whose load as a whole then waits for both to be stored.
    const auto at = [&](Index offset) { return _mm256_load_pd(reinterpret_cast<const double*>(nodes + offset)); };
    return {{at(i[0]), at(i[1]), at(i[2]), at(i[3])}};
  }
  [[gnu::always_inline]] Side transposed() const {
    const Vector x01 = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6);
    const Vector y01 = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
    const Vector x23 = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6);
    const Vector y23 = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
    return {
        Vector(__builtin_shufflevector(x01, x23, 0, 1, 4, 5)), Vector(__builtin_shufflevector(y01, y23, 0, 1, 4, 5)),
        Vector(__builtin_shufflevector(x01, x23, 2, 3, 6, 7)), Vector(__builtin_shufflevector(y01, y23, 2, 3, 6, 7))};
  }
};

[[gnu::always_inline]] inline Pack magnitude(Pack a) { return Vector(_mm256_andnot_pd(_mm256_set1_pd(-0.0), a.v)); }
[[gnu::always_inline]] inline bool any_larger(Pack a, Pack b) {
  return _mm256_movemask_pd(_mm256_cmp_pd(a.v, b.v, _CMP_GT_OQ)) != 0;
}

[[gnu::always_inline]] inline void store_interleaved(Force* to, PackForce f) {
  const Vector even = __builtin_shufflevector(f.x.v, f.y.v, 0, 4, 2, 6);
  const Vector odd = __builtin_shufflevector(f.x.v, f.y.v, 1, 5, 3, 7);
  __builtin_memcpy(to, &even, sizeof even);
  __builtin_memcpy(to + 2, &odd, sizeof odd);
}
inline constexpr Index slot_of_lane[] = {0, 2, 1, 3};

#else
struct Records {
  Vector r[4];

  [[gnu::always_inline]] static Records load(const char* nodes, const Index* i) {
    Records out;
    __builtin_memcpy(&out.r[0], nodes + i[0], sizeof(Vector));
    __builtin_memcpy(&out.r[1], nodes + i[0] + sizeof(Vector), sizeof(Vector));
    __builtin_memcpy(&out.r[2], nodes + i[1], sizeof(Vector));
    __builtin_memcpy(&out.r[3], nodes + i[1] + sizeof(Vector), sizeof(Vector));
    return out;
  }
  [[gnu::always_inline]] Side transposed() const {
    return {Vector(__builtin_shufflevector(r[0], r[2], 0, 2)), Vector(__builtin_shufflevector(r[0], r[2], 1, 3)),
            Vector(__builtin_shufflevector(r[1], r[3], 0, 2)), Vector(__builtin_shufflevector(r[1], r[3], 1, 3))};
  }
};

[[gnu::always_inline]] inline Pack magnitude(Pack a) { return fabs(a); }
[[gnu::always_inline]] inline bool any_larger(Pack a, Pack b) { return a.v[0] > b.v[0] || a.v[1] > b.v[1]; }

[[gnu::always_inline]] inline void store_interleaved(Force* to, PackForce f) {
  const Vector low = __builtin_shufflevector(f.x.v, f.y.v, 0, 2);
  const Vector high = __builtin_shufflevector(f.x.v, f.y.v, 1, 3);
  __builtin_memcpy(to, &low, sizeof low);
  __builtin_memcpy(to + 1, &high, sizeof high);
}
inline constexpr Index slot_of_lane[] = {0, 1};
#endif

/// Differences of records before they are transposed: three transposes for four corners.
[[gnu::always_inline]] inline Side side(const Records& from, const Records& to) {
  return Records{{to.r[0] - from.r[0], to.r[1] - from.r[1], to.r[2] - from.r[2], to.r[3] - from.r[3]}}.transposed();
}

}  // namespace roof::UDAR_ISA

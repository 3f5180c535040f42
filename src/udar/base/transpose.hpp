#pragma once

#include "udar/base/lanes.hpp"

namespace udar::UDAR_ISA {

/// As many records of four doubles as a pack has lanes, in the order in which memory has them. They can be added and
/// subtracted as they are; `columns` turns them into packs, which costs shuffles.
struct Records {
  Pack part[4];

  friend Records operator-(const Records& a, const Records& b) {
    return {{a.part[0] - b.part[0], a.part[1] - b.part[1], a.part[2] - b.part[2], a.part[3] - b.part[3]}};
  }
};

/// Numbers 0 to 3 of each record, record by lane.
struct Columns {
  Pack at[4];
};

#if defined(__AVX512F__)

/// Two records in one register. The second one is inserted straight from memory: the shuffle that compilers make of two
/// loads takes the only port that can shuffle.
inline Pack two_records(const double* low, const double* high) {
  return Pack::Vector(_mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(low)), _mm256_loadu_pd(high), 1));
}

/// The records at address(0), address(1), ...
template <class Address>
Records load_records(Address address) {
  // Records 0 and 2 share a register, 1 and 3, 4 and 6, 5 and 7: the last shuffle then moves whole quarters.
  return {{two_records(address(0), address(2)), two_records(address(1), address(3)),
           two_records(address(4), address(6)), two_records(address(5), address(7))}};
}
template <class Address>
void store_records(const Records& r, Address address) {
  constexpr int first[] = {0, 1, 4, 5};
  for (int k = 0; k < 4; ++k) {
    _mm256_storeu_pd(address(first[k]), _mm512_castpd512_pd256(r.part[k].v));
    _mm256_storeu_pd(address(first[k] + 2), _mm512_extractf64x4_pd(r.part[k].v, 1));
  }
}

inline Pack even_lanes(Pack a, Pack b) { return __builtin_shufflevector(a.v, b.v, 0, 8, 2, 10, 4, 12, 6, 14); }
inline Pack odd_lanes(Pack a, Pack b) { return __builtin_shufflevector(a.v, b.v, 1, 9, 3, 11, 5, 13, 7, 15); }
inline Pack even_quarters(Pack a, Pack b) { return __builtin_shufflevector(a.v, b.v, 0, 1, 4, 5, 8, 9, 12, 13); }
inline Pack odd_quarters(Pack a, Pack b) { return __builtin_shufflevector(a.v, b.v, 2, 3, 6, 7, 10, 11, 14, 15); }

inline Columns columns(const Records& r) {
  const Pack x_vx_0 = even_lanes(r.part[0], r.part[1]);
  const Pack y_vy_0 = odd_lanes(r.part[0], r.part[1]);
  const Pack x_vx_4 = even_lanes(r.part[2], r.part[3]);
  const Pack y_vy_4 = odd_lanes(r.part[2], r.part[3]);
  return {{even_quarters(x_vx_0, x_vx_4), even_quarters(y_vy_0, y_vy_4), odd_quarters(x_vx_0, x_vx_4),
           odd_quarters(y_vy_0, y_vy_4)}};
}
inline Records records(const Columns& c) {
  const auto low = [](Pack a, Pack b) -> Pack { return __builtin_shufflevector(a.v, b.v, 0, 1, 8, 9, 2, 3, 10, 11); };
  const auto high = [](Pack a, Pack b) -> Pack {
    return __builtin_shufflevector(a.v, b.v, 4, 5, 12, 13, 6, 7, 14, 15);
  };
  const Pack x_vx_0 = low(c.at[0], c.at[2]);
  const Pack x_vx_4 = high(c.at[0], c.at[2]);
  const Pack y_vy_0 = low(c.at[1], c.at[3]);
  const Pack y_vy_4 = high(c.at[1], c.at[3]);
  return {
      {even_lanes(x_vx_0, y_vy_0), odd_lanes(x_vx_0, y_vy_0), even_lanes(x_vx_4, y_vy_4), odd_lanes(x_vx_4, y_vy_4)}};
}
/// The packs of x and of y from pairs (x, y) that stand one after another.
inline void split_pairs(Pack first, Pack second, Pack& x, Pack& y) {
  x = Pack(__builtin_shufflevector(first.v, second.v, 0, 2, 4, 6, 8, 10, 12, 14));
  y = Pack(__builtin_shufflevector(first.v, second.v, 1, 3, 5, 7, 9, 11, 13, 15));
}
inline void join_pairs(Pack x, Pack y, Pack& first, Pack& second) {
  first = Pack(__builtin_shufflevector(x.v, y.v, 0, 8, 1, 9, 2, 10, 3, 11));
  second = Pack(__builtin_shufflevector(x.v, y.v, 4, 12, 5, 13, 6, 14, 7, 15));
}

#elif defined(__AVX2__)

template <class Address>
Records load_records(Address address) {
  return {{Pack::load(address(0)), Pack::load(address(1)), Pack::load(address(2)), Pack::load(address(3))}};
}
template <class Address>
void store_records(const Records& r, Address address) {
  for (int k = 0; k < 4; ++k) r.part[k].store(address(k));
}

inline Pack even_lanes(Pack a, Pack b) { return __builtin_shufflevector(a.v, b.v, 0, 4, 2, 6); }
inline Pack odd_lanes(Pack a, Pack b) { return __builtin_shufflevector(a.v, b.v, 1, 5, 3, 7); }
inline Pack low_halves(Pack a, Pack b) { return __builtin_shufflevector(a.v, b.v, 0, 1, 4, 5); }
inline Pack high_halves(Pack a, Pack b) { return __builtin_shufflevector(a.v, b.v, 2, 3, 6, 7); }

/// Its own inverse: four by four.
inline Columns columns(const Records& r) {
  const Pack a = even_lanes(r.part[0], r.part[1]);
  const Pack b = odd_lanes(r.part[0], r.part[1]);
  const Pack c = even_lanes(r.part[2], r.part[3]);
  const Pack d = odd_lanes(r.part[2], r.part[3]);
  return {{low_halves(a, c), low_halves(b, d), high_halves(a, c), high_halves(b, d)}};
}
inline Records records(const Columns& c) {
  const Columns r = columns({{c.at[0], c.at[1], c.at[2], c.at[3]}});
  return {{r.at[0], r.at[1], r.at[2], r.at[3]}};
}
inline void split_pairs(Pack first, Pack second, Pack& x, Pack& y) {
  x = Pack(__builtin_shufflevector(first.v, second.v, 0, 2, 4, 6));
  y = Pack(__builtin_shufflevector(first.v, second.v, 1, 3, 5, 7));
}
inline void join_pairs(Pack x, Pack y, Pack& first, Pack& second) {
  first = Pack(__builtin_shufflevector(x.v, y.v, 0, 4, 1, 5));
  second = Pack(__builtin_shufflevector(x.v, y.v, 2, 6, 3, 7));
}

#else

template <class Address>
Records load_records(Address address) {
  return {{Pack::load(address(0)), Pack::load(address(0) + 2), Pack::load(address(1)), Pack::load(address(1) + 2)}};
}
template <class Address>
void store_records(const Records& r, Address address) {
  r.part[0].store(address(0));
  r.part[1].store(address(0) + 2);
  r.part[2].store(address(1));
  r.part[3].store(address(1) + 2);
}

inline Pack even_lanes(Pack a, Pack b) { return __builtin_shufflevector(a.v, b.v, 0, 2); }
inline Pack odd_lanes(Pack a, Pack b) { return __builtin_shufflevector(a.v, b.v, 1, 3); }

inline Columns columns(const Records& r) {
  return {{even_lanes(r.part[0], r.part[2]), odd_lanes(r.part[0], r.part[2]), even_lanes(r.part[1], r.part[3]),
           odd_lanes(r.part[1], r.part[3])}};
}
inline Records records(const Columns& c) {
  return {{even_lanes(c.at[0], c.at[1]), even_lanes(c.at[2], c.at[3]), odd_lanes(c.at[0], c.at[1]),
           odd_lanes(c.at[2], c.at[3])}};
}
inline void split_pairs(Pack first, Pack second, Pack& x, Pack& y) {
  x = even_lanes(first, second);
  y = odd_lanes(first, second);
}
inline void join_pairs(Pack x, Pack y, Pack& first, Pack& second) {
  first = even_lanes(x, y);
  second = odd_lanes(x, y);
}

#endif

}  // namespace udar::UDAR_ISA

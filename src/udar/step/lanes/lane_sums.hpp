#pragma once

// Part of block_kernels.cpp, which is compiled for each instruction set: everything lives in a namespace of its name.

#include "udar/base/lanes.hpp"
#include "udar/mesh/blocks.hpp"

namespace udar::UDAR_ISA {
namespace {

/// Sum of the eight partial sums of a block: lane k and k + 4, then k and k + 2, then the last two. The order is fixed,
/// whatever computes it.
inline double sum_of_lanes(const double (&lane)[lanes]) {
  static_assert(lanes == 8);
  using Four = double __attribute__((vector_size(32)));
  Four low, high;
  __builtin_memcpy(&low, lane, sizeof low);
  __builtin_memcpy(&high, lane + 4, sizeof high);
  const Four four = low + high;
  return (four[0] + four[2]) + (four[1] + four[3]);
}

/// The same of sums that are kept in registers.
inline double sum_of_lanes(const Pack (&packs)[lanes / Pack::lanes]) {
  double lane[lanes];
  for (Index p = 0; p < lanes / Pack::lanes; ++p) packs[p].store(lane + p * Pack::lanes);
  return sum_of_lanes(lane);
}

}  // namespace
}  // namespace udar::UDAR_ISA

#pragma once

#include <string>
#include <vector>

#include "udar/step/block_kernels.hpp"

namespace udar {

struct NamedKernels {
  std::string name;
  BlockKernels kernels;
};

/// The kernels of every instruction set that this processor can run, the narrowest first.
inline std::vector<NamedKernels> kernels_here() {
  std::vector<NamedKernels> found{{"baseline", baseline::block_kernels()}};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) found.push_back({"avx2", avx2::block_kernels()});
  if (__builtin_cpu_supports("avx512f")) found.push_back({"avx512", avx512::block_kernels()});
#endif
  return found;
}

}  // namespace udar

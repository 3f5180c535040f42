#pragma once

#include "udar/material/laws.hpp"
#include "udar/mesh/mesh.hpp"
#include "udar/model/model.hpp"
#include "udar/model/state.hpp"

namespace udar {

/// Sums of one element block, added up in the order of blocks: the same bits for any number of threads.
struct ElementSums {
  double stress_work = 0;        ///< J
  double plastic_work = 0;       ///< J
  double frequency_squared = 0;  ///< 1/s2, largest of the block
  double smallest_area = 0;      ///< m2, twice the smallest area of the block, in the middle or at the end of the step
};

/// One block of elements with the arrays it reads and writes, from its first element on.
struct BlockTask {
  const NodeRecord* nodes;
  const Index* corners;   ///< three for each element
  Index count;            ///< elements, a multiple of `lanes`
  double step;            ///< s
  double half_thickness;  ///< m
  const double* area_density;
  double* xx;
  double* yy;
  double* xy;
  double* zz;
  double* plastic_strain;
  double* plastic_power;
  double* corner_forces;  ///< N, x and y of three corners for each element
};

/// Strain, turn, stress and corner forces of a block whose law is the one pointed to.
using BlockKernel = ElementSums (*)(const BlockTask& task, const void* law);

// One kernel for each law, in the order of the variant Law, compiled for each instruction set.
namespace baseline {
const BlockKernel* block_kernels();
}
namespace avx2 {
const BlockKernel* block_kernels();
}
namespace avx512 {
const BlockKernel* block_kernels();
}

/// The kernels for the widest vectors that this processor has. All give the same bits. The environment variable
/// UDAR_LANES (baseline, avx2, avx512) asks for narrower ones, to compare them.
const BlockKernel* widest_block_kernels();

}  // namespace udar

// Compiled once for each instruction set (CMakeLists.txt): everything here lives in a namespace of its name, and no
// inline function of a library is used, since the linker could then take the wrong copy for the whole program.

#include "udar/step/lanes/accelerate_block.hpp"
#include "udar/step/lanes/deform_block.hpp"

namespace udar::UDAR_ISA {

BlockKernels block_kernels() {
  return {DeformKernels<Law>::single, DeformKernels<Law>::paired, &accelerate_block<CentralDifference>,
          &accelerate_block<Multistep>};
}

}  // namespace udar::UDAR_ISA

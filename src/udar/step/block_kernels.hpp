#pragma once

#include "udar/material/laws.hpp"
#include "udar/model/model.hpp"
#include "udar/model/state.hpp"
#include "udar/step/integrators.hpp"

namespace udar {

/// The two loops over large arrays, block by block. They are compiled for each instruction set (step/lanes) and take
/// plain pointers, so that no inline function of a library is compiled with them.

/// Sums of one element block, added up in the order of blocks: the same bits for any number of threads.
struct ElementSums {
  double stress_work = 0;   ///< J
  double plastic_work = 0;  ///< J
  /// m2, twice the smallest area in the middle of the step, or at its end where an element may have turned over since.
  double smallest_area = 0;
  double unseen =
      0;  ///< sum of plastic strains and stresses across the plane, which make no force: is any not a number?
};

/// One block of elements with the arrays it reads and writes, from its first element on.
struct ElementTask {
  const NodeRecord* nodes;
  const Quad* quads;
  Index count;            ///< elements, a multiple of `lanes`; of each half in a paired block
  double step;            ///< s
  double half_thickness;  ///< m
  const double* area_density;
  const double* contact_spring;
  double* xx;
  double* yy;
  double* xy;
  double* zz;
  double* plastic_strain;
  std::uint8_t* flowing;
  Vec2* forces;          ///< N, of corners; see QuadForces
  Index first_element;   ///< number of the first one
  double compute_above;  ///< 1/s2, a bound on the frequency above this is replaced by the frequency itself
  FrequencyBound* frequency;
};

/// Strain, turn, stress and corner forces of a block whose law is the one pointed to.
using ElementKernel = ElementSums (*)(const ElementTask& task, const void* law);

/// Sums of one node block.
struct NodeSums {
  double internal_power = 0;  ///< W, sum f . (v- + v+)
  double kinetic = 0;         ///< J, sum m v- . v+; for an Adams rule sum m v_n . v_n
  double kinetic_after = 0;   ///< J, sum m v+ . v+; v- and v+ are the mean velocities of the last and the coming step
  double damping_before = 0;  ///< W, sum of damping force . v-
  double damping_after = 0;   ///< W
  double spin_after = 0;      ///< kg m2/s, sum m x cross v+
  double spin = 0;            ///< kg m2/s, sum m x cross v_n, for an Adams rule
  Vec2 position{};            ///< kg m, sum m x
  Vec2 force{};               ///< N, all but gravity
  Vec2 carried{};             ///< kg m/s, sum m v+
  Vec2 momentum{};            ///< kg m/s, sum m v_n, for an Adams rule
  Vec2 damping_force{};       ///< N
  double damping_moment = 0;  ///< N m, about the origin
  Vec2 held_momentum{};       ///< kg m/s, what holding nodes changed in the momentum of an Adams rule
  double held_spin = 0;       ///< kg m2/s, and in its spin
};

/// One block of nodes with the arrays it reads and writes, from its first node on.
struct NodeTask {
  Index count;
  NodeRecord* nodes;
  const double* mass;
  const double* inverse_mass;
  const Vec2* external;       ///< N; null where nothing pushes any of the nodes
  const Vec2* internal;       ///< N
  Vec2* acceleration;         ///< m/s2
  Vec2* velocity;             ///< m/s; this and the next three for the Adams rules only
  Vec2* velocity_before;      ///< m/s
  Vec2* last_acceleration;    ///< m/s2
  Vec2* second_acceleration;  ///< m/s2
  double last_step;           ///< s, h_n
  double span;                ///< s, from the time of the last step's velocity to that of the coming one's
  StepWeights done;           ///< Adams rules only
  StepWeights coming;
  bool first;              ///< t = 0: no step was done yet
  Vec2 gravity;            ///< m/s2
  double damping;          ///< 1/s
  Vec2 damping_reference;  ///< m/s
};

/// Places at the end of the step, accelerations there, and the velocities of the coming step.
using NodeKernel = NodeSums (*)(const NodeTask& task);

struct BlockKernels {
  const ElementKernel* deform;  ///< in the order of the variant Law: of blocks of single triangles
  const ElementKernel* deform_paired;
  NodeKernel central_difference;
  NodeKernel multistep;
};

namespace baseline {
BlockKernels block_kernels();
}
namespace avx2 {
BlockKernels block_kernels();
}
namespace avx512 {
BlockKernels block_kernels();
}

/// The kernels for the widest vectors that this processor has. All give the same bits. The environment variable
/// UDAR_LANES (baseline, avx2, avx512) asks for narrower ones, to compare them.
BlockKernels widest_block_kernels();

}  // namespace udar

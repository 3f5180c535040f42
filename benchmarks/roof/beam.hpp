#pragma once

#include <cstdint>

#include "array.hpp"
#include "udar/material/tresca.hpp"

// The roof: how fast the physics of a step can go on a machine when there is nothing else to do. The short beam of
// cases/short-beam with a fixed step, in the fastest layout that was found. Left out: books, histories, control of the
// step, detection of failure, output, any other mesh or obstacle.

namespace roof {

using Index = std::uint32_t;

/// The beam of cases/short-beam and its stop, flat at y = 0 with sides falling at 45 degrees. SI units.
struct Beam {
  double length = 0.4;
  double height = 0.1;
  double thickness = 0.01;
  double density = 7850;
  udar::Tresca law{.young_modulus = 1.96133e11, .poisson_ratio = 0.25, .yield_stress = 2.353596e8};
  double speed = 80;  ///< downwards
  double gravity = 9.81;
  double stop_half_width = 0.03;
  double spring = 1.96133e9;  ///< N/m, normal and tangential, at every node
  double friction = 0.35;
};

/// A node as elements load it: one half of a cache line.
struct alignas(32) Node {
  double x, y;    ///< m
  double vx, vy;  ///< m/s, mean of the step to this place
};

/// On a corner, over half the thickness of the beam, N/m.
struct alignas(16) Force {
  double x, y;
};

struct alignas(64) Line {
  double at[8];
};

/// A piece of work of one thread: elements, then the nodes that are complete with them. Their forces are then still in
/// the nearest cache.
struct Stretch {
  Index group_begin = 0, group_end = 0;
  Index node_begin = 0, node_end = 0;
  Index run_begin = 0, run_end = 0;  ///< of these nodes
};

/// Neighbouring nodes with equally many forces.
struct Run {
  Index begin = 0, end = 0;
  Index forces = 0;
  Index slot = 0;  ///< in Problem::slots, of the first node
};

struct Share {
  std::vector<Stretch> stretches;
  Stretch late;  ///< nodes that must wait until all threads have done their elements
  Index wall_begin = 0, wall_end = 0;
};

/// A node that may touch the stop, with its tangential spring.
struct WallNode {
  Index node = 0;
  Index slot = 0;   ///< in Problem::forces
  Index face = 0;   ///< that it touches; 0: none
  double slip = 0;  ///< m
};

/// sweep: all elements, barrier, all nodes, barrier. fused: nodes are summed and moved as soon as their last element is
/// done; only those between two threads wait.
enum class Variant { sweep, fused };

struct Settings {
  Index columns = 160;  ///< cells along the beam; a quarter as many across
  int threads = 1;
  Variant variant = Variant::fused;
};

/// Pairs of triangles that go through the phases of the step together, so that what one phase leaves for the next stays
/// in the nearest cache.
inline constexpr Index pairs_per_stretch = 64;

/// Everything in memory. A pair is two triangles (a, b, c) and (a, d, b) on both sides of the edge a b; a group is as
/// many pairs as there are lanes.
struct Problem {
  Beam beam;
  Settings settings;
  double step = 0;       ///< s
  double cell = 0;       ///< m
  Index elements = 0;    ///< without padding
  Index node_count = 0;  ///< without the padding's
  Array<Node> nodes;     ///< column by column from below; then the corners of the padding
  Array<double> kick;    ///< step x half thickness / mass
  Array<Index> corners;  ///< group by group: corner a of all lanes, then b, c, d; in bytes into `nodes`
  Array<Index> base;     ///< first force of a group
  Array<Line> stress;    ///< group by group, first and second triangle; see Stress in kernel.hpp
  Array<Force> forces;   ///< of a pair's four corners
  Array<Index> slots;    ///< which forces a node sums; in bytes into `forces`
  std::vector<Run> runs;
  std::vector<WallNode> wall;
  std::vector<Share> shares;
};

/// `slot_of_lane` says where among the forces on one corner of a group each lane's is stored.
Problem build(const Settings& settings, const std::vector<Index>& slot_of_lane);

/// Back to the start.
void restart(Problem& problem);

/// Mass of a node, kg.
inline double mass(const Problem& p, Index node) { return p.step * 0.5 * p.beam.thickness / p.kick[node]; }

}  // namespace roof

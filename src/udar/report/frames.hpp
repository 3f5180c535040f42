#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "udar/report/quantities.hpp"
#include "udar/results/run_files.hpp"
#include "udar/results/vtu.hpp"

namespace udar {

/// Nodes and elements of one body: runs of those of all bodies.
struct MeshBody {
  std::size_t node_begin = 0;
  std::size_t node_end = 0;
  std::size_t element_begin = 0;
  std::size_t element_end = 0;
};

/// What is the same in all frames.
struct ReportMesh {
  std::size_t nodes = 0;
  std::size_t elements = 0;
  std::vector<std::uint32_t> corners;  ///< first corners of all elements, then second, then third ones
  std::vector<std::uint32_t> node_numbers;
  std::vector<std::uint32_t> element_numbers;
  std::vector<double> shares;  ///< of each node in the mass of its body
  std::vector<MeshBody> bodies;
  std::vector<std::string> fields;  ///< names of those that the frames have
};

/// Reads the mesh of a frame. Throws OutputError where it cannot be read or does not hold triangles of bodies.
ReportMesh read_mesh(const FrameFiles& frame);

/// Contact forces of some frames, frame after frame.
struct NodeForces {
  std::vector<std::uint32_t> counts;  ///< for each frame: how many nodes feel a force
  std::vector<std::uint32_t> nodes;
  std::vector<float> x;  ///< N
  std::vector<float> y;
};

/// Frames that follow each other, as tables: a row for each frame.
struct Chunk {
  std::vector<std::vector<float>> values;  ///< for each of the quantities asked for
  std::vector<double> centre_x;            ///< m, centre of mass of each body
  std::vector<double> centre_y;
  NodeForces forces;
};

/// What shall be read.
struct Wanted {
  std::vector<Quantity> quantities;
  bool places = true;  ///< the centres of mass; with them the quantities that are places
  bool forces = true;
};

/// Reads one frame and puts it behind those already in `chunk`. Throws OutputError, and then leaves half of it there.
void add_frame(const FrameFiles& frame, const ReportMesh& mesh, const Wanted& wanted, Chunk& chunk);

}  // namespace udar

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "udar/results/run_frames.hpp"
#include "udar/study/frame_bodies.hpp"
#include "udar/study/projection.hpp"

namespace udar {

/// How far one field of two runs is apart at one time, measured on the finer mesh; docs/convergence-method.md. Vectors
/// count by their length, flags (flows_now) as 0 and 1: then l2 squared is the part of the area that differs.
struct FieldDifference {
  std::string name;         ///< "plastic_strain", "velocity"
  std::string unit;         ///< SI; "" for plain numbers
  double time = 0;          ///< s, of the fine frame
  double l2 = 0;            ///< sqrt(int |a - b|^2 dA / A) over the undeformed area, in `unit`
  double size = 0;          ///< the same of the fine field: sqrt(int |b|^2 dA / A)
  double max = 0;           ///< the largest |a - b| at the points of comparison
  double largest = 0;       ///< the largest |b| there
  std::size_t outside = 0;  ///< points of comparison that are in no coarse triangle
  double apart = 0;         ///< s, by how much the coarse frame is later than the fine one; at most a step
};

/// Numbers of the frames of two runs that are compared.
struct FramePair {
  std::size_t coarse = 0;
  std::size_t fine = 0;
};

/// The frames of both runs at a time, s. A frame stands at the first step that is not before its time, so they, and the
/// time, may be as far apart as the longest step of the two runs. Throws UserError (usage) where there are none.
FramePair frames_at(const RunFrames& coarse, const RunFrames& fine, double time);

/// Compares frames of two runs of one case. The undeformed meshes are searched once, for all frames.
class FieldComparison {
 public:
  /// Throws UserError (usage) where the runs do not have the same bodies, OutputError where a frame cannot be read.
  FieldComparison(RunFrames coarse, RunFrames fine);

  /// Every field that both frames have and that has a meaning on an area, those of nodes first. Stress, plastic strain
  /// and flows of rigid bodies, which have none, are left out of the area; displacements and velocities of theirs
  /// count. Left out are whole numbers (body, node_number) and fields of contacts, which live on boundary nodes only.
  /// Throws as frames_at does, and OutputError where a frame cannot be read.
  [[nodiscard]] std::vector<FieldDifference> at(double time) const;

 private:
  struct Body {
    bool rigid = false;
    Projection projection;
  };

  RunFrames coarse_;
  RunFrames fine_;
  std::vector<Triangle> coarse_triangles_;
  std::vector<Triangle> fine_triangles_;
  std::vector<Body> bodies_;
};

/// All that FieldComparison::at finds, for one time, s.
std::vector<FieldDifference> field_differences(const RunFrames& coarse, const RunFrames& fine, double time);

}  // namespace udar

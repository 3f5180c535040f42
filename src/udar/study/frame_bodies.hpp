#pragma once

#include <optional>
#include <string>
#include <vector>

#include "udar/base/box.hpp"
#include "udar/results/outline.hpp"
#include "udar/results/run_frames.hpp"
#include "udar/study/projection.hpp"

namespace udar {

/// A body of a frame, as it lay before the run.
struct FrameBody {
  int number = 0;    ///< in the order of the case
  std::string name;  ///< empty: the run left no summary that tells
  bool rigid = false;
  BodyMesh mesh;
  Box box;
  double blur = 0;  ///< m, how well the undeformed places are known
};

/// The bodies of a frame, in the order of their numbers. Undeformed places are places less displacements; these have
/// 32 bits. Throws OutputError where the frame lacks what tells them, or a place is no number.
std::vector<FrameBody> bodies_of(const RunFrames& run, const Frame& frame);

/// A field of a frame as numbers, one for each component.
struct FrameField {
  std::string name;  ///< "velocity"
  std::string unit;  ///< "m/s"
  std::size_t components = 1;
  std::vector<double> values;
};

/// The field in an array of a frame, its name and unit parted again; nothing where it has no meaning on an area: whole
/// numbers, and what contacts left at boundary nodes.
std::optional<FrameField> area_field(const VtuArray& array);

/// The array of this name, or nullptr.
const VtuArray* find_array(const std::vector<VtuArray>& arrays, const std::string& name);

}  // namespace udar

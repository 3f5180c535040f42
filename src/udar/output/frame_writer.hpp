#pragma once

#include <cstdint>
#include <vector>

#include "udar/model/model.hpp"
#include "udar/model/state.hpp"
#include "udar/output/multiples.hpp"
#include "udar/results/pvd.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/results/vtu.hpp"

namespace udar {

/// Bodies with all fields at t_n, to be written while model and state stay as they are.
VtuFrame body_frame(const Model& model, const State& state);
/// The obstacles where they stand at t_n, as closed polygons; of endless ones a strip beside the bodies.
VtuGrid obstacle_grid(const Model& model, const State& state);
/// The same outlines, obstacle by obstacle, m.
std::vector<std::vector<Vec2>> obstacle_outlines(const Model& model, const State& state);

/// Writes frames into the run folder: at every multiple of the interval, at the times asked for, each at the first t_n
/// that is not before; steps are never changed for it. A frame is on the disk before the index names it.
class FrameWriter {
 public:
  FrameWriter(const Model& model, const RunFolder& folder);
  /// Writes a frame if one is due. Throws OutputError.
  void record(const State& state);
  /// Writes the last frame, if it is not yet there.
  void close(const State& state);
  [[nodiscard]] int frames() const { return frames_; }

 private:
  void write(const State& state);

  const Model& model_;
  RunFolder folder_;
  PvdIndex index_;
  Multiples intervals_;
  std::size_t times_ = 0;  ///< times asked for that are done
  int frames_ = 0;
  std::uint64_t last_step_ = 0;
};

}  // namespace udar

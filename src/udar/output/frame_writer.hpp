#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "udar/model/model.hpp"
#include "udar/model/state.hpp"
#include "udar/output/multiples.hpp"
#include "udar/parallel/background.hpp"
#include "udar/parallel/for_each.hpp"
#include "udar/results/file.hpp"
#include "udar/results/pvd.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/results/vtu.hpp"

namespace udar {

/// Bodies with all fields at t_n, to be written while model and state stay as they are.
VtuFrame body_frame(const Model& model, const State& state);
/// The obstacles where they stand at t_n, as closed polygons; of endless ones a strip beside the bodies.
VtuGrid obstacle_grid(const Model& model, const State& state);
/// One closed outline of an obstacle.
struct ObstacleOutline {
  std::size_t obstacle = 0;  ///< number in the model
  std::vector<Vec2> points;  ///< m
};
/// The same outlines, obstacle by obstacle.
std::vector<ObstacleOutline> named_obstacle_outlines(const Model& model, const State& state);
/// The same without the numbers, m.
std::vector<std::vector<Vec2>> obstacle_outlines(const Model& model, const State& state);

constexpr std::size_t most_frames_waiting = 4;

/// Packs a frame, as a run does first, and tells how many bytes those take that may wait for the disk after it; 0 where
/// the model wants no frames.
std::size_t memory_of_frames(const Model& model, const State& state);

/// Writes frames into the run folder: at every multiple of the interval, at the times asked for, each at the first t_n
/// that is not before; steps are never changed for it.
///
/// The threads of the solver pack a frame together, between two steps; a thread in the background hands it to the disk
/// while the solver goes on. A frame is whole before the index names it; the index is renewed some times a second. What
/// the disk refuses is told by a later call.
class FrameWriter {
 public:
  FrameWriter(const Model& model, const RunFolder& folder, Pool& pool);
  /// Takes a frame if one is due; waits where too many are not yet written. Throws OutputError, also about a frame that
  /// was taken before.
  void record(const State& state);
  /// Takes the last frame, if it is not yet there, and waits for the disk.
  void close(const State& state);
  /// Waits until all frames taken so far are in files, and the index names them. The files written since it was last
  /// called.
  std::vector<std::filesystem::path> settle();
  /// What it knows between two steps, once settled; with BytesIn it goes on from there: frames taken since are written
  /// over.
  template <class Archive>
  void carry(Archive& archive);

 private:
  /// A frame that waits for the disk, in memory that is used again.
  struct Waiting {
    double time = 0;  ///< s
    PackedVtu bodies;
    PackedVtu obstacles;
    bool has_obstacles = false;
  };
  void take(const State& state);
  void put_on_disk(const Waiting& frame);
  void put_file(const std::string& file, const PackedVtu& frame);
  void add_to_index(double time, bool has_obstacles);
  void renew_index();

  const Model& model_;
  RunFolder folder_;
  Multiples intervals_;
  std::size_t times_ = 0;  ///< times asked for that are done
  VtuPacker body_packer_;
  VtuPacker obstacle_packer_;
  std::array<Waiting, most_frames_waiting> waiting_;
  std::size_t room_ = 1;     ///< how many of them are used
  std::size_t packed_ = 0;   ///< frames that this process took
  std::size_t taken_ = 0;    ///< frames
  std::size_t settled_ = 0;  ///< entries of the index
  std::uint64_t last_step_ = 0;

  // Of the background thread.
  PvdIndex index_;
  int frames_ = 0;
  std::chrono::steady_clock::time_point renewed_ = std::chrono::steady_clock::now();
  Background background_;  ///< the last member: it ends first
};

}  // namespace udar

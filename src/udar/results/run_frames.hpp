#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "udar/results/run_files.hpp"
#include "udar/results/vtu.hpp"

namespace udar {

/// All bodies and obstacles at one time, read back from a run folder.
struct Frame {
  double time = 0;  ///< s
  VtuGrid bodies;
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< of `bodies`
  std::vector<std::vector<Vec2>> obstacles;            ///< closed outlines, m
  std::vector<std::uint8_t> rigid;                     ///< for each body 1 where it is; empty: none is, or unknown
};

/// Closed outlines of the obstacles in a frame, m. Throws OutputError.
std::vector<std::vector<Vec2>> read_outlines(const FrameFiles& frame);

/// The frames of a run, in the order of time.
class RunFrames {
 public:
  /// Throws UserError (usage) where the folder is no run folder or has no frames, OutputError where it cannot be read.
  explicit RunFrames(const std::filesystem::path& folder) : RunFrames(find_run_files(folder)) {}
  /// The same of a folder that was looked into.
  explicit RunFrames(RunFiles files);

  [[nodiscard]] const RunFiles& files() const { return files_; }
  /// The name of the folder: what tells runs of one case apart.
  [[nodiscard]] std::string run_name() const { return folder_name(files_.folder); }
  [[nodiscard]] std::size_t count() const { return files_.frames.size(); }
  [[nodiscard]] double time(std::size_t number) const { return files_.frames[number].time; }  ///< s
  /// The frame nearest to a time, s; of two the earlier one.
  [[nodiscard]] std::size_t nearest(double time) const;
  /// Throws OutputError.
  [[nodiscard]] Frame read(std::size_t number) const;

 private:
  RunFiles files_;
};

}  // namespace udar

#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "udar/results/vtu.hpp"

namespace udar {

/// All bodies and obstacles at one time, read back from a run folder.
struct Frame {
  double time = 0;  ///< s
  VtuGrid bodies;
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< of `bodies`
  std::vector<std::vector<Vec2>> obstacles;            ///< closed outlines, m
};

/// The frames of a run, in the order of time.
class RunFrames {
 public:
  /// Throws UserError (usage) where the folder is no run folder or has no frames, OutputError where it cannot be read.
  explicit RunFrames(std::filesystem::path folder);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// The name of the case; where the run left no summary, that of the folder.
  [[nodiscard]] const std::string& case_name() const { return case_name_; }
  /// The name of the folder: what tells runs of one case apart.
  [[nodiscard]] std::string run_name() const;
  [[nodiscard]] const std::vector<double>& times() const { return times_; }  ///< s
  /// The frame nearest to a time, s; of two the earlier one.
  [[nodiscard]] std::size_t nearest(double time) const;
  /// Throws OutputError.
  [[nodiscard]] Frame read(std::size_t number) const;

 private:
  std::filesystem::path folder_;
  std::string case_name_;
  std::vector<double> times_;
  std::vector<std::string> bodies_;     ///< files, one for each time
  std::vector<std::string> obstacles_;  ///< "" where there are none
};

/// Refuses what is no run folder. Throws UserError (usage).
void check_run_folder(const std::filesystem::path& folder);
/// The name of the case of a run; where it left no summary, that of the folder.
std::string case_name_of(const std::filesystem::path& folder);
/// The name of a folder, also of "." and of "runs/a/".
std::string folder_name(const std::filesystem::path& folder);

}  // namespace udar

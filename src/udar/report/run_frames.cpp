#include "udar/report/run_frames.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "udar/base/error.hpp"
#include "udar/results/pvd.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/results/summary.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

std::vector<std::array<std::int32_t, 3>> triangles_of(const VtuGrid& grid, const fs::path& file) {
  std::vector<std::array<std::int32_t, 3>> triangles;
  triangles.reserve(grid.ends.size());
  std::int32_t begin = 0;
  for (std::size_t c = 0; c < grid.ends.size(); ++c) {
    if (static_cast<VtuCell>(grid.kinds[c]) != VtuCell::triangle || grid.ends[c] - begin != 3) {
      throw OutputError(fmt::format("cannot read {}: a cell of the bodies is no triangle", file.string()));
    }
    const auto at = static_cast<std::size_t>(begin);
    triangles.push_back({grid.corners[at], grid.corners[at + 1], grid.corners[at + 2]});
    begin = grid.ends[c];
  }
  return triangles;
}

std::vector<std::vector<Vec2>> outlines_of(const VtuGrid& grid) {
  std::vector<std::vector<Vec2>> outlines;
  std::int32_t begin = 0;
  for (const std::int32_t end : grid.ends) {
    std::vector<Vec2>& outline = outlines.emplace_back();
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      outline.push_back(grid.points[static_cast<std::size_t>(grid.corners[k])]);
    }
    begin = end;
  }
  std::erase_if(outlines, [](const auto& outline) { return outline.size() < 3; });
  return outlines;
}

}  // namespace

void check_run_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::is_regular_file(folder / RunFolder::marker, error)) return;
  if (!fs::exists(folder, error)) {
    throw UserError(ExitCode::usage, fmt::format("there is no folder `{}`", folder.string()),
                    "give the folder of a run, as `udar run` says at its end");
  }
  throw UserError(ExitCode::usage, fmt::format("`{}` is not the folder of a run", folder.string()),
                  "give a folder that `udar run` made");
}

std::string folder_name(const fs::path& folder) {
  std::error_code error;
  fs::path whole = fs::absolute(folder, error).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();
  return whole.filename().string();
}

std::string case_name_of(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder / RunFolder::summary, error)) {
    std::string name = read_summary(folder / RunFolder::summary).case_name;
    if (!name.empty()) return name;
  }
  return folder_name(folder);
}

RunFrames::RunFrames(fs::path folder) : folder_(std::move(folder)) {
  check_run_folder(folder_);
  std::error_code error;
  std::vector<PvdEntry> entries;
  if (fs::exists(folder_ / RunFolder::fields_index, error)) entries = read_pvd(folder_ / RunFolder::fields_index);
  std::stable_sort(entries.begin(), entries.end(),
                   [](const PvdEntry& a, const PvdEntry& b) { return a.time < b.time; });
  for (const PvdEntry& entry : entries) {
    if (entry.part == 0) {
      times_.push_back(entry.time);
      bodies_.push_back(entry.file);
      obstacles_.emplace_back();
    }
  }
  for (const PvdEntry& entry : entries) {
    const auto at = std::find(times_.begin(), times_.end(), entry.time);
    if (entry.part == 1 && at != times_.end()) obstacles_[static_cast<std::size_t>(at - times_.begin())] = entry.file;
  }
  if (times_.empty()) {
    throw UserError(ExitCode::usage, fmt::format("the run `{}` has no frames", folder_.string()),
                    "run the case again with --set output.fields_every=\"20 us\", or some other time");
  }
  case_name_ = case_name_of(folder_);
}

std::string RunFrames::run_name() const { return folder_name(folder_); }

std::size_t RunFrames::nearest(double time) const {
  const auto nearer = [time](double a, double b) { return std::fabs(a - time) < std::fabs(b - time); };
  return static_cast<std::size_t>(std::min_element(times_.begin(), times_.end(), nearer) - times_.begin());
}

Frame RunFrames::read(std::size_t number) const {
  Frame frame;
  const fs::path file = folder_ / bodies_[number];
  frame.bodies = read_vtu(file);
  frame.time = times_[number];
  frame.triangles = triangles_of(frame.bodies, file);
  if (!obstacles_[number].empty()) frame.obstacles = outlines_of(read_vtu(folder_ / obstacles_[number]));
  return frame;
}

}  // namespace udar

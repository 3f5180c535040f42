#include "udar/results/run_frames.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "udar/base/error.hpp"

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

}  // namespace

std::vector<std::vector<Vec2>> read_outlines(const FrameFiles& frame) {
  std::vector<std::vector<Vec2>> outlines;
  if (frame.obstacles.empty()) return outlines;
  const VtuGrid grid = read_vtu(frame.obstacles);
  std::int32_t begin = 0;
  for (const std::int32_t end : grid.ends) {
    std::vector<Vec2>& outline = outlines.emplace_back();
    for (; begin < end; ++begin) {
      outline.push_back(grid.points[static_cast<std::size_t>(grid.corners[static_cast<std::size_t>(begin)])]);
    }
  }
  std::erase_if(outlines, [](const auto& outline) { return outline.size() < 3; });
  return outlines;
}

RunFrames::RunFrames(RunFiles files) : files_(std::move(files)) {
  if (!files_.frames.empty()) return;
  throw UserError(ExitCode::usage, fmt::format("the run `{}` has no frames", files_.folder.string()),
                  "run the case again with --set output.fields_every=\"20 us\", or some other time");
}

std::size_t RunFrames::nearest(double time) const {
  const auto nearer = [time](const FrameFiles& a, const FrameFiles& b) {
    return std::fabs(a.time - time) < std::fabs(b.time - time);
  };
  const auto& frames = files_.frames;
  return static_cast<std::size_t>(std::min_element(frames.begin(), frames.end(), nearer) - frames.begin());
}

Frame RunFrames::read(std::size_t number) const {
  const FrameFiles& files = files_.frames[number];
  Frame frame;
  frame.bodies = read_vtu(files.bodies);
  frame.time = files.time;
  frame.triangles = triangles_of(frame.bodies, files.bodies);
  frame.obstacles = read_outlines(files);
  if (files_.summary) {
    for (const BodySummary& body : files_.summary->bodies) frame.rigid.push_back(body.rigid ? 1 : 0);
  }
  return frame;
}

}  // namespace udar

#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "udar/report/frame_picture.hpp"
#include "udar/report/program.hpp"

namespace udar {

struct MovieRequest {
  std::filesystem::path output;
  std::vector<std::size_t> frames;  ///< of the run, in this order
  FrameView view;
  int width = 1280;  ///< px; an odd one is made even
  double frames_per_second = 25;
  std::size_t at_once = 1;  ///< frames that are drawn at the same time
};

/// Told once before each frame is looked at and once after each is drawn: how many of how many are done.
using MovieProgress = std::function<void(const char* what, std::size_t done, std::size_t all)>;

/// Refuses a file that could not be made: another ending than .mp4, .webm, .gif or .png. Throws UserError.
void check_movie(const std::filesystem::path& output);
/// The file that will be made: where ffmpeg is missing, an animated PNG instead of .mp4, .webm or .gif. Throws
/// OutputError where rsvg-convert is missing, and where that PNG would replace a file nobody named.
std::filesystem::path movie_file(const std::filesystem::path& output);

/// Draws the frames with one view and one range of colours, turns each into a PNG by rsvg-convert, several at a time,
/// and hands them in order to ffmpeg, or puts them into an animated PNG. All or nothing. Throws OutputError, UserError,
/// Interrupted.
void make_movie(const RunFrames& run, const MovieRequest& request, const MovieProgress& progress,
                const std::function<bool()>& interrupted);

}  // namespace udar

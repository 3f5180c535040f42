#include "udar/report/movie.hpp"

#include <fmt/core.h>

#include <array>
#include <optional>

#include "udar/base/error.hpp"
#include "udar/report/animated_png.hpp"
#include "udar/report/drawing.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

/// How ffmpeg is told to make each kind. Sides must be even for what most players take.
struct Encoding {
  std::string_view ending;
  std::vector<std::string> words;
};

const std::vector<Encoding>& encodings() {
  static const std::string even = "crop=trunc(iw/2)*2:trunc(ih/2)*2:0:0";
  static const std::vector<Encoding> all{
      {".mp4",
       {"-vf", even, "-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4"}},
      {".webm",
       {"-vf", even, "-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1", "-pix_fmt", "yuv420p", "-f",
        "webm"}},
      {".gif", {"-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse", "-f", "gif"}}};
  return all;
}

Program encoder(const Encoding& encoding, double frames_per_second, const fs::path& file) {
  Program program{
      .words = {"ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-y", "-f", "image2pipe", "-framerate",
                fmt::format("{:.6g}", frames_per_second), "-c:v", "png", "-i", "pipe:0", "-an"},
      .package = "ffmpeg",
      .cure = "make an animated .png, which needs no ffmpeg"};
  program.words.insert(program.words.end(), encoding.words.begin(), encoding.words.end());
  program.words.push_back("file:" + file.string());
  return program;
}

const Encoding* encoding_of(const fs::path& output) {
  for (const Encoding& encoding : encodings()) {
    if (output.extension() == encoding.ending) return &encoding;
  }
  return nullptr;
}

/// Draws all frames and hands each as PNG to `take`, in order.
void draw_frames(const RunFrames& run, const MovieRequest& request, const MovieProgress& progress,
                 const std::function<bool()>& interrupted, const std::function<void(std::string)>& take) {
  const std::size_t count = request.frames.size();
  FrameSurvey survey(request.view);
  for (std::size_t k = 0; k < count; ++k) {
    if (interrupted()) throw Interrupted();
    progress("looked at", k, count);
    survey.add(run.read(request.frames[k]));
  }
  const auto svg_of = [&](std::size_t k) {
    Picture picture = survey.picture_of(run.read(request.frames[k]));
    picture.title = case_name_of(run.files());
    return to_svg(picture);
  };
  const int even_width = request.width / 2 * 2;
  run_programs(
      converter(DrawingKind::png, even_width), count, request.at_once, svg_of,
      [&](std::size_t k, std::string png) {
        take(std::move(png));
        progress("drawn", k + 1, count);
      },
      interrupted);
}

void encode(const RunFrames& run, const MovieRequest& request, const Encoding& encoding, const MovieProgress& progress,
            const std::function<bool()>& interrupted) {
  FileReplacement file(request.output);
  Child ffmpeg(encoder(encoding, request.frames_per_second, file.temporary()));
  draw_frames(run, request, progress, interrupted, [&](std::string png) {
    ffmpeg.give(std::move(png));
    serve_until(
        {&ffmpeg}, [&] { return ffmpeg.is_fed(); }, interrupted);
  });
  ffmpeg.end_input();
  ffmpeg.serve();
  serve_until(
      {&ffmpeg}, [&] { return ffmpeg.is_silent(); }, interrupted);
  ffmpeg.finish();
  file.commit();
}

}  // namespace

void check_movie(const fs::path& output) {
  if (output.extension() == ".png" || encoding_of(output) != nullptr) return;
  throw UserError(ExitCode::usage, fmt::format("`{}` does not end in .mp4, .webm, .gif or .png", output.string()),
                  "the ending of --output says what to make");
}

fs::path movie_file(const fs::path& output) {
  require(converter(DrawingKind::png, 0));
  const Encoding* const encoding = encoding_of(output);
  if (encoding == nullptr || is_installed(encoder(*encoding, 1, output))) return output;
  fs::path instead = fs::path(output).replace_extension(".png");
  std::error_code error;
  if (fs::exists(instead, error)) {
    throw OutputError(
        fmt::format("the program `ffmpeg` is not installed, and {} is there already\n  = install the "
                    "Debian package ffmpeg, or name an animated .png with --output",
                    instead.string()));
  }
  return instead;
}

void make_movie(const RunFrames& run, const MovieRequest& request, const MovieProgress& progress,
                const std::function<bool()>& interrupted) {
  if (const Encoding* const encoding = encoding_of(request.output)) {
    encode(run, request, *encoding, progress, interrupted);
    return;
  }
  AnimatedPng file(request.output, request.frames.size(), request.frames_per_second);
  draw_frames(run, request, progress, interrupted, [&](const std::string& png) { file.add(png); });
  file.commit();
}

}  // namespace udar

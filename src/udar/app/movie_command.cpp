#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

#include "udar/app/picture_options.hpp"
#include "udar/app/signals.hpp"
#include "udar/app/terminal.hpp"
#include "udar/parallel/for_each.hpp"
#include "udar/report/movie.hpp"

namespace udar {
namespace {

using std::chrono::steady_clock;

constexpr const char* movie_footer = R"(Examples:
  udar movie runs/short-beam --output impact.mp4
  udar movie runs/short-beam --field sigma1 --range "-300..300 MPa" --to "0.5 ms" --output waves.webm
  udar movie runs/flight --follow beam --no-mesh --fps 12 --output flight.png

All frames of the run, with one view and one range of colours. Needs the program rsvg-convert (Debian:
librsvg2-bin), and ffmpeg for .mp4, .webm and .gif; .png is an animated PNG, which browsers play.)";

struct Arguments {
  PictureArguments common;
  std::string run;
  std::string from;
  std::string to;
  double frames_per_second = 0;  ///< 0: so that the movie takes some seconds
};

/// How far it is, rewritten in place; elsewhere than on a terminal now and then a line.
class Progress {
 public:
  void tell(const char* what, std::size_t done, std::size_t all) {
    const auto now = steady_clock::now();
    if (what != what_) {
      what_ = what;
      begin_ = now;
      next_ = now + pause();
    }
    if (now < next_) return;
    next_ = now + pause();
    shown_ = true;
    const double spent = std::chrono::duration<double>(now - begin_).count();
    const double left = done > 0 ? spent * static_cast<double>(all - done) / static_cast<double>(done) : 0;
    say_in_place(fmt::format("{} of {} {}, {} left", done, counted(static_cast<long long>(all), "frame"), what,
                             done > 0 ? clock_text(left) : "--:--"));
  }
  /// Ends the line.
  void finish() const {
    if (shown_ && is_terminal()) say("\n");
  }

 private:
  static steady_clock::duration pause() { return std::chrono::milliseconds(is_terminal() ? 200 : 5000); }

  const char* what_ = nullptr;
  bool shown_ = false;
  steady_clock::time_point begin_;
  steady_clock::time_point next_;
};

std::vector<std::size_t> choose(const RunFrames& run, const Arguments& arguments) {
  const double from = arguments.from.empty() ? 0 : time_of_option("--from", arguments.from);
  const double to =
      arguments.to.empty() ? std::numeric_limits<double>::infinity() : time_of_option("--to", arguments.to);
  std::vector<std::size_t> frames;
  for (std::size_t k = 0; k < run.count(); ++k) {
    // Frames are written at the first step that is not before the time asked for.
    if (run.time(k) >= from && run.time(k) <= to * 1.001) frames.push_back(k);
  }
  if (frames.empty()) {
    throw UserError(ExitCode::usage, fmt::format("the run `{}` has no frames in this time", arguments.run),
                    "widen --from and --to");
  }
  return frames;
}

ExitCode make(const Arguments& arguments) {
  check_movie(arguments.common.output);
  const RunFrames run(arguments.run);
  MovieRequest request{.output = arguments.common.output,
                       .frames = choose(run, arguments),
                       .view = frame_view(arguments.common, arguments.run),
                       .width = arguments.common.width};
  const auto count = static_cast<double>(request.frames.size());
  request.frames_per_second =
      arguments.frames_per_second > 0 ? arguments.frames_per_second : std::clamp(std::round(count / 6), 5.0, 30.0);
  request.at_once = static_cast<std::size_t>(std::max(1, static_cast<int>(available_threads())));
  request.output = movie_file(request.output);
  if (request.output != arguments.common.output) {
    say("the program `ffmpeg` is not installed (Debian: ffmpeg): making an animated PNG instead\n");
  }
  catch_signals();
  Progress progress;
  try {
    make_movie(
        run, request, [&](const char* what, std::size_t done, std::size_t all) { progress.tell(what, done, all); },
        is_interrupted);
  } catch (const Interrupted&) {
    progress.finish();
    say("stopped; {} was not made\n", request.output.string());
    return code_of_signal();
  }
  progress.finish();
  say("{}: {} at {:.3g} a second\n", request.output.string(),
      counted(static_cast<long long>(request.frames.size()), "frame"), request.frames_per_second);
  return ExitCode::done;
}

}  // namespace

Command add_movie(CLI::App& app) {
  CLI::App* words = app.add_subcommand("movie", "Draw all frames of a run as a movie");
  words->footer(fields_text() + "\n\n" + movie_footer);
  const auto arguments = std::make_shared<Arguments>();
  arguments->common.width = 1280;
  words->add_option("RUN", arguments->run, "Folder of a run")->required()->type_name("");
  add_picture_options(*words, arguments->common);
  words->add_option("--fps", arguments->frames_per_second, "Frames a second, 1 to 60; else what takes 6 s")
      ->type_name("N")
      ->check(CLI::Range(1.0, 60.0).description(""));
  words->add_option("--from", arguments->from, "Leave out what is before: \"0.1 ms\"")->type_name("TIME");
  words->add_option("--to", arguments->to, "Leave out what is after")->type_name("TIME");
  return {words, [arguments] { return make(*arguments); }, "made"};
}

}  // namespace udar

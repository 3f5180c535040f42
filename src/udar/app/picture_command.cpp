#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>

#include "udar/app/picture_options.hpp"
#include "udar/app/terminal.hpp"
#include "udar/report/drawing.hpp"
#include "udar/report/strip.hpp"

namespace udar {
namespace {

constexpr const char* picture_footer = R"(Examples:
  udar picture runs/short-beam --output end.png
  udar picture runs/short-beam --time "0.5 ms" --field sigma1 --unit "kgf/cm^2" --output stress.pdf
  udar picture runs/short-beam --field sigma1 --times 20us,40us,60us,80us --columns 2 --output strip.png
  udar picture runs/coarse runs/short-beam --time 0.5ms --field flows --output meshes.svg

The frame nearest to a time is taken. Several times, or several runs, make one picture of small ones,
with one range of colours. PNG and PDF need the program rsvg-convert (Debian: librsvg2-bin).)";

struct Arguments {
  PictureArguments common;
  std::vector<std::string> runs;
  std::vector<std::string> times;
  int columns = 0;
};

/// One frame that is shown.
struct Shown {
  const RunFrames* run;
  std::size_t frame;
};

/// A list of times, s: each option may hold several, with commas.
std::vector<double> times_of(const Arguments& arguments) {
  std::vector<double> times;
  for (const std::string& option : arguments.times) {
    for (const std::string& text : split_list(option, ',')) times.push_back(time_of_option("--time", text));
  }
  return times;
}

std::vector<Shown> choose(const std::vector<RunFrames>& runs, const std::vector<double>& times) {
  std::vector<Shown> shown;
  for (const RunFrames& run : runs) {
    if (times.empty()) shown.push_back({&run, run.count() - 1});
    for (const double time : times) {
      shown.push_back({&run, run.nearest(time)});
      const double taken = run.time(shown.back().frame);
      // Frames are written at the first step that is not before: a per cent off is what was meant.
      if (std::fabs(taken - time) <= 0.01 * std::max(std::fabs(time), 1e-9)) continue;
      say("{}: no frame at {}; the nearest one, at {}, is taken\n", run.files().folder.string(),
          human_text(time, "s", 4), human_text(taken, "s", 4));
    }
  }
  return shown;
}

/// What tells a pane from the others: its run, its time, or both.
std::string pane_title(const Arguments& arguments, const Shown& shown, bool many_times) {
  std::string time = "t = " + human_text(shown.run->time(shown.frame), "s", 4);
  if (arguments.runs.size() == 1) return time;
  return many_times ? shown.run->run_name() + ", " + time : shown.run->run_name();
}

std::string strip_of(const Arguments& arguments, const std::vector<Shown>& shown, const FrameSurvey& survey) {
  const auto time_of = [](const Shown& one) { return human_text(one.run->time(one.frame), "s", 4); };
  const bool many_times =
      std::any_of(shown.begin(), shown.end(), [&](const Shown& one) { return time_of(one) != time_of(shown.front()); });
  PictureStrip strip{.title = case_name_of(shown.front().run->files())};
  for (const Shown& one : shown) {
    Picture picture = survey.picture_of(one.run->read(one.frame));
    picture.title = pane_title(arguments, one, many_times);
    strip.pictures.push_back(std::move(picture));
  }
  if (!many_times) strip.subtitle = "t = " + time_of(shown.front());
  const int usual = shown.size() <= 4 || shown.size() > arguments.runs.size() ? 2 : 3;
  strip.columns = arguments.columns > 0 ? arguments.columns : usual;
  return to_svg(strip);
}

ExitCode draw(const Arguments& arguments) {
  check_drawing(arguments.common.output);
  const std::vector<double> times = times_of(arguments);
  std::vector<RunFrames> runs;
  for (const std::string& folder : arguments.runs) runs.emplace_back(folder);
  const FrameView view = frame_view(arguments.common, runs.front().files().folder);
  const std::vector<Shown> shown = choose(runs, times);
  FrameSurvey survey(view);
  for (const Shown& one : shown) survey.add(one.run->read(one.frame));

  std::string svg;
  if (shown.size() == 1) {
    Picture picture = survey.picture_of(shown.front().run->read(shown.front().frame));
    picture.title = case_name_of(shown.front().run->files());
    svg = to_svg(picture);
  } else {
    svg = strip_of(arguments, shown, survey);
  }
  write_drawing(arguments.common.output, svg, arguments.common.width);
  const double first = shown.front().run->time(shown.front().frame);
  say("{}: {}{}\n", arguments.common.output, shown.size() == 1 ? "frame at " + human_text(first, "s", 4) : "",
      shown.size() == 1 ? "" : counted(static_cast<long long>(shown.size()), "frame"));
  return ExitCode::done;
}

}  // namespace

Command add_picture(CLI::App& app) {
  CLI::App* words = app.add_subcommand("picture", "Draw a run at one time or several: deformed bodies with a field");
  words->footer(fields_text() + "\n\n" + picture_footer);
  const auto arguments = std::make_shared<Arguments>();
  words->add_option("RUN", arguments->runs, "Folder of a run, or several")->required()->type_name("");
  words->add_option("--time,--times", arguments->times, "When, as often as needed, or with commas; else the last frame")
      ->type_name("TIME")
      ->allow_extra_args(false);
  add_picture_options(*words, arguments->common);
  words->add_option("--columns", arguments->columns, "Of several small pictures, 1 to 20")
      ->type_name("N")
      ->check(CLI::Range(1, 20).description(""));
  return {words, [arguments] { return draw(*arguments); }, "made"};
}

}  // namespace udar

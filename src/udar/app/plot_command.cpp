#include <CLI/CLI.hpp>
#include <memory>

#include "udar/app/commands.hpp"
#include "udar/app/picture_options.hpp"
#include "udar/app/terminal.hpp"
#include "udar/report/drawing.hpp"
#include "udar/report/history_plot.hpp"
#include "udar/results/run_files.hpp"

namespace udar {
namespace {

constexpr const char* plot_footer = R"(Examples:
  udar plot runs/short-beam --output sheet.pdf
  udar plot runs/short-beam corner.displacement_y stop.force_y --to "0.5 ms" --output corner.png
  udar plot runs/coarse runs/short-beam corner.displacement_y --output meshes.svg

A history is a file of histories/, a column what its first line names: corner.displacement_y.
corner.displacement is x and y, corner all that it has. Curves in one unit share a panel.
PNG and PDF need the program rsvg-convert (Debian: librsvg2-bin).)";

struct Arguments {
  std::vector<std::string> words;
  std::string from;
  std::string to;
  std::string title;
  std::string output;
  int width = 1600;
};

ExitCode draw(const Arguments& arguments) {
  check_drawing(arguments.output);
  PlotRequest request{.runs = {arguments.words.front()}, .title = arguments.title};
  std::size_t next = 1;
  while (next < arguments.words.size() && is_run_folder(arguments.words[next])) {
    request.runs.emplace_back(arguments.words[next++]);
  }
  for (; next < arguments.words.size(); ++next) request.names.push_back(arguments.words[next]);
  if (!arguments.from.empty()) request.from = time_of_option("--from", arguments.from);
  if (!arguments.to.empty()) request.to = time_of_option("--to", arguments.to);
  if (!(request.from < request.to)) {
    throw UserError(ExitCode::usage, "--to is not after --from", "give --to a later time");
  }
  const Plot plot = history_plot(request);
  write_drawing(arguments.output, to_svg(plot), arguments.width);
  std::size_t curves = 0;
  for (const PlotPanel& panel : plot.panels) curves += panel.curves.size();
  say("{}: {} in {}\n", arguments.output, counted(static_cast<long long>(curves), "curve"),
      counted(static_cast<long long>(plot.panels.size()), "panel"));
  return ExitCode::done;
}

}  // namespace

Command add_plot(CLI::App& app) {
  CLI::App* words = app.add_subcommand("plot", "Draw histories of a run, or of several, over time");
  words->footer(plot_footer);
  const auto arguments = std::make_shared<Arguments>();
  words
      ->add_option("RUN", arguments->words,
                   "Folders of runs, then what to draw: HISTORY.COLUMN; else what is looked at first")
      ->required()
      ->type_name("");
  words->add_option("--output", arguments->output, "File to make: .svg, .png or .pdf")->type_name("FILE")->required();
  words->add_option("--from", arguments->from, "Where the time axis begins: \"0.1 ms\"")->type_name("TIME");
  words->add_option("--to", arguments->to, "Where it ends")->type_name("TIME");
  words->add_option("--title", arguments->title, "Instead of the name of the case")->type_name("TEXT");
  add_width_option(*words, arguments->width);
  return {words, [arguments] { return draw(*arguments); }, "made"};
}

}  // namespace udar

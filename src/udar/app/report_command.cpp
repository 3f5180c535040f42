#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

#include "udar/app/commands.hpp"
#include "udar/app/terminal.hpp"
#include "udar/report/field.hpp"
#include "udar/report/report.hpp"
#include "udar/report/study_page.hpp"
#include "udar/report/study_plots.hpp"
#include "udar/results/file.hpp"
#include "udar/results/study.hpp"

namespace udar {
namespace {

constexpr const char* footer = R"(Examples:
  udar report runs/short-beam
  udar report runs/short-beam --limit "5 MB" --output short-beam.html
  udar report runs/short-beam --fields plastic_strain,principal_1 --frames 50

`udar run` makes the same file by itself; this is for old runs and other choices.
Of a study it makes study.html, which shows its runs beside each other, and the plots anew:
  udar report studies/short-beam)";

struct ReportArguments {
  std::string run;                  ///< folder, also of a study
  std::string output;               ///< empty: report.html in it
  std::string limit = "25 MB";      ///< of the file
  std::vector<std::string> fields;  ///< empty: all
  std::size_t frames = 0;           ///< at most; 0: all
  std::string page;                 ///< a viewer to take instead of the one built in
};

/// "sigma1" -> "principal_1": the short names of udar picture serve here too.
std::string whole_name(const std::string& name) {
  const auto kinds = field_kinds();
  const auto at = std::find_if(kinds.begin(), kinds.end(), [&](const FieldKind& k) { return k.short_name == name; });
  return name.empty() || at == kinds.end() ? name : std::string(at->name);
}

ExitCode report_run(const ReportArguments& arguments) {
  ReportOptions options;
  options.output = arguments.output;
  options.limit = size_of_option("--limit", arguments.limit);
  for (const std::string& name : arguments.fields) options.fields.push_back(whole_name(name));
  if (!arguments.output.empty() && std::filesystem::path(arguments.output).extension() != ".html") {
    throw UserError(ExitCode::usage, fmt::format("`{}` does not end in .html", arguments.output),
                    "the report is a page: give --output such a name");
  }
  options.frames = arguments.frames;
  constexpr std::size_t largest_page = 1 << 26;
  const std::string page = arguments.page.empty() ? "" : read_file(arguments.page, largest_page);
  options.page = page;
  const bool is_study = is_study_folder(arguments.run);
  const ReportInfo info = is_study ? write_study_page(arguments.run, options) : write_report(arguments.run, options);
  say("{}: {}, {}\n", info.path.string(), in_units(static_cast<double>(info.bytes), "B"),
      counted(static_cast<long long>(info.frames), "frame"));
  for (const std::string& sentence : info.left_out) say("  {}\n", sentence);
  if (is_study) {
    const auto plots = static_cast<long long>(write_study_plots(arguments.run).size());
    say("{}: {}\n", (std::filesystem::path(arguments.run) / StudyFolder::plots).string(), counted(plots, "plot"));
  }
  return ExitCode::done;
}

}  // namespace

Command add_report(CLI::App& app) {
  CLI::App* words = app.add_subcommand(
      "report", "Make report.html of a run, or study.html of a study: one file that shows it in a browser");
  words->footer(footer);
  const auto arguments = std::make_shared<ReportArguments>();
  words->add_option("RUN", arguments->run, "Folder of a run or of a study")->required()->type_name("");
  words->add_option("--limit", arguments->limit, "Size of the file at most; a plain number is in MB")
      ->type_name("SIZE")
      ->capture_default_str();
  words->add_option("--fields", arguments->fields, "Only these fields: plastic_strain,principal_1")
      ->type_name("NAME,...")
      ->delimiter(',');
  words->add_option("--frames", arguments->frames, "At most so many frames, 2 or more: every k-th of those there are")
      ->type_name("N")
      ->check(CLI::Range(2, 1'000'000).description(""));
  words->add_option("--output", arguments->output, "File to write; else report.html or study.html in the folder")
      ->type_name("FILE");
  // For those who work on the viewer.
  words->add_option("--template", arguments->page, "")->group("");
  return {words, [arguments] { return report_run(*arguments); }, "made"};
}

}  // namespace udar

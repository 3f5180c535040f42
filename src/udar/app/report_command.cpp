#include "udar/app/commands.hpp"
#include "udar/app/terminal.hpp"
#include "udar/report/report.hpp"
#include "udar/results/file.hpp"

namespace udar {

ExitCode report_command(const ReportArguments& arguments) {
  constexpr std::size_t largest_page = 1 << 26;
  const std::string page = arguments.page.empty() ? "" : read_file(arguments.page, largest_page);
  ReportOptions options;
  options.output = arguments.output;
  options.fields = arguments.fields;
  options.frames = arguments.frames;
  options.page = page;
  const ReportInfo info = write_report(arguments.run, options);
  say("{}: {}, {}\n", info.path.string(), in_units(static_cast<double>(info.bytes), "B"),
      counted(static_cast<long long>(info.frames), "frame"));
  for (const std::string& sentence : info.left_out) say("  {}\n", sentence);
  return ExitCode::done;
}

}  // namespace udar

#include <array>
#include <charconv>
#include <cmath>

#include "udar/app/commands.hpp"
#include "udar/app/terminal.hpp"
#include "udar/report/report.hpp"
#include "udar/results/file.hpp"

namespace udar {
namespace {

/// "25 MB", "500 kB", "1.5 GB"; a plain number is in MB.
std::size_t bytes_of(std::string_view text) {
  struct Unit {
    std::string_view name;
    double bytes;
  };
  constexpr std::array units{Unit{"", 1e6}, Unit{"MB", 1e6}, Unit{"kB", 1e3}, Unit{"GB", 1e9}};
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
  while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  for (const Unit& unit : units) {
    const double bytes = number * unit.bytes;
    if (error == std::errc() && rest == unit.name && bytes >= 1 && bytes < 1e15) {
      return static_cast<std::size_t>(std::llround(bytes));
    }
  }
  throw UserError(ExitCode::usage, fmt::format("`--limit {}` is no size of a file", text),
                  "write it as \"25 MB\", \"500 kB\" or \"1.5 GB\"");
}

}  // namespace

ExitCode report_command(const ReportArguments& arguments) {
  ReportOptions options;
  options.output = arguments.output;
  options.limit = bytes_of(arguments.limit);
  options.fields = arguments.fields;
  options.frames = arguments.frames;
  constexpr std::size_t largest_page = 1 << 26;
  const std::string page = arguments.page.empty() ? "" : read_file(arguments.page, largest_page);
  options.page = page;
  const ReportInfo info = write_report(arguments.run, options);
  say("{}: {}, {}\n", info.path.string(), in_units(static_cast<double>(info.bytes), "B"),
      counted(static_cast<long long>(info.frames), "frame"));
  for (const std::string& sentence : info.left_out) say("  {}\n", sentence);
  return ExitCode::done;
}

}  // namespace udar

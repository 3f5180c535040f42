#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cmath>

#include "udar/app/commands.hpp"
#include "udar/app/terminal.hpp"
#include "udar/units/quantity.hpp"

namespace udar {

void add_case_options(CLI::App& command, CaseArguments& arguments) {
  command.add_option("CASE", arguments.file, "Case file, as docs/case-file.md tells")->required()->type_name("");
  command
      .add_option("--set", arguments.assignments,
                  "Replace a value of the case, as often as needed: --set bodies.beam.thickness=\"2 cm\"")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_width_option(CLI::App& command, int& width) {
  command.add_option("--width", width, fmt::format("Width of a PNG or movie in px, 100 to 10000; {} by itself", width))
      ->type_name("PX")
      ->check(CLI::Range(100, 10000).description(""));
}

double si_of_option(std::string_view option, std::string_view text, Dimension needed) {
  const auto value = parse_si(text, needed);
  if (value) return *value;
  const UnitError& error = value.error();
  throw UserError(ExitCode::usage, fmt::format("{} in `{}`: {}", error.what, option, error.reason),
                  error.cure.empty() ? "write it like " + example_of(needed) : error.cure);
}

double time_of_option(std::string_view option, std::string_view text) {
  return si_of_option(option, text, dimension::time);
}

std::size_t size_of_option(std::string_view option, std::string_view text) {
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
  throw UserError(ExitCode::usage, fmt::format("`{} {}` is no size of a file", option, text),
                  "write it as \"25 MB\", \"500 kB\" or \"1.5 GB\"");
}

}  // namespace udar

#include <CLI/CLI.hpp>

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

}  // namespace udar

#include <CLI/CLI.hpp>
#include <memory>

#include "udar/app/commands.hpp"
#include "udar/app/terminal.hpp"
#include "udar/case/reference.hpp"

namespace udar {
namespace {

constexpr const char* keys_footer = R"(Examples:
  udar keys
  udar keys friction)";

}  // namespace

Command add_keys(CLI::App& app) {
  CLI::App* words = app.add_subcommand("keys", "List what a case file may say");
  words->footer(keys_footer);
  const auto filter = std::make_shared<std::string>();
  words->add_option("WORD", *filter, "Only keys whose name or meaning contains this")->type_name("");
  return {words, [filter] {
            say_text(keys_text(*filter));
            return ExitCode::done;
          }};
}

}  // namespace udar

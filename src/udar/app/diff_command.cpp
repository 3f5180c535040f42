#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "udar/app/commands.hpp"
#include "udar/app/terminal.hpp"
#include "udar/case/ascii.hpp"
#include "udar/results/file.hpp"
#include "udar/study/run_difference.hpp"
#include "udar/units/quantity.hpp"

namespace udar {
namespace {

namespace fs = std::filesystem;

constexpr const char* diff_footer = R"(Examples:
  udar diff runs/short-beam runs/short-beam-2
  udar diff runs/coarse runs/short-beam --only corner stop.force --align --window "20 us"
  udar diff runs/short-beam measured.csv --map "deflection=corner.displacement_y" --shift "0.1 ms"
  udar diff runs/short-beam runs/expected --only corner --within "2 %"

A table (a .csv file) names its columns in its first line, with units: time [ms];corner.displacement_y [mm].
Differences are A - B; percents are of B. docs/diff.md has the formulas.
Exit code 9: --within is exceeded.)";

struct Arguments {
  std::string a;
  std::string b;
  bool align = false;
  std::string shift;
  std::string window;
  std::vector<std::string> only;
  std::string from;
  std::string to;
  std::string tolerance = "1 %";
  std::string within;
  std::vector<std::string> maps;
  bool all = false;
  std::string output;
};

[[noreturn]] void refuse(const std::string& message, const std::string& cure) {
  throw UserError(ExitCode::usage, message, cure);
}

/// "2 %" -> 0.02.
double part_of_option(std::string_view option, const std::string& text) {
  const auto value = parse_si(text, dimension::number);
  if (!value || !(*value >= 0)) {
    refuse(fmt::format("`{} {}` is no part of a value", option, text), fmt::format("write {} \"2 %\"", option));
  }
  return *value;
}

void check_output(const Arguments& arguments) {
  if (arguments.output.empty()) return;
  const std::string ending = fs::path(arguments.output).extension().string();
  if (ending != ".csv" && ending != ".json") {
    refuse(fmt::format("`{}` does not end in .csv or .json", arguments.output), "give --output such a name");
  }
  for (const std::string& side : {arguments.a, arguments.b}) {
    std::error_code error;
    if (fs::equivalent(side, arguments.output, error)) {
      refuse(fmt::format("--output would replace `{}`, which is compared", side), "give --output another name");
    }
  }
}

DifferenceRequest request_of(const Arguments& arguments) {
  DifferenceRequest request{.a = arguments.a, .b = arguments.b, .maps = arguments.maps, .only = arguments.only};
  request.align = arguments.align;
  if (!arguments.shift.empty()) request.shift = time_of_option("--shift", arguments.shift);
  if (!arguments.window.empty()) request.how.window = time_of_option("--window", arguments.window);
  if (request.how.window < 0) refuse("--window is negative", "write --window \"20 us\"");
  if (!arguments.from.empty()) request.how.from = time_of_option("--from", arguments.from);
  if (!arguments.to.empty()) request.how.to = time_of_option("--to", arguments.to);
  if (!(request.how.from < request.how.to)) refuse("--to is not after --from", "give --to a later time");
  request.how.tolerance = part_of_option("--tolerance", arguments.tolerance);
  return request;
}

/// "3.41 %", "427 %".
std::string percent(double part) {
  if (std::isnan(part)) return "-";
  if (part > 1e4) return std::isinf(part) ? "B is 0" : fmt::format("{:.1e} %", 100 * part);
  if (part >= 0.9995) return fmt::format("{:.0f} %", 100 * part);
  return fmt::format("{:.3g} %", 100 * part);
}

/// Some names in a line: "a, b, c and 7 more".
std::string some(const std::vector<std::string>& names, std::size_t most) {
  std::string text;
  for (std::size_t k = 0; k < std::min(names.size(), most); ++k) text += (k > 0 ? ", " : "") + shown(names[k]);
  if (names.size() > most) text += fmt::format(" and {} more", names.size() - most);
  return text;
}

void print_first_line(const Arguments& arguments, const RunDifference& difference) {
  if (!difference.bits) {
    say("{} against {}: {}", arguments.a, arguments.b,
        counted(static_cast<long long>(difference.columns.size()), "column"));
  } else if (difference.bits->same) {
    say("the same bits");
  } else {
    const BitDifference& bits = *difference.bits;
    say("not the same bits: first in {}{}{}", bits.where,
        std::isnan(bits.time) ? "" : " at " + in_units(bits.time, "s"), bits.how.empty() ? "" : ", " + bits.how);
  }
  say("\n");
  if (difference.moved != 0) say("B is moved by {}; times are those of A\n", in_units(difference.moved, "s"));
  for (const std::string& note : difference.notes) say("  {}\n", printable(note));
}

void print_keys(const std::vector<KeyDifference>& keys, bool all) {
  if (keys.empty()) return;
  constexpr std::size_t most = 12;
  constexpr std::size_t longest = 60;
  const auto value = [](const std::string& text) {
    if (text.empty()) return std::string("(not there)");
    return text.size() <= longest ? printable(text) : printable(text.substr(0, longest)) + "...";
  };
  say("\nthe cases differ in {}:\n", counted(static_cast<long long>(keys.size()), "key"));
  const std::size_t count = all ? keys.size() : std::min(keys.size(), most);
  for (std::size_t k = 0; k < count; ++k) {
    say("  {}: {} -> {}\n", printable(keys[k].key), value(keys[k].a), value(keys[k].b));
  }
  if (count < keys.size()) say("  and {} more (--all shows them)\n", keys.size() - count);
}

/// The columns that are shown, the largest difference first; those that cannot be told at the end.
std::vector<const ColumnDifference*> by_difference(const std::vector<ColumnDifference>& columns) {
  std::vector<const ColumnDifference*> sorted;
  for (const ColumnDifference& c : columns) {
    if (!c.negligible && !(c.same_bits && !(relative_l2(c.difference) > 0))) sorted.push_back(&c);
  }
  const auto key = [](const ColumnDifference* c) {
    const double part = relative_l2(c->difference);
    return std::isnan(part) ? -1 : part;
  };
  std::stable_sort(sorted.begin(), sorted.end(), [&](const auto* a, const auto* b) { return key(a) > key(b); });
  return sorted;
}

void print_row(const ColumnDifference& c, std::size_t name_width, std::size_t unit_width) {
  const HistoryDifference& d = c.difference;
  if (!d.compared()) {
    say("{:<{}}  {:<{}}  no time in which both have numbers\n", shown(c.name), name_width, c.unit, unit_width);
    return;
  }
  say("{:<{}}  {:<{}}  {:>14}  {:>18}  {:>9}  {:>9}\n", shown(c.name), name_width, c.unit, unit_width,
      percent(relative_l2(d)), percent(relative_max(d)), d.max_abs > 0 ? in_units(d.time_of_max, "s") : "-",
      std::isnan(d.parted) ? "never" : in_units(d.parted, "s"));
}

void print_table(const RunDifference& difference, const Arguments& arguments) {
  constexpr std::size_t most = 20;
  const auto sorted = by_difference(difference.columns);
  const std::size_t count = arguments.all ? sorted.size() : std::min(sorted.size(), most);
  std::size_t name_width = 7;
  std::size_t unit_width = 4;
  for (std::size_t k = 0; k < count; ++k) {
    name_width = std::max(name_width, shown(sorted[k]->name).size());
    unit_width = std::max(unit_width, sorted[k]->unit.size());
  }
  if (count > 0) {
    say("\n{:<{}}  {:<{}}  {:>14}  {:>18}  {:>9}  {:>9}\n", "history", name_width, "unit", unit_width, "rms difference",
        "largest difference", "when", "part at");
    for (std::size_t k = 0; k < count; ++k) print_row(*sorted[k], name_width, unit_width);
  }
  std::vector<std::string> same;
  std::vector<std::string> rounding;
  for (const ColumnDifference& c : difference.columns) {
    if (c.negligible) {
      rounding.push_back(c.name);
    } else if (c.same_bits && !(relative_l2(c.difference) > 0)) {
      same.push_back(c.name);
    }
  }
  constexpr std::size_t in_a_line = 4;
  if (count > 0) {
    say("in % of the rms and of the largest value of B; they part where they differ by more than {} of the largest\n",
        arguments.tolerance);
  }
  if (count < sorted.size()) say("{} more differ less (--all shows them)\n", sorted.size() - count);
  if (!same.empty()) say("the same rows in both: {}\n", some(same, arguments.all ? same.size() : in_a_line));
  if (!rounding.empty()) {
    say("rounding only, below 1e-9 of others in their unit: {}\n",
        some(rounding, arguments.all ? rounding.size() : in_a_line));
  }
}

void print_left_out(const RunDifference& difference, bool all) {
  std::vector<std::string> names;
  for (const ColumnDifference& c : difference.columns) {
    const std::size_t rows = c.difference.left_out;
    if (rows > 0) names.push_back(fmt::format("{} of {}", counted(static_cast<long long>(rows), "row"), c.name));
  }
  constexpr std::size_t most = 4;
  if (!names.empty()) say("left out, since they hold no number: {}\n", some(names, all ? names.size() : most));
  const std::size_t in_a_line = all ? std::max(difference.only_in_a.size(), difference.only_in_b.size()) : 8;
  if (!difference.only_in_a.empty()) say("only in A: {}\n", some(difference.only_in_a, in_a_line));
  if (!difference.only_in_b.empty()) say("only in B: {}\n", some(difference.only_in_b, in_a_line));
}

/// The unit of a number of the summary that is looked at first; null: it is none.
const char* unit_of_headline(const std::string& name) {
  if (!name.starts_with("contacts.") || name.find(".episodes.") != std::string::npos) return nullptr;
  if (name.ends_with(".peak_force")) return "N";
  const bool time = name.ends_with(".first_touch") || name.ends_with(".duration") || name.ends_with(".duration_99");
  return time ? "s" : nullptr;
}

void print_numbers(const std::vector<NumberDifference>& numbers, bool all) {
  constexpr std::size_t most = 12;
  std::size_t different = 0;
  for (const NumberDifference& n : numbers) different += n.same() ? 0 : 1;
  if (different == 0) return;
  say("\nsummary.json: {} of {} differ{}\n", different, counted(static_cast<long long>(numbers.size()), "number"),
      all ? "" : " (--all shows them)");
  std::size_t count = 0;
  for (const NumberDifference& n : numbers) {
    const char* unit = unit_of_headline(n.name);
    if (n.same() || (!all && (unit == nullptr || ++count > most))) continue;
    const auto text = [&](double v) {
      if (std::isnan(v)) return std::string("none");
      return unit != nullptr ? in_units(v, unit) : fmt::format("{:.6g}", v);
    };
    const double part = std::fabs(n.a - n.b) / std::fabs(n.b);
    say("  {}: {} -> {}{}\n", printable(n.name), text(n.a), text(n.b),
        std::isfinite(part) ? fmt::format("  ({})", percent(part)) : "");
  }
}

/// Tells whether all columns are within the part that was asked for.
ExitCode judge(const RunDifference& difference, const std::string& text) {
  const double within = part_of_option("--within", text);
  long long count = 0;
  long long beyond = 0;
  const ColumnDifference* worst = nullptr;
  for (const ColumnDifference* c : by_difference(difference.columns)) {
    if (!differs(*c, within)) continue;
    ++beyond;
    if (worst == nullptr) worst = c;
  }
  for (const ColumnDifference& c : difference.columns) count += c.negligible ? 0 : 1;
  if (beyond == 0) {
    say("\nwithin {}: all of {}\n", text, counted(count, "column"));
    return ExitCode::done;
  }
  const double part = relative_l2(worst->difference);
  say("\nnot within {}: {} of {}, worst {}, {}\n", text, beyond, counted(count, "column"), shown(worst->name),
      std::isnan(part) ? "which cannot be compared" : percent(part));
  return ExitCode::differs;
}

ExitCode compare(const Arguments& arguments) {
  check_output(arguments);
  if (!arguments.within.empty()) part_of_option("--within", arguments.within);
  const RunDifference difference = compare_runs(request_of(arguments));
  if (!arguments.output.empty()) {
    const bool json = fs::path(arguments.output).extension() == ".json";
    write_file(arguments.output, json ? to_json(difference) : to_csv(difference));
  }
  print_first_line(arguments, difference);
  print_keys(difference.keys, arguments.all);
  const bool nothing_to_show = difference.bits && difference.bits->same && difference.moved == 0;
  if (!nothing_to_show) {
    print_table(difference, arguments);
    print_left_out(difference, arguments.all);
    if (arguments.only.empty()) print_numbers(difference.numbers, arguments.all);
  }
  const ExitCode code = arguments.within.empty() ? ExitCode::done : judge(difference, arguments.within);
  if (!arguments.output.empty()) {
    say("{}: {}\n", arguments.output, counted(static_cast<long long>(difference.columns.size()), "column"));
  }
  return code;
}

}  // namespace

Command add_diff(CLI::App& app) {
  CLI::App* words =
      app.add_subcommand("diff", "Compare two runs, or a run with measurements: by how much, from when on");
  words->footer(diff_footer);
  const auto arguments = std::make_shared<Arguments>();
  words->add_option("A", arguments->a, "Folder of a run, or a table")->required()->type_name("");
  words->add_option("B", arguments->b, "What it is compared with: another one")->required()->type_name("");
  words->add_option("--only", arguments->only, "Only these: HISTORY, HISTORY.COLUMN")->type_name("NAME");
  words->add_flag("--align", arguments->align, "Move B so that the first touches of the runs fall together");
  words->add_option("--shift", arguments->shift, "Move B in time: \"0.1 ms\" is later")->type_name("TIME");
  words->add_option("--window", arguments->window, "Compare moving averages over so long a time")->type_name("TIME");
  words->add_option("--from", arguments->from, "Compare from this time of A on")->type_name("TIME");
  words->add_option("--to", arguments->to, "Compare up to this time of A")->type_name("TIME");
  words
      ->add_option("--tolerance", arguments->tolerance,
                   "They part where they differ by more than this part of the largest value")
      ->type_name("PART")
      ->capture_default_str();
  words->add_option("--within", arguments->within, "Exit code 9 where an rms difference is larger: \"2 %\"")
      ->type_name("PART");
  words->add_option("--map", arguments->maps, "What a column of a table is: \"deflection=corner.displacement_y\"")
      ->type_name("COLUMN=NAME")
      ->allow_extra_args(false);
  words->add_flag("--all", arguments->all, "Show everything, not only the largest differences");
  words->add_option("--output", arguments->output, "Write the whole table into this .csv or .json")->type_name("FILE");
  return {words, [arguments] { return compare(*arguments); }, "compared"};
}

}  // namespace udar

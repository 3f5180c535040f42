#include "udar/app/picture_options.hpp"

#include <CLI/CLI.hpp>
#include <cmath>

#include "udar/app/terminal.hpp"
#include "udar/case/case_file.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/units/quantity.hpp"

namespace udar {
namespace {

[[noreturn]] void refuse(const std::string& message, const std::string& cure) {
  throw UserError(ExitCode::usage, message, cure);
}

Dimension dimension_of(std::string_view si_unit) {
  if (si_unit.empty()) return dimension::number;
  const auto one = parse_quantity(fmt::format("1 {}", si_unit));
  return one ? one->dimension : dimension::number;
}

std::string trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(" \t") - begin + 1));
}

/// The unit that ends a quantity: "MPa" of "400 MPa".
std::string unit_of(std::string_view quantity) {
  const std::size_t end = quantity.find_last_of("0123456789.");
  const std::size_t letter = quantity.find_first_not_of("+-0123456789.eE ");
  if (letter == std::string_view::npos) return "";
  return end == std::string_view::npos ? std::string(quantity) : std::string(quantity.substr(letter));
}

/// "0..400 MPa" -> 0 and 4e8.
std::pair<double, double> range_of(const PictureArguments& arguments, const FieldKind& kind) {
  const std::size_t dots = arguments.range.find("..");
  const std::string example = kind.unit == "Pa" ? "\"0..400 MPa\"" : fmt::format("\"0..1 {}\"", kind.unit);
  if (dots == std::string::npos) {
    refuse(fmt::format("`{}` is no range", arguments.range), "write --range " + example + " or --range auto");
  }
  std::string low = trimmed(std::string_view(arguments.range).substr(0, dots));
  const std::string high = trimmed(std::string_view(arguments.range).substr(dots + 2));
  if (unit_of(low).empty()) low += " " + unit_of(high);
  const Dimension needed = dimension_of(kind.unit);
  const double from = si_of_option("--range", trimmed(low), needed);
  const double to = si_of_option("--range", high, needed);
  if (!(from < to)) refuse(fmt::format("the range `{}` does not rise", arguments.range), "write --range " + example);
  return {from, to};
}

HumanUnit unit_of_option(const std::string& text, const FieldKind& kind) {
  const Dimension needed = dimension_of(kind.unit);
  const auto one = parse_quantity("1 " + text);
  if (!one || !fits(one->dimension, needed)) {
    refuse(fmt::format("`{}` is no unit of {}", text, kind.caption),
           kind.unit.empty() ? "leave --unit out: it is a plain number"
                             : fmt::format("write --unit {} or another unit of {}", kind.unit, dimension_name(needed)));
  }
  return {typeset(text), one->value};
}

Extent view_of_option(const std::string& text) {
  const std::vector<std::string> parts = split_list(text, ',');
  if (parts.size() != 4) {
    refuse(fmt::format("`{}` is no view", text),
           "write the lower left and the upper right corner: --view \"-25 cm, -5 cm, 25 cm, 15 cm\"");
  }
  std::array<double, 4> at{};
  for (std::size_t k = 0; k < 4; ++k) at[k] = si_of_option("--view", parts[k], dimension::length);
  if (!(at[0] < at[2] && at[1] < at[3])) {
    refuse(fmt::format("the view `{}` has no area", text),
           "write first the lower left corner, then the upper right one");
  }
  return {{at[0], at[1]}, {at[2], at[3]}};
}

/// The number of a body, by its name in the case as it ran.
int body_number(const std::string& name, const std::filesystem::path& run) {
  const Case input = load_case((run / RunFolder::resolved_case).string());
  std::vector<std::string> names;
  for (const auto& body : input.bodies) names.push_back(body.name);
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<int>(at - names.begin());
  const std::string near = nearest_word(name, names);
  names.resize(std::min<std::size_t>(names.size(), 10));
  refuse(fmt::format("the run `{}` has no body `{}`", run.string(), name),
         near.empty() ? "write " + one_of(names) : fmt::format("did you mean `{}`?", near));
}

}  // namespace

std::vector<std::string> split_list(std::string_view words, char separator) {
  std::vector<std::string> parts;
  for (;;) {
    const std::size_t end = words.find(separator);
    parts.push_back(trimmed(words.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    words.remove_prefix(end + 1);
  }
}

std::string fields_text() {
  constexpr std::size_t longest_line = 100;
  std::string text = "Fields:";
  std::size_t begin = 0;
  for (const FieldKind& kind : field_kinds()) {
    const std::string_view name = kind.short_name.empty() ? kind.name : kind.short_name;
    if (text.size() - begin + name.size() + 2 > longest_line) {
      begin = text.size() + 1;
      text += "\n ";
    }
    text += fmt::format(" {}{}", name, &kind == &field_kinds().back() ? "" : ",");
  }
  return text;
}

void add_picture_options(CLI::App& command, PictureArguments& arguments) {
  command.add_option("--field", arguments.field, "What colours show; plastic by itself")->type_name("NAME");
  command.add_option("--output", arguments.output, "File to make; its ending says what")->type_name("FILE")->required();
  command.add_option("--range", arguments.range, "Values of the first and the last colour: \"0..400 MPa\"; or auto")
      ->type_name("A..B");
  command.add_option("--unit", arguments.unit, "Unit of the colour bar: \"kgf/cm^2\"")->type_name("UNIT");
  command
      .add_option("--view", arguments.view, "What is shown: \"-25 cm, -5 cm, 25 cm, 15 cm\", lower left to upper right")
      ->type_name("X,Y,X,Y");
  command.add_option("--follow", arguments.follow, "Keep this body in the middle")->type_name("BODY");
  command.add_flag("--mesh", arguments.mesh, "Draw the mesh, where it is not too fine")->group("");
  command.add_flag("--no-mesh", arguments.no_mesh, "Leave the mesh out");
  command.add_flag("--smooth", arguments.smooth, "Even colours between the means at nodes");
  add_width_option(command, arguments.width);
}

FrameView frame_view(const PictureArguments& arguments, const std::filesystem::path& run) {
  FrameView view;
  view.field = &find_field(arguments.field);
  const bool plain = !view.field->has_values();
  if (plain && (!arguments.range.empty() || !arguments.unit.empty() || arguments.smooth)) {
    refuse(fmt::format("`{}` has no range of values", arguments.field), "leave --range, --unit and --smooth out");
  }
  if (!arguments.range.empty() && arguments.range != "auto") view.range = range_of(arguments, *view.field);
  if (!arguments.unit.empty()) view.unit = unit_of_option(arguments.unit, *view.field);
  if (!arguments.view.empty() && !arguments.follow.empty()) {
    refuse("both --view and --follow say what is shown", "leave one of them out");
  }
  if (!arguments.view.empty()) view.view = view_of_option(arguments.view);
  if (!arguments.follow.empty()) view.follow = body_number(arguments.follow, run);
  view.mesh = !arguments.no_mesh;
  view.smooth = arguments.smooth;
  return view;
}

}  // namespace udar

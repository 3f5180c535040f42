#include "udar/case/reference.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "udar/base/text.hpp"
#include "udar/case/ascii.hpp"
#include "udar/case/keys.hpp"
#include "udar/case/tables.hpp"
#include "udar/units/unit_table.hpp"

namespace udar {
namespace {

constexpr std::string_view example =
    R"([run]
end_time = "2 ms"
gravity = ["0 m/s^2", "-9.81 m/s^2"]

[materials.steel]
law = "tresca"
density = "7850 kg/m^3"
young_modulus = "2e6 kgf/cm^2"
poisson_ratio = 0.25
yield_stress = "2400 kgf/cm^2"

[bodies.beam]
material = "steel"
thickness = "1 cm"
velocity = ["0 m/s", "-80 m/s"]
mesh = { shape = "rectangle", size = ["40 cm", "10 cm"], at = ["-20 cm", "0 cm"], element_size = "1 cm" }

[obstacles.stop]
shape = "polygon"
points = [["-3 cm", "0 cm"], ["-23 cm", "-20 cm"], ["23 cm", "-20 cm"], ["3 cm", "0 cm"]]
friction = 0.35
stiffness = "2e6 kgf/cm"

[[observe.nodes]]
name = "corner"
body = "beam"
at = ["-20 cm", "10 cm"]

[output]
fields_every = "20 us"
)";

constexpr std::string_view introduction = R"(# The case file

<!-- Made from the key registry in src/udar/case/. A test compares; UDAR_WRITE_DOCS=1 makes it write this page anew. -->

A case is a [TOML](https://toml.io) file of at most 1 MiB in UTF-8. This one is complete:

```toml
{}```

Every mistake is told at once, with its place and a cure: `udar check FILE`. One value is replaced for one run with
`--set bodies.beam.mesh.element_size="0.5 cm"`. `udar keys WORD` shows the keys below in the terminal.

## Values

**Quantities** stand in double quotes with their unit: `"80 m/s"`, `"2400 kgf/cm^2"`, `"35 deg"`. Units are multiplied by a
space or `*` and divided by `/`; `m^2` and `m2` are the same. After a `/` comes no more multiplication: write `N/(m s)`. A
number without unit is refused where a unit belongs; plain numbers (`friction = 0.35`) stand without quotes. 1 kgf is
9.80665 N. Known units: {}.

**Vectors and points** are `[x, y]`, x to the right and y upwards. Angles and spins count counter-clockwise.

**Values that change with time** are a constant or a table: `{{ times = ["0 s", "1 ms"], values = ["0 m", "1 cm"], shape =
"smooth" }}`. `shape = "linear"` (the default) draws straight lines between the points; `"smooth"` has no jump in velocity
or acceleration. Before the first and after the last time the value stays.

**Names** (NAME below) have letters a-z A-Z, digits, `_` and `-`, at most 64 of them. Files of the results are called by them.

**Nodes and edges** are those of the undeformed body.
)";

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

std::string code(std::string_view text) { return text.empty() ? "" : fmt::format("`{}`", text); }

std::string markdown_rows(const std::vector<KeyText>& keys) {
  std::string out = "| key | value | default | meaning | example |\n|---|---|---|---|---|\n";
  for (const KeyText& k : keys) {
    out += fmt::format("| {} | {} | {} | {} | {} |\n", code(k.name), escaped(k.value),
                       k.required ? "required" : code(k.standard), escaped(k.doc), code(escaped(k.example)));
  }
  return out;
}

std::vector<TableText> all_tables() {
  std::vector<TableText> tables;
  describe_table(case_schema(), "", "", tables);
  return tables;
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
  return out;
}

std::string terminal_text(const KeyText& k, const std::string& path, const std::string& choice) {
  const std::string standard = k.required ? "required" : k.standard.empty() ? "" : "default " + k.standard;
  std::string out = path + (choice.empty() ? "" : "  (" + choice + ")") + "\n";
  out += fmt::format("    {}{}{}\n    {}\n", k.value, standard.empty() ? "" : "; ", standard, k.doc);
  if (!k.example.empty()) out += fmt::format("    {} = {}\n", k.name, k.example);
  return out;
}

}  // namespace

std::string_view example_case() { return example; }

std::string case_file_reference() {
  std::string units;
  for (const std::string& name : unit_names()) units += (units.empty() ? "" : " ") + name;
  std::string out = fmt::format(fmt::runtime(introduction), example, code(units));
  for (const TableText& table : all_tables()) {
    out += fmt::format("\n## `{}`\n\n{}\n\n{}", table.header, escaped(table.doc), markdown_rows(table.keys));
    for (const ChoiceText& choice : table.choices) {
      out += fmt::format("\n### `{}`: {}\n\n{}", choice.choice, escaped(choice.doc), markdown_rows(choice.keys));
    }
  }
  return out;
}

std::string keys_text(std::string_view filter) {
  const std::string wanted = lower(filter);
  std::string out;
  std::vector<std::string> names;
  const auto take = [&](const KeyText& k, const std::string& table, const std::string& choice) {
    const std::string path = join(table, k.name);
    const bool found = lower(path).find(wanted) != std::string::npos ||
                       lower(k.doc).find(wanted) != std::string::npos ||
                       lower(choice).find(wanted) != std::string::npos;
    if (found) out += terminal_text(k, path, choice);
    names.push_back(k.name);
  };
  for (const TableText& table : all_tables()) {
    for (const KeyText& k : table.keys) take(k, table.path, "");
    for (const ChoiceText& choice : table.choices) {
      for (const KeyText& k : choice.keys) take(k, table.path, choice.choice);
    }
  }
  if (!out.empty()) return out;
  const std::string near = nearest_word(filter, names);
  return fmt::format("no key is about \"{}\"{}\n", shown(filter),
                     near.empty() ? "" : fmt::format("; did you mean `{}`?", near));
}

}  // namespace udar

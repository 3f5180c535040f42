#include <doctest/doctest.h>

#include "tests/case/example.hpp"

namespace udar {
namespace {

struct Bad {
  std::string name;
  std::string text;
  std::vector<std::string> said;  ///< message, place, cure
};

/// The short beam with more below it, which begins in line 29.
std::string beam_and(std::string_view more) { return std::string(short_beam) + "\n" + std::string(more); }

std::vector<Bad> bad_texts() {
  using namespace std::string_literals;
  return {
      {"empty file", "", {"missing table [run]", "there is no body", "add a table [bodies.NAME]"}},
      {"comment only", "# nothing\n", {"missing table [run]"}},
      {"binary file",
       "\x7f"
       "ELF\x02\x01\x01\0\0\0\0"s,
       {"this is a binary file, not a case"}},
      {"UTF-16", "\xff\xfe[\0r\0u\0n\0]\0"s, {"the case is written in UTF-16", "save the file as UTF-8"}},
      {"Latin-1", "[run]\nend_time = \"2 \xb5s\"\n", {"not a text in UTF-8", "bad.toml:2:15"}},
      {"overlong UTF-8", "# \xc0\xaf\n", {"not a text in UTF-8", "bad.toml:1:3"}},
      {"cut UTF-8", "# \xe2\x82", {"not a text in UTF-8", "bad.toml:1:3"}},
      {"escape character", "[run]\n\x1b[31m\n", {"control character U+001B", "bad.toml:2:1"}},
      {"C1 control", "# \xc2\x9b 31m\n", {"control character U+009B"}},
      {"zero byte far away",
       "# " + std::string(5000, 'x') + "\n[run]\0\n"s,
       {"control character U+0000", "bad.toml:2:6"}},
      {"lone CR", "[run]\rend_time = 1\n", {"stray carriage return", "bad.toml:1:6"}},
      {"too large", std::string(2 << 20, ' '), {"the case is too large", "at most 1 MiB"}},
      {"bracket and hash", "[#steel]", {"this is not TOML", "bad.toml:1:2"}},
      {"open bracket", "[run\n", {"this is not TOML", "bad.toml:1:5", "expected ']'"}},
      {"no value", "[run]\nend_time\n", {"this is not TOML", "bad.toml:2:9"}},
      {"open string", "[run]\nend_time = \"2 ms\n", {"this is not TOML", "bad.toml:2:17"}},
      {"open long string", "a = \"\"\"x\n", {"this is not TOML"}},
      {"unquoted quantity",
       "[run]\nend_time = 2 ms\n",
       {"this is not TOML", "bad.toml:2:14", "did you mean \"2 ms\", in double quotes?"}},
      {"unquoted word",
       "[run]\nintegrator = adams\n",
       {"this is not TOML", "bad.toml:2:14", "did you mean \"adams\", in double quotes?"}},
      {"number without first digit", "a = .5\n", {"this is not TOML", "bad.toml:1:5"}},
      {"number too large for TOML", "a = 1e999\n", {"this is not TOML", "bad.toml:1:10"}},
      {"unknown escape", "a = \"\\q\"\n", {"this is not TOML", "unknown escape sequence"}},
      {"key twice",
       beam_with("end_time = \"2 ms\"", "end_time = \"2 ms\"\nend_time = \"3 ms\""),
       {"`end_time` is given twice", "bad.toml:3:"}},
      {"table twice", beam_and("[run]\n"), {"`run` is given twice", "bad.toml:29:1"}},
      {"body twice", beam_and("[bodies.beam]\n"), {"`bodies.beam` is given twice", "bad.toml:29:1"}},
      {"nested arrays", "a = " + repeated("[", 5000), {"values nested too deeply", "at most 16 levels"}},
      {"nested tables", "a = " + repeated("{a = ", 5000), {"values nested too deeply"}},
      {"dotted key", repeated("a.", 5000) + "a = 1\n", {"key with too many parts", "bad.toml:1:32"}},
      {"dotted header", "[" + repeated("a . ", 5000) + "a]\n", {"key with too many parts"}},
      {"key not ASCII",
       "[run]\nd\xc3\xa9"
       "but = 1\n",
       {"character U+00E9 outside of quotes", "bad.toml:2:2"}},
      {"quoted key not ASCII",
       beam_with("friction",
                 "\"fr\xc3\xaf"
                 "ction\""),
       {"unknown key `fr\xc3\xaf"
        "ction`",
        "bad.toml:20:1", "did you mean `friction`?"}},
      {"place after an accent",
       beam_with("name = \"corner\"", "name = \"\xc3\xa9\", x = 1"),
       {"this is not TOML", "bad.toml:23:11"}},
      {"accent in single quotes",
       beam_with("\"corner\"", "'\xc3\xa9'"),
       {"character U+00E9 cannot be read here", "bad.toml:23:9", "use double quotes"}},
      {"accent after backslash", "a = \"\\\xc3\xa9\"", {"character U+00E9 cannot be read here", "bad.toml:1:7"}},

      {"unknown table", beam_and("[outputs]\n"), {"unknown key `outputs`", "bad.toml:29:2", "did you mean `output`?"}},
      {"unknown key",
       beam_with("yield_stress", "yeild_stress"),
       {"unknown key `yeild_stress`", "bad.toml:11:1", "did you mean `yield_stress`?"}},
      {"quite unknown key",
       beam_with("friction = 0.35", "colour = \"red\""),
       {"unknown key `colour`", "known here: friction, stiffness"}},
      {"unknown mesh key",
       beam_with("element_size", "elementsize"),
       {"unknown key `elementsize`", "bad.toml:16:83", "did you mean `element_size`?"}},
      {"key of another law",
       beam_with("\"tresca\"", "\"elastic\""),
       {"key `yield_stress` is of no use here", "bad.toml:11:1", "it belongs to law = \"tresca\""}},
      {"missing key",
       beam_with("density = \"7850 kg/m^3\"\n", ""),
       {"missing key `density`", "bad.toml:6:1", "add density = \"7850 kg/m^3\""}},
      {"missing law",
       beam_with("law = \"tresca\"\n", ""),
       {"missing key `law`", "bad.toml:6:1", "add law = \"elastic\""}},
      {"missing mesh",
       beam_with("mesh = {", "# mesh = {"),
       {"missing key `mesh`", "bad.toml:12:1", "add mesh = { shape = \"rectangle\""}},
      {"missing end_time",
       beam_with("end_time = \"2 ms\"\n", ""),
       {"missing key `end_time`", "bad.toml:1:1", "add end_time = \"2 ms\""}},
      {"missing run", beam_with("[run]", "[runn]"), {"unknown key `runn`", "bad.toml:1:2", "did you mean `run`?"}},
      {"no body", "[run]\nend_time = \"1 s\"\n", {"there is no body", "add a table [bodies.NAME]"}},
      {"unknown word",
       beam_with("\"central_difference\"", "\"central_diference\""),
       {"unknown word for `integrator`", "bad.toml:3:14", "did you mean \"central_difference\"?"}},
      {"unknown law",
       beam_with("\"tresca\"", "\"treska\""),
       {"unknown word for `law`", "bad.toml:7:7", "did you mean \"tresca\"?"}},
      {"unknown shape",
       beam_with("\"polygon\"", "\"sphere\""),
       {"unknown word for `shape`", "bad.toml:18:9",
        "\"half_plane\", \"rectangle\", \"polygon\" or \"circle\" is needed"}},
      {"unknown diagonals",
       beam_with("\"alternating\"", "\"both\""),
       {"unknown word for `diagonals`", "bad.toml:16:121"}},
      {"unknown auto",
       beam_with("time_step = \"auto\"", "time_step = \"automatic\""),
       {"unknown word for `time_step`", "bad.toml:4:13", "write \"auto\" or \"2 ms\""}},

      {"no unit",
       beam_with("\"7850 kg/m^3\"", "7850"),
       {"missing unit for `density`", "bad.toml:8:11", "in SI units write \"7850 kg/m^3\""}},
      {"no unit in quotes",
       beam_with("\"2 ms\"", "\"2\""),
       {"missing unit for `end_time`", "bad.toml:2:12", "write \"2 s\""}},
      {"wrong unit",
       beam_with("\"-80 m/s\"", "\"-80 m\""),
       {"wrong unit for `velocity`", "bad.toml:15:22", "this is a length; a velocity is needed",
        "did you mean \"-80 m/s\"?"}},
      {"force for stiffness",
       beam_with("\"2e6 kgf/cm\"", "\"2e6 kgf\""),
       {"wrong unit for `stiffness`", "bad.toml:21:13", "did you mean \"2e6 kgf/cm\"?"}},
      {"unknown unit",
       beam_with("2e6 kgf/cm^2", "2e6 kfg/cm^2"),
       {"unknown unit `kfg` for `young_modulus`", "bad.toml:9:17", "did you mean \"2e6 kgf/cm^2\"?"}},
      {"decimal comma",
       beam_with("0.25 cm", "0,25 cm"),
       {"unreadable value for `element_size`", "did you mean \"0.25 cm\"?"}},
      {"no number",
       beam_with("\"1 cm\"", "\"thick\""),
       {"unreadable value for `thickness`", "bad.toml:14:13", "write it like \"1 cm\""}},
      {"hexadecimal", beam_with("\"1 cm\"", "\"0x10 cm\""), {"for `thickness`", "bad.toml:14:13"}},
      {"number too large",
       beam_with("\"1 cm\"", "\"1e400 cm\""),
       {"impossible value for `thickness`", "too large or too small"}},
      {"number beyond sense",
       beam_with("\"1 cm\"", "\"1e40 cm\""),
       {"impossible value for `thickness`", "it must be no larger than 1e+30 m"}},
      {"infinite", beam_with("0.35", "inf"), {"impossible value for `friction`", "bad.toml:20:12", "this is inf"}},
      {"not a number", beam_with("0.35", "nan"), {"impossible value for `friction`", "bad.toml:20:12", "this is nan"}},
      {"boolean",
       beam_with("0.35", "true"),
       {"wrong kind of value for `friction`", "bad.toml:20:12", "this is a truth value; a plain number is needed"}},
      {"date",
       beam_with("\"2 ms\"", "1979-05-27"),
       {"wrong kind of value for `end_time`", "this is a date or time; a time is needed"}},
      {"list for a number",
       beam_with("\"1 cm\"", "[\"1 cm\"]"),
       {"wrong kind of value for `thickness`", "this is a list; a length is needed"}},
      {"number for a text",
       beam_with("material = \"steel\"", "material = 3"),
       {"wrong kind of value for `material`", "bad.toml:13:12", "this is a number; the name of a material is needed"}},
      {"text for a table",
       beam_with("mesh = {", "mesh = \"mesh.msh\" #"),
       {"wrong kind of value for `mesh`", "bad.toml:16:8", "a table is needed"}},
      {"value for a section", "run = 3\n", {"wrong kind of value for `run`", "bad.toml:1:7"}},
      {"body without name",
       "[bodies]\nmaterial = \"steel\"\n",
       {"wrong kind of value for `material`", "bad.toml:2:12", "a table for each, [bodies.NAME], is needed"}},
      {"single brackets",
       beam_with("[[observe.nodes]]", "[observe.nodes]"),
       {"wrong kind of value for `nodes`", "bad.toml:22:1", "write it like [[observe.nodes]]"}},
      {"double brackets",
       beam_with("[materials.steel]", "[[materials.steel]]"),
       {"wrong kind of value for `steel`", "bad.toml:6:1", "[materials.NAME]"}},
      {"one component",
       beam_with("[\"0 m/s\", \"-80 m/s\"]", "[\"-80 m/s\"]"),
       {"wrong number of values for `velocity`", "bad.toml:15:12", "there are 1; two are needed, [x, y]"}},
      {"no component",
       beam_with("[\"0 m/s\", \"-80 m/s\"]", "\"-80 m/s\""),
       {"wrong kind of value for `velocity`", "[x, y] is needed", "write it like [\"0 m/s\", \"80 m/s\"]"}},

      {"negative thickness",
       beam_with("\"1 cm\"", "\"-1 cm\""),
       {"impossible value for `thickness`", "bad.toml:14:13", "this is -0.01 m", "it must be above 0"}},
      {"end_time zero",
       beam_with("\"2 ms\"", "\"0 ms\""),
       {"impossible value for `end_time`", "bad.toml:2:12", "it must be above 0"}},
      {"density zero",
       beam_with("7850 kg", "0 kg"),
       {"impossible value for `density`", "bad.toml:8:11", "it must be above 0"}},
      {"yield zero",
       beam_with("2400 kgf", "0 kgf"),
       {"impossible value for `yield_stress`", "bad.toml:11:16", "it must be above 0"}},
      {"nu one half",
       beam_with("0.25\n", "0.5\n"),
       {"impossible value for `poisson_ratio`", "bad.toml:10:17", "it must be above -1 and below 0.5"}},
      {"negative friction", beam_with("0.35", "-0.35"), {"impossible value for `friction`", "it must be at least 0"}},
      {"step_safety",
       beam_with("time_step = \"auto\"", "step_safety = 1.5"),
       {"impossible value for `step_safety`", "it must be above 0 and at most 1"}},
      {"no area",
       beam_with("\"10 cm\"]", "\"0 cm\"]"),
       {"impossible value for `size`", "bad.toml:16:48", "this is 0 m"}},
      {"element too large",
       beam_with("0.25 cm", "25 cm"),
       {"the elements are larger than the body", "bad.toml:16:98", "write \"0.1 m\" or less"}},
      {"element too small",
       beam_with("0.25 cm", "0.25 nm"),
       {"far too many elements", "bad.toml:16:98", "check the units"}},
      {"parameter of another shape",
       beam_with("size = [\"40 cm\", \"10 cm\"]", "radius = \"1 mm\""),
       {"missing key `size`", "key `radius` is of no use here", "bad.toml:16:31", "it belongs to shape = \"disc\""}},
      {"ring without wall",
       beam_and("[bodies.ring]\nmaterial = \"steel\"\nmesh = { shape = \"ring\", outer_radius = \"1 cm\", inner_radius "
                "= \"2 cm\", element_size = \"1 mm\" }\n"),
       {"the ring has no wall", "bad.toml:31:64"}},
      {"finest elements larger than the others",
       beam_with("element_size = \"0.25 cm\"",
                 "element_size = \"0.25 cm\", finest_size = \"1 cm\", finest_side = \"top\""),
       {"the finest elements are larger than the others", "bad.toml:16:123", "write \"0.0025 m\" or less"}},
      {"finest nowhere",
       beam_with("element_size = \"0.25 cm\"", "element_size = \"0.25 cm\", finest_size = \"1 mm\""),
       {"where elements are finest is not said", "add finest_side = \"bottom\""}},
      {"finest point outside",
       beam_with("element_size = \"0.25 cm\"",
                 "element_size = \"0.25 cm\", finest_size = \"1 mm\", finest_at = [\"0 cm\", \"-1 cm\"]"),
       {"the finest place lies outside the body", "by 0.01 m", "give a point of the body"}},
      {"finest elements too many",
       beam_with(
           "element_size = \"0.25 cm\"",
           "element_size = \"0.25 cm\", finest_size = \"10 nm\", finest_side = \"top\", finest_within = \"1 cm\""),
       {"far too many elements", "a smaller finest_within"}},
      {"side of another shape",
       beam_with("element_size = \"0.25 cm\"",
                 "element_size = \"0.25 cm\", finest_size = \"1 mm\", finest_side = \"outer\""),
       {"unknown word for `finest_side`", "bad.toml:16:145"}},
      {"no such material",
       beam_with("material = \"steel\"", "material = \"stel\""),
       {"there is no material \"stel\"", "bad.toml:13:12", "did you mean \"steel\"?"}},
      {"no such body",
       beam_with("body = \"beam\"", "body = \"plate\""),
       {"there is no body \"plate\"", "bad.toml:24:8", "there is beam"}},
      {"two corners",
       beam_with("[[\"-3 cm\", \"0 cm\"], [\"-23 cm\", \"-20 cm\"], [\"23 cm\", \"-20 cm\"], ",
                 "[[\"23 cm\", \"-20 cm\"], "),
       {"impossible polygon", "bad.toml:19:10", "it has 2 corners; at least 3 are needed"}},
      {"not convex",
       beam_with("[\"23 cm\", \"-20 cm\"]", "[\"0 cm\", \"-1 cm\"]"),
       {"impossible polygon", "it is not convex"}},
      {"bow tie",
       beam_with("[\"-23 cm\", \"-20 cm\"], [\"23 cm\", \"-20 cm\"]",
                 "[\"23 cm\", \"-20 cm\"], [\"-23 cm\", \"-20 cm\"]"),
       {"impossible polygon"}},
      {"zero area",
       beam_with("[\"-23 cm\", \"-20 cm\"], [\"23 cm\", \"-20 cm\"]", "[\"1 cm\", \"0 cm\"], [\"2 cm\", \"0 cm\"]"),
       {"impossible polygon", "its area is zero"}},
      {"corner twice",
       beam_with("[\"-23 cm\", \"-20 cm\"]", "[\"-3 cm\", \"0 cm\"]"),
       {"impossible polygon", "corner 2 lies on the one before it"}},
      {"no normal",
       beam_and("[obstacles.floor]\nshape = \"half_plane\"\npoint = [\"0 m\", \"0 m\"]\nnormal = [0, 0]\n"),
       {"the normal has no length", "bad.toml:32:10", "write it like [0, 1]"}},
      {"name with a path",
       beam_with("[bodies.beam]", "[bodies.\"../beam\"]"),
       {"impossible name \"../beam\"", "bad.toml:12:9", "use up to 64 letters"}},
      {"name with a dot", beam_with("\"corner\"", "\"a.b\""), {"impossible name \"a.b\"", "bad.toml:23:8"}},
      {"empty name", beam_with("\"corner\"", "\"\""), {"impossible name \"\"", "bad.toml:23:8"}},
      {"name with an escape", beam_with("\"corner\"", "\"\\u001b[31m\""), {"impossible name \"?[31m\""}},
      {"long name", beam_with("\"corner\"", "\"" + std::string(65, 'n') + "\""), {"impossible name \"nnn"}},
      {"name twice",
       beam_and("[[observe.elements]]\nname = \"corner\"\nbody = \"beam\"\nat = [\"0 m\", \"1 cm\"]\n"),
       {"the name \"corner\" is taken", "bad.toml:30:8", "choose another name"}},
      {"adams2 alone",
       beam_with("\"central_difference\"", "\"adams2\""),
       {"adams2 needs a fixed time_step", "bad.toml:4:13", "adams2 needs when_unstable = \"continue\"",
        "bad.toml:1:1"}},
      {"times do not rise",
       beam_and("[supports.s]\nbody = \"beam\"\nnodes = { side = \"left\" }\nmove_x = { times = [\"1 s\", \"1 s\"], "
                "values = [\"0 m\", \"1 m\"] }\n"),
       {"times do not rise", "bad.toml:32:28"}},
      {"table lengths",
       beam_and("[supports.s]\nbody = \"beam\"\nnodes = { side = \"left\" }\nmove_x = { times = [\"0 s\", \"1 s\"], "
                "values = [\"0 m\"] }\n"),
       {"times and values do not match", "bad.toml:32:45", "1 values for 2 times"}},
      {"support without motion",
       beam_and("[supports.s]\nbody = \"beam\"\nnodes = { side = \"left\" }\n"),
       {"the support \"s\" holds nothing", "bad.toml:29:1", "add move_y = \"0 m\""}},
      {"turn and move",
       beam_and("[supports.s]\nbody = \"beam\"\nnodes = { side = \"left\" }\nmove_x = \"0 m\"\nturn = { about = [\"0 "
                "m\", \"0 m\"], angle = \"1 rad\" }\n"),
       {"a support either turns or moves", "bad.toml:33:8"}},
      {"angle without unit",
       beam_and("[supports.s]\nbody = \"beam\"\nnodes = { side = \"left\" }\nturn = { about = [\"0 m\", \"0 m\"], "
                "angle = 35 }\n"),
       {"missing unit for `angle`", "bad.toml:32:42", "write \"35 deg\" or \"35 rad\""}},
      {"nothing selected",
       beam_and("[supports.s]\nbody = \"beam\"\nnodes = {}\nmove_x = \"0 m\"\n"),
       {"nothing is selected", "bad.toml:31:9", "write it like { side = \"left\" }"}},
      {"selected twice",
       beam_and("[supports.s]\nbody = \"beam\"\nnodes = { side = \"left\", point = [\"0 m\", \"0 m\"] }\nmove_x = \"0 "
                "m\"\n"),
       {"selected in more than one way", "bad.toml:31:9"}},
      {"line of one point",
       beam_and("[supports.s]\nbody = \"beam\"\nnodes = { line = [[\"0 m\", \"0 m\"]] }\nmove_x = \"0 m\"\n"),
       {"wrong number of points for `line`", "bad.toml:31:18", "there are 1; 2 are needed"}},
      {"line without length",
       beam_and("[supports.s]\nbody = \"beam\"\nnodes = { line = [[\"0 m\", \"0 m\"], [\"0 m\", \"0 m\"]] }\nmove_x = "
                "\"0 m\"\n"),
       {"the line has no length", "bad.toml:31:18"}},
      {"pair with an unknown body",
       beam_and("[[contact.pairs]]\nbody = \"beam\"\nother = \"baem\"\ntouch = \"no\"\n"),
       {"baem", "bad.toml:31:9", "beam"}},
      {"pair named twice",
       beam_and(
           "[[contact.pairs]]\nbody = \"beam\"\nother = \"beam\"\nfriction = 0.1\n[[contact.pairs]]\nbody = \"beam\"\n"
           "other = \"beam\"\n"),
       {"the pair beam, beam stands here twice", "bad.toml:35:9"}},
      {"pair that may touch",
       beam_and("[[contact.pairs]]\nbody = \"beam\"\nother = \"beam\"\ntouch = \"maybe\"\n"),
       {"maybe", "bad.toml:32:9", "yes"}},
      {"two loads in one",
       beam_and(
           "[loads.l]\nbody = \"beam\"\nnodes = { side = \"top\" }\nforce = [\"0 N\", \"1 N\"]\npressure = \"1 Pa\"\n"),
       {"`force` and `pressure` exclude each other", "bad.toml:33:1"}},
      {"no load",
       beam_and("[loads.l]\nbody = \"beam\"\nnodes = { side = \"top\" }\n"),
       {"one of force, traction or pressure is missing", "bad.toml:29:1"}},
      {"pressure on nodes",
       beam_and("[loads.l]\nbody = \"beam\"\nnodes = { side = \"top\" }\npressure = \"1 Pa\"\n"),
       {"a pressure acts on edges", "bad.toml:31:1", "write edges = { ... }"}},
      {"force on edges",
       beam_and("[loads.l]\nbody = \"beam\"\nedges = { side = \"top\" }\nforce = [\"1 N\", \"0 N\"]\n"),
       {"a force acts on nodes", "bad.toml:31:1", "write nodes = { ... }"}},
      {"pressure on a point",
       beam_and("[loads.l]\nbody = \"beam\"\nedges = { point = [\"0 m\", \"0 m\"] }\npressure = \"1 Pa\"\n"),
       {"a point selects no edges", "bad.toml:31:19"}},
      {"region of two points",
       beam_and(
           "[[observe.regions]]\nname = \"r\"\nbody = \"beam\"\npolygon = [[\"0 m\", \"0 m\"], [\"1 m\", \"0 m\"]]\n"),
       {"wrong number of points for `polygon`", "bad.toml:32:11", "at least 3 are needed"}},
      {"empty window",
       beam_with("body = \"beam\"", "body = \"beam\"\nwindow = [\"1 ms\", \"1 ms\"]"),
       {"empty window", "bad.toml:25:10", "give the earlier time first"}},
      {"window of one time",
       beam_with("body = \"beam\"", "body = \"beam\"\nwindow = [\"1 ms\"]"),
       {"wrong kind of value for `window`", "bad.toml:25:10"}},
      {"fields before the start",
       beam_and("fields_at = [\"-1 s\"]\n"),
       {"impossible value for `fields_at`", "bad.toml:29:14", "it must be at least 0"}},
      {"quotation marks in a text", beam_with("\"auto\"", "\"\\\"\\\\\""), {"for `time_step`", "bad.toml:4:13"}},
  };
}

TEST_CASE("every bad case is refused with place, reason and cure") {
  const auto all = bad_texts();
  CHECK(all.size() >= 70);
  for (const Bad& bad : all) {
    const std::string text = complaints(bad.text);
    CAPTURE(bad.name);
    CAPTURE(text);
    CHECK_FALSE(text.empty());
    for (const std::string& part : bad.said) {
      CAPTURE(part);
      CHECK(text.find(part) != std::string::npos);
    }
    CHECK(text.find('\x1b') == std::string::npos);
  }
}

TEST_CASE("all mistakes are told at once, in the order of the file") {
  std::string text = beam_with("yield_stress", "yeild_stress");
  text.replace(text.find("\"-80 m/s\""), 9, "\"-80 m\"");
  text.replace(text.find("\"2 ms\""), 6, "2");
  text.replace(text.find("\"steel\""), 7, "\"stel\"");
  try {
    read_case(text, "bad.toml");
    FAIL("nothing was found");
  } catch (const UserError& error) {
    REQUIRE(error.diagnostics.size() == 4);
    int line = 0;
    for (const Diagnostic& d : error.diagnostics) {
      CHECK(d.line > line);
      line = d.line;
    }
    const Diagnostic& d = error.diagnostics[3];
    CHECK(d.file == "bad.toml");
    CHECK(d.line == 15);
    CHECK(d.column == 22);
    CHECK(d.length == 9 - 2);
    CHECK(d.source == "velocity = [\"0 m/s\", \"-80 m\"]");
  }
}

TEST_CASE("equal mistakes are told once") {
  std::string text(short_beam);
  text += '\n';
  for (const char* name : {"a", "b", "c"})
    text += std::string("[materials.") + name + "]\nlaw = \"elastic\"\nyoung_modulus = \"1 GPa\"\npoisson_ratio = 0\n";
  const std::string said = complaints(text);
  CHECK(said.find("bad.toml:29:1") != std::string::npos);
  CHECK(said.find("and 2 more like it on lines 33 and 37") != std::string::npos);
  CHECK(said.find("bad.toml:33:1") == std::string::npos);
}

TEST_CASE("thousands of mistakes fit on a screen or two") {
  std::string text(short_beam);
  for (int i = 0; i < 20000; ++i) text += "frction" + std::to_string(i) + " = 1\n";
  const std::string said = complaints(text);
  CHECK(said.find("more mistakes") != std::string::npos);
  CHECK(said.size() < 20000);
}

TEST_CASE("no prefix of a case and no changed byte of it does harm") {
#if defined(UDAR_SANITIZED)
  constexpr std::size_t step = 5;  // slow there; every byte and every place still have their turn
#else
  constexpr std::size_t step = 1;
#endif
  for (std::size_t n = 0; n < short_beam.size(); n += step) complaints(short_beam.substr(0, n));
  constexpr std::string_view bytes{"\0\"'[]{.=\n\\\xc3#e-", 14};
  for (std::size_t k = 0; k < short_beam.size() * bytes.size(); k += step) {
    std::string text(short_beam);
    text[k / bytes.size()] = bytes[k % bytes.size()];
    complaints(text);
  }
}

}  // namespace
}  // namespace udar

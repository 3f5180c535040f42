#include <doctest/doctest.h>

#include <cmath>

#include "tests/results/scratch.hpp"
#include "udar/results/file.hpp"
#include "udar/study/history_source.hpp"
#include "udar/study/table_text.hpp"

using namespace udar;

namespace {

const std::vector<HistoryColumns> known{{"corner", {{"displacement_y", "m"}, {"velocity_y", "m/s"}}},
                                        {"a.b", {{"stress_x", "Pa"}, {"flows", ""}}}};

MeasuredTable table_of(const std::string& text, std::vector<std::string> maps = {}, const char* name = "t.csv") {
  const Scratch folder;
  write_file(folder / name, text);
  return read_table(folder / name, {.maps = std::move(maps), .known = &known});
}

std::string refused(const std::string& text, std::vector<std::string> maps = {}) {
  return message_of<UserError>([&] { table_of(text, std::move(maps)); });
}

}  // namespace

TEST_CASE("units become SI, to the last bit where they are decimal") {
  const MeasuredTable t = table_of(
      "time [ms],corner.displacement_y [mm],a.b.stress_x [kgf/cm2],corner.velocity_y [cm/s],a.b.flows\n"
      "0.9,-3.7,1,250,0\n2.5,1e3,-2400,-0.5,1\n");
  CHECK(t.times == std::vector<double>{0.0009, 0.0025});
  REQUIRE(t.histories.size() == 2);
  CHECK(t.histories[0].history == "corner");
  CHECK(t.histories[0].columns == std::vector<Column>{{"displacement_y", "m"}, {"velocity_y", "m/s"}});
  CHECK(t.values[0][0] == std::vector<double>{-0.0037, 1});
  CHECK(t.values[0][1] == std::vector<double>{2.5, -0.005});
  CHECK(t.values[1][0][0] == 98066.5);
  CHECK(t.values[1][0][1] == doctest::Approx(-2400 * 98066.5).epsilon(1e-15));
  CHECK(t.values[1][1] == std::vector<double>{0, 1});
}

TEST_CASE("what spreadsheets of any country write") {
  const std::vector<double> expected{-0.0015, 0.0025};
  for (const char* text : {
           "t [ms];corner.displacement_y [mm]\n0;-1,5\n1;2,5\n",
           "t [ms]\tcorner.displacement_y [mm]\n0\t-1,5\n1\t2.5\n",
           "\xef\xbb\xbf\"t [ms]\";\"corner.displacement_y [mm]\"\r\n0;\"-1,5\"\r\n1;2,5",
           "# made by hand\n\n  # more\nt [ms], corner.displacement_y [mm]\n0, -1.5\n# between\n1, +2.5\n",
           "\"t [ms]\",\"corner.displacement_y [mm]\"\n0,\"-1,5\"\n1,\"2,5\"\n",
           "t [ms],corner.displacement_y [mm],\n0,-1.5,\n1,2.5,\n",
           "t [ms],corner.displacement_y [mm],note\n0,-1.5,\"a, b\"\n1,2.5,\n",
           "t [\xc2\xb5s];corner.displacement_y [mm]\n0;-1,5\n1000;2,5\n",
       }) {
    CAPTURE(text);
    const MeasuredTable t = table_of(text);
    CHECK(t.times == std::vector<double>{0, 0.001});
    REQUIRE(t.values.size() == 1);
    CHECK(t.values[0][0] == expected);
  }
}

TEST_CASE("empty fields are no numbers; no unit means SI") {
  const MeasuredTable t = table_of("t,corner.displacement_y,corner.velocity_y [-]\n0,,1\n1,nan,-\n2,3,4\n");
  CHECK(std::isnan(t.values[0][0][0]));
  CHECK(std::isnan(t.values[0][0][1]));
  CHECK(t.values[0][0][2] == 3);
  CHECK(std::isnan(t.values[0][1][1]));
}

TEST_CASE("columns mean what the map says, or the history that the file is named after") {
  const MeasuredTable t =
      table_of("t [s];w = deflection [mm];temperature [m]\n0;1;20\n1;2;21\n", {"w = deflection=corner.displacement_y"});
  CHECK(t.histories[0].name_of(t.histories[0].columns[0]) == "corner.displacement_y");
  CHECK(t.values[0][0] == std::vector<double>{0.001, 0.002});
  CHECK(t.unused == std::vector<std::string>{"temperature"});
  const MeasuredTable own = table_of("time [s],velocity_y [m/s]\n0,1\n", {}, "corner.csv");
  CHECK(own.histories[0].history == "corner");
}

TEST_CASE("a table that is compared with a table keeps all its columns") {
  const Scratch folder;
  write_file(folder / "x.csv", "t [min],force [kN],a.b.c [m^2]\n0,1,2\n1,3,4\n");
  const MeasuredTable t = read_table(folder / "x.csv", {});
  CHECK(t.times == std::vector<double>{0, 60});
  REQUIRE(t.histories.size() == 2);
  CHECK(t.histories[0].history == "");
  CHECK(t.histories[0].columns[0] == Column{"force", "N"});
  CHECK(t.values[0][0] == std::vector<double>{1000, 3000});
  CHECK(t.histories[1].history == "a.b");
  CHECK(t.histories[1].columns[0] == Column{"c", "m^2"});
}

TEST_CASE("mistakes are told with their line, reason and cure") {
  const std::string head = "t [ms],corner.displacement_y [mm]\n";
  CHECK(contains(refused(""), "is empty"));
  CHECK(contains(refused("# only a comment\n"), "is empty"));
  CHECK(contains(refused(head), "the table has no rows"));
  CHECK(contains(refused("0,1\n1,2\n"), "t.csv:1:1"));
  CHECK(contains(refused("0,1\n1,2\n"), "the first line holds no names"));
  CHECK(contains(refused("time\n0\n"), "two columns at least"));
  CHECK(contains(refused(head + "0,1\n\n1,2,3\n"), "t.csv:4:1"));
  CHECK(contains(refused(head + "0,5,1,5\n"), "decimal comma"));
  CHECK(contains(refused(head + "0,1\n1,x\n"), "`x` is not a number"));
  CHECK(contains(refused(head + "0,1\n1,x\n"), "t.csv:3:1"));
  CHECK(contains(refused("t;corner.velocity_y\n0;1.234,5\n"), "`1.234,5` is not a number"));
  CHECK(contains(refused(head + "1,1\n0,2\n"), "time goes back"));
  CHECK(contains(refused(head + ",1\n"), "a row has no time"));
  CHECK(contains(refused(head + "0,\"1\n"), "a quote is not closed"));
  CHECK(contains(refused("t [mm],corner.velocity_y\n0,1\n"), "it is a length; the first column is a time"));
  const std::string wrong = refused("t,corner.velocity_y [mm]\n0,1\n");
  CHECK(contains(wrong, "it is a length; corner.velocity_y is a velocity"));
  CHECK(contains(wrong, "write a unit such as [m/s]"));
  const std::string unknown = refused("t,corner.velocity_y [m/sec]\n0,1\n");
  CHECK(contains(unknown, "unknown unit `sec` in the column `corner.velocity_y [m/sec]`"));
  CHECK_FALSE(contains(unknown, "\"1 "));
  CHECK(contains(refused("t,corner.velocity_y,v\n0,1,2\n", {"v=corner.velocity_y"}), "two columns mean"));
  CHECK(contains(refused("t,v\n0,1\n", {"w=corner.velocity_y"}), "has no column `w`"));
  CHECK(contains(refused("t,v\n0,1\n", {"v=corner.velocity"}), "did you mean `corner.velocity_y`?"));
  CHECK(contains(refused("t,v\n0,1\n", {"v"}), "`--map v` is not understood"));
  CHECK(contains(refused(std::string("\xff\xfet\0,\0v\0", 8)), "UTF-16"));
  CHECK(contains(refused(head + std::string("0,\0", 3)), "zero bytes"));
  CHECK(contains(refused(head + std::string(3 << 20, '7')), "too long"));
}

TEST_CASE("a table larger than 256 MB is refused before it is read") {
  const Scratch folder;
  write_file(folder / "big.csv", "t,v\n");
  std::filesystem::resize_file(folder / "big.csv", largest_table + 1);
  CHECK(contains(message_of<UserError>([&] { read_table(folder / "big.csv", {}); }), "268435457 bytes"));
  CHECK_THROWS_AS(read_table(folder / "none.csv", {}), UserError);
  CHECK_THROWS_AS(read_table("/dev/zero", {}), UserError);
}

TEST_CASE("memory is bounded: columns that are not compared cost none") {
  const Scratch folder;
  write_file(folder / "t.csv", "t,corner.displacement_y,x,y\n0,1,2,3\n1,1,2,3\n2,1,2,3\n");
  const auto read = [&](std::size_t most) {
    return message_of<UserError>(
        [&] { read_table(folder / "t.csv", {.maps = {}, .known = &known, .most_values = most}); });
  };
  CHECK(read(6) == "");
  CHECK(contains(read(5), "t.csv:4:1"));
  CHECK(contains(read(5), "too many rows"));
}

TEST_CASE("lines come whole, wherever pieces of the file end") {
  const Scratch folder;
  std::string text = "t,corner.displacement_y\n";
  for (int i = 0; i < 200000; ++i) text += std::to_string(i) + "," + std::to_string(3 * i) + "\n";
  write_file(folder / "t.csv", text);
  const MeasuredTable t = read_table(folder / "t.csv", {.maps = {}, .known = &known});
  REQUIRE(t.times.size() == 200000);
  bool right = true;
  for (std::size_t i = 0; i < t.times.size(); ++i) {
    right = right && t.times[i] == static_cast<double>(i) && t.values[0][0][i] == 3 * t.times[i];
  }
  CHECK(right);
}

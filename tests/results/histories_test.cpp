#include "udar/results/histories.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>

#include "tests/results/scratch.hpp"

using namespace udar;

TEST_CASE("a history reads back with every bit") {
  const Scratch folder;
  const std::vector<Column> columns{{"time", "s"}, {"displacement_x", "m"}, {"flows", ""}};
  HistoryWriter writer(folder / "a.csv", columns);
  std::vector<std::array<double, 3>> rows{{0, -0.0, 1}, {1e-9 / 3, 6.4e-8, 0}, {M_PI, 5e-324, 1}};
  for (int i = 0; i < 40; ++i) rows.push_back({i + 0.1, 1.0 / (i + 3), 0});
  for (const auto& row : rows) writer.write_row(row);
  writer.close();

  const History history = read_csv(folder / "a.csv");
  CHECK(history.columns == columns);
  REQUIRE(history.at("time").size() == rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < 3; ++c) CHECK(history.values[c][r] == rows[r][c]);
  }
  CHECK(std::signbit(history.values[1][0]));
  CHECK(read_file(folder / "a.csv", 100000).starts_with("time [s],displacement_x [m],flows\n0,-0,1\n"));
}

TEST_CASE("numbers that are none are kept") {
  const Scratch folder;
  HistoryWriter writer(folder / "a.csv", {{"x", ""}, {"y", ""}});
  writer.write_row(std::array{std::nan(""), -std::numeric_limits<double>::infinity()});
  writer.close();
  const History history = read_csv(folder / "a.csv");
  CHECK(std::isnan(history.at("x")[0]));
  CHECK(history.at("y")[0] == -std::numeric_limits<double>::infinity());
}

TEST_CASE("rows of a running program are seen once they are flushed, and half a row of a killed one is dropped") {
  const Scratch folder;
  HistoryWriter writer(folder / "a.csv", {{"x", "m"}});
  for (double x = 0; x < 100; ++x) writer.write_row(std::array{x});
  writer.flush();
  CHECK(read_csv(folder / "a.csv").at("x").size() == 100);
  CHECK(parse_csv("a,b\n1,2\n3,", "f").at("b") == std::vector<double>{2});
}

TEST_CASE("a full disk is reported") {
  HistoryWriter writer("/dev/full", {{"x", "m"}});
  writer.write_row(std::array{1.0});
  CHECK_THROWS_AS(writer.close(), OutputError);
}

TEST_CASE("damaged histories are refused with file, line and reason") {
  const auto refused = [](const char* text) { return message_of<OutputError>([&] { parse_csv(text, "h.csv"); }); };
  CHECK(contains(refused(""), "h.csv:1: there is no header"));
  CHECK(contains(refused("\n"), "h.csv:1: the header is empty"));
  CHECK(contains(refused("a,,b\n"), "h.csv:1:"));
  CHECK(contains(refused("a [m\n"), "h.csv:1: the column `a [m`"));
  CHECK(contains(refused("a,b\n1,2\n1\n"), "h.csv:3: 1 values where the header names 2 columns"));
  CHECK(contains(refused("a\n1,2\n"), "h.csv:2: 2 values"));
  CHECK(contains(refused("a\n1e\n"), "h.csv:2: `1e` is not a number"));
  CHECK(contains(refused("a\n0x10\n"), "not a number"));
  CHECK(contains(refused("a\n\n"), "h.csv:2: 0 values"));
  CHECK(contains(refused((std::string(30000, ',') + "\n").c_str()), "h.csv:1:"));
  const History history = parse_csv("a,b\n", "h.csv");
  CHECK(
      contains(message_of<OutputError>([&] { static_cast<void>(history.at("c")); }), "no column `c`; there is a or b"));
}

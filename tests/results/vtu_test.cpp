#include "udar/results/vtu.hpp"

#include <doctest/doctest.h>
#include <fmt/core.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "tests/results/scratch.hpp"
#include "udar/results/file.hpp"
#include "udar/results/pvd.hpp"

using namespace udar;

namespace {

/// Columns x rows squares of two triangles each, with every kind of field.
VtuGrid example(int columns, int rows) {
  std::vector<Vec2> points;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) points.push_back({0.1 * i, 0.1 * j});
  }
  std::vector<std::array<std::int32_t, 3>> triangles;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const std::int32_t a = j * (columns + 1) + i;
      triangles.push_back({a, a + 1, a + columns + 2});
      triangles.push_back({a, a + columns + 2, a + columns + 1});
    }
  }
  VtuGrid grid = triangle_grid(1.25e-3, points, triangles);
  std::vector<double> numbers;
  std::vector<std::int32_t> names;
  std::vector<std::uint8_t> flags;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    numbers.push_back(std::sin(static_cast<double>(i)));
    names.push_back(static_cast<std::int32_t>(i) - 3);
    flags.push_back(i % 3 == 0);
  }
  grid.point_fields.push_back(vector_field("velocity", "m/s", points));
  grid.cell_fields.push_back(scalar_field("plastic_strain", "", numbers));
  grid.cell_fields.push_back({"exact", 1, numbers});
  grid.cell_fields.push_back(number_field("element", names));
  grid.cell_fields.push_back(flag_field("flows now", flags));
  return grid;
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("a frame reads back equal, over many compressed blocks and over none") {
  const Scratch folder;
  for (const auto& [columns, rows] : {std::pair{0, 0}, {1, 1}, {16, 64}, {120, 60}}) {
    const VtuGrid grid = example(columns, rows);
    write_vtu(folder / "a.vtu", grid);
    CHECK(read_vtu(folder / "a.vtu") == grid);
  }
  CHECK(parse_vtu(to_vtu({})) == VtuGrid{});
}

TEST_CASE("of a frame only what is wanted is read") {
  const Scratch folder;
  const VtuGrid grid = example(16, 64);
  write_vtu(folder / "a.vtu", grid);
  const VtuGrid part = read_vtu(folder / "a.vtu", {.fields = {"velocity_m_per_s", "flows_now", "nothing"}});
  CHECK(part.time == grid.time);
  CHECK(part.points == grid.points);
  CHECK(part.point_fields == grid.point_fields);
  REQUIRE(part.cell_fields.size() == 1);
  CHECK(part.cell_fields[0] == grid.cell_fields.back());
  CHECK(part.corners.empty());
  CHECK(part.ends.empty());
  const VtuGrid cells = read_vtu(folder / "a.vtu", {.fields = {}, .cells = true});
  CHECK(cells.corners == grid.corners);
  CHECK(cells.ends == grid.ends);
  CHECK(cells.kinds == grid.kinds);
  CHECK(cells.cell_fields.empty());
  const VtuGrid field = read_vtu(folder / "a.vtu", {.fields = {"exact"}, .places = false});
  CHECK(field.points.empty());
  CHECK(field.cell_fields.at(0) == grid.cell_fields.at(1));
  CHECK(vtu_fields(folder / "a.vtu") ==
        std::vector<std::string>{"velocity_m_per_s", "plastic_strain", "exact", "element", "flows_now"});
}

TEST_CASE("frames packed one after another, in memory that is used again, each read back as it was") {
  const Scratch folder;
  int asked = 0;
  double shift = 0;
  const auto frame = [&](std::size_t count) {
    const auto numbers = [&](std::string name, auto number, bool constant) {
      using Number = decltype(number);
      return VtuField{std::move(name), 1, count,
                      VtuSource<Number>([&, constant](std::size_t first, std::span<Number> out) {
                        if (constant) ++asked;
                        for (std::size_t k = 0; k < out.size(); ++k) {
                          out[k] = static_cast<Number>((constant ? 0 : shift) + static_cast<double>(first + k));
                        }
                      }),
                      constant};
    };
    return VtuFrame{.time = shift,
                    .points = count,
                    .cells = 0,
                    .places = vectors<double>("Points", count,
                                              [&](std::size_t i) {
                                                return Vec2{shift, static_cast<double>(i)};
                                              }),
                    .corners = {"connectivity", 1, 0, VtuSource<std::int32_t>([](std::size_t, auto) {})},
                    .ends = {"offsets", 1, 0, VtuSource<std::int32_t>([](std::size_t, auto) {})},
                    .kinds = {"types", 1, 0, VtuSource<std::uint8_t>([](std::size_t, auto) {})},
                    .point_fields = {numbers("moves", float{}, false), numbers("stays", std::int32_t{}, true)},
                    .cell_fields = {}};
  };
  constexpr std::size_t count = 60000;  // of 4 bytes: three blocks
  std::vector<std::size_t> order;
  VtuPacker packer([&](std::size_t jobs, const std::function<void(std::size_t)>& job) {
    order.push_back(jobs);
    for (std::size_t k = jobs; k > 0; --k) job(k - 1);
  });
  std::array<PackedVtu, 2> packed;
  const auto check = [&](const PackedVtu& one) {
    FileReplacement file(folder / "a.vtu");
    write_vtu(file, one);
    file.commit();
    CHECK(std::filesystem::file_size(folder / "a.vtu") == one.size());
    return read_vtu(folder / "a.vtu");
  };
  for (int k = 0; k < 6; ++k) {
    shift = 0.5 * k;
    packer.pack(frame(count), packed[static_cast<std::size_t>(k % 2)]);
    CHECK(asked == 3);  // what stays is asked for once, block by block
  }
  CHECK(order[0] == order[1] + 3);
  for (const int k : {4, 5}) {
    const VtuGrid grid = check(packed[static_cast<std::size_t>(k % 2)]);
    CHECK(grid.time == 0.5 * k);
    CHECK(grid.points[count - 1] == Vec2{0.5 * k, count - 1.0});
    CHECK(std::get<std::vector<float>>(grid.point_fields[0].values)[count - 1] ==
          static_cast<float>(0.5 * k + count - 1));
    CHECK(std::get<std::vector<std::int32_t>>(grid.point_fields[1].values)[count - 1] == count - 1);
  }
}

TEST_CASE("outlines of obstacles read back equal") {
  VtuGrid grid;
  grid.add_polygon(std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  grid.points.push_back({5, 5});
  grid.add_cell(VtuCell::line, std::array{0, 4});
  CHECK(parse_vtu(to_vtu(grid)) == grid);
}

TEST_CASE("field names are safe in ParaView and tell the unit") {
  CHECK(field_name("velocity", "m/s") == "velocity_m_per_s");
  CHECK(field_name("acceleration", "m/s^2") == "acceleration_m_per_s2");
  CHECK(field_name("flows now", "") == "flows_now");
  CHECK(field_name("a<b>\"&", "") == "a_b___");
}

TEST_CASE("numbers beyond 32 bits stay finite in fields") {
  const VtuArray field = scalar_field("x", "", std::vector<double>{1e300, -1e300, std::nan("")});
  const auto& values = std::get<std::vector<float>>(field.values);
  CHECK(values[0] == std::numeric_limits<float>::max());
  CHECK(values[1] == -std::numeric_limits<float>::max());
  CHECK(std::isnan(values[2]));
}

TEST_CASE("a field of the wrong length is not written") {
  VtuGrid grid = example(1, 1);
  grid.cell_fields.push_back({"short", 1, std::vector<double>{1}});
  CHECK(contains(message_of<OutputError>([&] { to_vtu(grid); }), "field `short`"));
}

TEST_CASE("headers that lie are refused before memory is taken") {
  const std::string good = to_vtu(example(4, 2));
  const auto refused = [&](std::string_view from, std::string_view to) {
    return contains(message_of<OutputError>([&] { parse_vtu(replaced(good, from, to)); }), "field file");
  };
  CHECK(refused("NumberOfPoints=\"15\"", "NumberOfPoints=\"18446744073709551615\""));
  CHECK(refused("NumberOfPoints=\"15\"", "NumberOfPoints=\"1000000000000\""));
  CHECK(refused("NumberOfPoints=\"15\"", "NumberOfPoints=\"-15\""));
  CHECK(refused("NumberOfPoints=\"15\"", "NumberOfPoints=\"14\""));
  CHECK(refused("NumberOfCells=\"16\"", "NumberOfCells=\"99999\""));
  CHECK(refused("NumberOfComponents=\"3\"", "NumberOfComponents=\"4000000000\""));
  CHECK(refused("NumberOfComponents=\"3\"", "NumberOfComponents=\"0\""));
  CHECK(refused("offset=\"0\"", "offset=\"99999999\""));
  CHECK(refused("type=\"Int32\"", "type=\"Int64\""));
  CHECK(refused("vtkZLibDataCompressor", "vtkLZ4DataCompressor"));
  CHECK(refused("<AppendedData", "<OtherData"));
  CHECK(refused("connectivity", "conectivity"));
}

TEST_CASE("a small file cannot unpack to a huge one") {
  VtuGrid grid;
  grid.points.resize(2'000'000);  // 48 MB of zeros in some 200 kB
  const std::string good = to_vtu(grid);
  CHECK(parse_vtu(good).points.size() == grid.points.size());
  const std::size_t tag = good.find("<DataArray type=\"Float64\" Name=\"Points\"");
  const std::string field = good.substr(tag, good.find('>', tag) + 1 - tag);
  std::string fields = "<PointData>";
  for (int i = 0; i < 100; ++i) fields += field;
  CHECK(contains(message_of<OutputError>([&] { parse_vtu(replaced(good, "<PointData>", fields)); }),
                 "a count is larger"));
}

TEST_CASE("cells that name missing points are refused") {
  VtuGrid grid = example(1, 1);
  grid.corners[0] = 4;
  CHECK_THROWS_AS(parse_vtu(to_vtu(grid)), OutputError);
  grid.corners[0] = -1;
  CHECK_THROWS_AS(parse_vtu(to_vtu(grid)), OutputError);
  grid = example(1, 1);
  grid.ends = {5, 3};
  CHECK_THROWS_AS(parse_vtu(to_vtu(grid)), OutputError);
}

TEST_CASE("cut and damaged frames are refused or read, never a crash") {
  const std::string good = to_vtu(example(4, 2));
  for (std::size_t size = 0; size < good.size(); size += 7) {
    try {
      parse_vtu(std::string_view(good).substr(0, size));
    } catch (const OutputError&) {
    }
  }
  std::mt19937 random(1);
  for (int trial = 0; trial < 3000; ++trial) {
    std::string bad = good;
    for (int flips = 0; flips < 3; ++flips) bad[random() % bad.size()] = static_cast<char>(random());
    try {
      parse_vtu(bad);
    } catch (const OutputError&) {
    }
  }
}

TEST_CASE("the index grows by frames and reads back") {
  const Scratch folder;
  PvdIndex index(folder / "fields.pvd");
  index.add({{0, 0, "fields/bodies_000000.vtu"}, {0, 1, "fields/obstacles_000000.vtu"}});
  CHECK_FALSE(std::filesystem::exists(folder / "fields.pvd"));
  index.write();
  CHECK(read_pvd(folder / "fields.pvd") == index.entries());
  index.add({{2e-5 / 3, 0, "fields/bodies_000001.vtu"}});
  CHECK(read_pvd(folder / "fields.pvd").size() == 2);
  index.write();
  CHECK(read_pvd(folder / "fields.pvd") == index.entries());
  CHECK(index.entries().size() == 3);
}

TEST_CASE("an index that is none, or leads out of its folder, is refused") {
  const auto with_file = [](const char* file) { return to_pvd({{0, 0, file}}); };
  CHECK_NOTHROW(parse_pvd(with_file("a&<b>.vtu")));
  CHECK(parse_pvd(with_file("a&<b>.vtu"))[0].file == "a&<b>.vtu");
  CHECK_THROWS_AS(parse_pvd(with_file("/etc/passwd")), OutputError);
  CHECK_THROWS_AS(parse_pvd(with_file("a/../../b")), OutputError);
  CHECK_THROWS_AS(parse_pvd(with_file("")), OutputError);
  CHECK_THROWS_AS(parse_pvd("<DataSet timestep=\"x\""), OutputError);
  CHECK_THROWS_AS(parse_pvd("<Collection><DataSet timestep=\"x\" file=\"a\"/>"), OutputError);
  CHECK_THROWS_AS(parse_pvd("hello"), OutputError);
  for (const char* time : {"nan", "inf", "-inf", "1e400", ""}) {
    CHECK_THROWS_AS(parse_pvd(fmt::format("<Collection><DataSet timestep=\"{}\" file=\"a\"/>", time)), OutputError);
  }
}

TEST_CASE("blocks that hold nothing are refused before they are unpacked") {
  VtuGrid grid;
  grid.points.resize(100);
  const std::string good = to_vtu(grid);
  const std::size_t data = good.find('_', good.find("<AppendedData")) + 1;
  std::uint64_t blocks = 0;
  std::memcpy(&blocks, good.data() + data, sizeof blocks);
  CHECK(blocks == 1);
  // 300 numbers may be cut into five blocks of 64 or so, not into a thousand.
  std::string bad = good + std::string(100000, '\0');
  blocks = 1000;
  std::memcpy(bad.data() + data, &blocks, sizeof blocks);
  CHECK(contains(message_of<OutputError>([&] { parse_vtu(bad); }), "more blocks than its numbers fill"));
}

#include "udar/results/vtu.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

#include "udar/base/error.hpp"
#include "udar/results/file.hpp"
#include "udar/results/run_folder.hpp"
#include "udar/results/xml.hpp"

namespace udar {
namespace {

static_assert(std::endian::native == std::endian::little, "VTU files are written as little-endian");

constexpr std::size_t block_bytes = 32768;

template <class Number>
constexpr std::string_view type_name() {
  if constexpr (std::is_same_v<Number, double>) return "Float64";
  if constexpr (std::is_same_v<Number, float>) return "Float32";
  if constexpr (std::is_same_v<Number, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<Number, std::uint8_t>) return "UInt8";
}

void append_number(std::string& out, std::uint64_t value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// `bytes` as VTK's zlib compressor lays them out: number of blocks, their size, size of a shorter last block or 0,
/// compressed size of each; then the blocks.
void append_compressed(std::string& out, std::string_view bytes) {
  const std::size_t block_count = (bytes.size() + block_bytes - 1) / block_bytes;
  append_number(out, block_count);
  append_number(out, block_bytes);
  append_number(out, bytes.size() % block_bytes);
  const std::size_t sizes_at = out.size();
  out.resize(sizes_at + block_count * sizeof(std::uint64_t));
  std::vector<Bytef> packed(compressBound(block_bytes));
  for (std::size_t b = 0; b < block_count; ++b) {
    const std::string_view block = bytes.substr(b * block_bytes, block_bytes);
    uLongf size = packed.size();
    const auto* source = reinterpret_cast<const Bytef*>(block.data());
    // Level 1: the higher ones cost the solver several times the time for a tenth of the size.
    if (compress2(packed.data(), &size, source, block.size(), 1) != Z_OK) throw std::bad_alloc();
    const std::uint64_t stored = size;
    std::copy_n(reinterpret_cast<const char*>(&stored), sizeof stored, out.data() + sizes_at + b * sizeof stored);
    out.append(reinterpret_cast<const char*>(packed.data()), size);
  }
}

template <class Number>
std::string_view bytes_of(const std::vector<Number>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number)};
}

/// The XML of a file and the data behind it, growing together.
struct VtuText {
  std::string xml;
  std::string data;

  template <class Number>
  void add_array(std::string_view name, int components, const std::vector<Number>& values) {
    xml += fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)"
                       "\n",
                       type_name<Number>(), escape_xml(name), components, data.size());
    append_compressed(data, bytes_of(values));
  }

  void add_fields(std::string_view section, const std::vector<VtuArray>& fields, std::size_t count) {
    xml += fmt::format("<{}>\n", section);
    for (const VtuArray& field : fields) {
      const std::size_t size = std::visit([](const auto& values) { return values.size(); }, field.values);
      if (field.components < 1 || size != count * static_cast<std::size_t>(field.components)) {
        throw OutputError(fmt::format("cannot write field `{}`: it has {} values where {} x {} are needed", field.name,
                                      size, count, field.components));
      }
      std::visit([&](const auto& values) { add_array(field.name, field.components, values); }, field.values);
    }
    xml += fmt::format("</{}>\n", section);
  }

  /// Twice under the names that programs look for: TimeValue in ParaView and VTK, TIME in VisIt.
  void add_time(double time) {
    xml += "<FieldData>\n";
    for (const char* name : {"TimeValue", "TIME"}) {
      xml += fmt::format(R"(<DataArray type="Float64" Name="{}" NumberOfTuples="1" format="appended" offset="{}"/>)"
                         "\n",
                         name, data.size());
    }
    xml += "</FieldData>\n";
    append_compressed(data, bytes_of(std::vector<double>{time}));
  }
};

}  // namespace

void VtuGrid::add_cell(VtuCell kind, std::span<const std::int32_t> points_of_cell) {
  corners.insert(corners.end(), points_of_cell.begin(), points_of_cell.end());
  ends.push_back(static_cast<std::int32_t>(corners.size()));
  kinds.push_back(static_cast<std::uint8_t>(kind));
}

void VtuGrid::add_polygon(std::span<const Vec2> outline) {
  std::vector<std::int32_t> numbers;
  for (const Vec2 point : outline) {
    numbers.push_back(static_cast<std::int32_t>(points.size()));
    points.push_back(point);
  }
  add_cell(VtuCell::polygon, numbers);
}

VtuGrid triangle_grid(double time, std::vector<Vec2> points, std::span<const std::array<std::int32_t, 3>> triangles) {
  VtuGrid grid;
  grid.time = time;
  grid.points = std::move(points);
  for (const auto& triangle : triangles) grid.add_cell(VtuCell::triangle, triangle);
  return grid;
}

std::string field_name(std::string_view quantity, std::string_view unit) {
  std::string out(quantity);
  if (!unit.empty()) {
    out += '_';
    for (const char c : unit) out += c == '/' ? std::string("_per_") : c == '^' ? std::string() : std::string(1, c);
  }
  out = safe_name(out);
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c == '.' || c == '-'; }, '_');
  return out;
}

VtuArray scalar_field(std::string_view quantity, std::string_view unit, std::span<const double> values) {
  // A double beyond the range of float has no defined conversion.
  constexpr double largest = std::numeric_limits<float>::max();
  std::vector<float> out(values.size());
  std::transform(values.begin(), values.end(), out.begin(), [=](double value) {
    return static_cast<float>(std::isnan(value) ? value : std::clamp(value, -largest, largest));
  });
  return {field_name(quantity, unit), 1, std::move(out)};
}

VtuArray vector_field(std::string_view quantity, std::string_view unit, std::span<const Vec2> values) {
  std::vector<double> flat;
  flat.reserve(3 * values.size());
  for (const Vec2 value : values) flat.insert(flat.end(), {value.x, value.y, 0.0});
  VtuArray field = scalar_field(quantity, unit, flat);
  field.components = 3;
  return field;
}

VtuArray number_field(std::string_view name, std::span<const std::int32_t> values) {
  return {field_name(name, ""), 1, std::vector<std::int32_t>(values.begin(), values.end())};
}

VtuArray flag_field(std::string_view name, std::span<const std::uint8_t> values) {
  return {field_name(name, ""), 1, std::vector<std::uint8_t>(values.begin(), values.end())};
}

std::string to_vtu(const VtuGrid& grid) {
  std::vector<double> places;
  places.reserve(3 * grid.points.size());
  for (const Vec2 point : grid.points) places.insert(places.end(), {point.x, point.y, 0.0});

  VtuText text;
  text.xml =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
      "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n";
  text.add_time(grid.time);
  text.xml +=
      fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", grid.points.size(), grid.kinds.size());
  text.add_fields("PointData", grid.point_fields, grid.points.size());
  text.add_fields("CellData", grid.cell_fields, grid.kinds.size());
  text.xml += "<Points>\n";
  text.add_array("Points", 3, places);
  text.xml += "</Points>\n<Cells>\n";
  text.add_array("connectivity", 1, grid.corners);
  text.add_array("offsets", 1, grid.ends);
  text.add_array("types", 1, grid.kinds);
  text.xml += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  return text.xml + text.data + "\n</AppendedData>\n</VTKFile>\n";
}

void write_vtu(const std::filesystem::path& path, const VtuGrid& grid) { write_file(path, to_vtu(grid)); }

}  // namespace udar

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "udar/base/error.hpp"
#include "udar/results/file.hpp"
#include "udar/results/vtu.hpp"
#include "udar/results/xml.hpp"

namespace udar {
namespace {

void check(bool right, std::string_view what) {
  if (!right) throw OutputError(fmt::format("not a field file of Udar, or a damaged one: {}", what));
}

/// Reads numbers and blocks of the appended data, never beyond its end.
struct DataReader {
  std::string_view data;

  std::string_view take(std::uint64_t size) {
    check(size <= data.size(), "data ends early");
    const std::string_view piece = data.substr(0, size);
    data.remove_prefix(size);
    return piece;
  }
  std::uint64_t number() {
    std::uint64_t value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
};

/// Unpacks the array at the start of `data` into `out`, whose size says how long it must be.
void unpack(std::string_view data, std::span<std::byte> out) {
  DataReader sizes{data};
  const std::uint64_t block_count = sizes.number();
  const std::uint64_t block_size = sizes.number();
  const std::uint64_t last_size = sizes.number();
  check(block_count <= sizes.data.size() / sizeof(std::uint64_t), "more blocks than bytes");
  DataReader blocks{sizes.data.substr(block_count * sizeof(std::uint64_t))};
  std::size_t filled = 0;
  for (std::uint64_t b = 0; b < block_count; ++b) {
    const std::string_view packed = blocks.take(sizes.number());
    const std::uint64_t size = b + 1 == block_count && last_size != 0 ? last_size : block_size;
    check(size <= out.size() - filled, "an array is longer than its header says");
    uLongf unpacked = size;
    const int result = uncompress(reinterpret_cast<Bytef*>(out.data() + filled), &unpacked,
                                  reinterpret_cast<const Bytef*>(packed.data()), packed.size());
    check(result == Z_OK && unpacked == size, "a compressed block is damaged");
    filled += size;
  }
  check(filled == out.size(), "an array is shorter than its header says");
}

template <class Number>
std::vector<Number> read_values(std::string_view data, std::size_t count) {
  std::vector<Number> values(count);
  unpack(data, std::as_writable_bytes(std::span(values)));
  return values;
}

VtuValues read_values(std::string_view type, std::string_view data, std::size_t count) {
  if (type == "Float64") return read_values<double>(data, count);
  if (type == "Float32") return read_values<float>(data, count);
  if (type == "Int32") return read_values<std::int32_t>(data, count);
  check(type == "UInt8", "a number type is unknown");
  return read_values<std::uint8_t>(data, count);
}

struct GridReader {
  std::string_view data;  ///< behind the `_`
  std::size_t point_count = 0;
  std::size_t cell_count = 0;
  /// Numbers that may still be unpacked. zlib packs up to 1032 to 1 and arrays may share their bytes: without a limit
  /// on the whole, 1 MB of lies costs many GB. Frames of Udar unpack to some ten times their size.
  std::size_t budget = (std::size_t{1} << 23) + 8 * data.size();
  VtuGrid grid{};
  const VtuPart* part = nullptr;  ///< none: everything

  [[nodiscard]] bool wants_field(const XmlTag& tag) const {
    return part == nullptr ||
           std::find(part->fields.begin(), part->fields.end(), tag.attribute("Name")) != part->fields.end();
  }
  [[nodiscard]] bool wants_cells() const { return part == nullptr || part->cells; }

  VtuArray read_array(const XmlTag& tag, std::size_t tuples) {
    const std::size_t offset = tag.count("offset").value_or(data.size() + 1);
    const std::size_t components =
        tag.attributes.contains("NumberOfComponents") ? tag.count("NumberOfComponents").value_or(0) : std::size_t{1};
    check(tag.attribute("format") == "appended" && offset <= data.size(), "an array has no data");
    check(components >= 1 && components <= 9, "an array has an impossible number of components");
    check(tuples <= budget / components, "a count is larger than the data can hold");
    budget -= tuples * components;
    return {tag.attribute("Name"), static_cast<int>(components),
            read_values(tag.attribute("type"), data.substr(offset), tuples * components)};
  }

  template <class Number>
  std::vector<Number> read_plain(const XmlTag& tag, std::size_t count) {
    VtuArray array = read_array(tag, count);
    auto* values = std::get_if<std::vector<Number>>(&array.values);
    check(values != nullptr, fmt::format("`{}` has the wrong number type", array.name));
    return std::move(*values);
  }

  void read_points(const XmlTag& tag) {
    const VtuArray array = read_array(tag, point_count);
    const auto* places = std::get_if<std::vector<double>>(&array.values);
    check(places != nullptr && array.components == 3, "points are not three Float64");
    grid.points.resize(point_count);
    for (std::size_t i = 0; i < point_count; ++i) grid.points[i] = {(*places)[3 * i], (*places)[3 * i + 1]};
  }

  void read_cells(const XmlTag& tag) {
    const std::string name = tag.attribute("Name");
    if (name == "offsets") grid.ends = read_plain<std::int32_t>(tag, cell_count);
    if (name == "types") grid.kinds = read_plain<std::uint8_t>(tag, cell_count);
    if (name == "connectivity") connectivity = tag;
  }

  /// Its length stands in the last of `offsets`, which is written behind it.
  void read_connectivity() {
    check(grid.ends.size() == cell_count && grid.kinds.size() == cell_count, "cells are missing");
    std::int32_t before = 0;
    for (const std::int32_t end : grid.ends) {
      check(end >= before, "cell offsets fall");
      before = end;
    }
    grid.corners = read_plain<std::int32_t>(connectivity, static_cast<std::size_t>(before));
    for (const std::int32_t corner : grid.corners) {
      check(corner >= 0 && static_cast<std::size_t>(corner) < grid.points.size(), "a cell names a missing point");
    }
  }

  void read_tag(const std::string& section, const XmlTag& tag) {
    if (section == "FieldData" && tag.attribute("Name") == "TimeValue") grid.time = read_plain<double>(tag, 1)[0];
    if (section == "PointData" && wants_field(tag)) grid.point_fields.push_back(read_array(tag, point_count));
    if (section == "CellData" && wants_field(tag)) grid.cell_fields.push_back(read_array(tag, cell_count));
    if (section == "Points") read_points(tag);
    if (section == "Cells" && wants_cells()) read_cells(tag);
  }

  XmlTag connectivity{};
};

VtuGrid parse_part(std::string_view bytes, const VtuPart* part) {
  const std::size_t appended = bytes.find("<AppendedData encoding=\"raw\">");
  const std::size_t start = bytes.find('_', appended);
  check(appended != std::string_view::npos && start != std::string_view::npos, "there is no appended raw data");

  GridReader reader{.data = bytes.substr(start + 1)};
  reader.part = part;
  XmlScanner scanner(bytes.substr(0, appended));
  std::string section;
  std::size_t pieces = 0;
  while (const std::optional<XmlTag> tag = scanner.next()) {
    if (tag->name == "VTKFile") {
      const bool ours = tag->attribute("byte_order") == "LittleEndian" && tag->attribute("header_type") == "UInt64" &&
                        tag->attribute("compressor") == "vtkZLibDataCompressor";
      check(ours, "byte order, header type or compressor is another one");
    } else if (tag->name == "Piece" && !tag->closing) {
      check(++pieces == 1 && tag->count("NumberOfPoints") && tag->count("NumberOfCells"), "there is not one piece");
      reader.point_count = *tag->count("NumberOfPoints");
      reader.cell_count = *tag->count("NumberOfCells");
    } else if (tag->name == "DataArray") {
      reader.read_tag(section, *tag);
    } else {
      section = tag->closing ? "" : tag->name;
    }
  }
  check(pieces == 1 && reader.grid.points.size() == reader.point_count, "points are missing");
  if (reader.wants_cells()) reader.read_connectivity();
  return std::move(reader.grid);
}

VtuGrid read_part(const std::filesystem::path& path, const VtuPart* part) {
  constexpr std::size_t most_bytes = std::size_t{4} << 30;
  const std::string bytes = read_file(path, most_bytes);
  try {
    return parse_part(bytes, part);
  } catch (const OutputError& error) {
    throw OutputError(fmt::format("cannot read {}: {}", path.string(), error.what()));
  }
}

}  // namespace

VtuGrid parse_vtu(std::string_view bytes) { return parse_part(bytes, nullptr); }
VtuGrid read_vtu(const std::filesystem::path& path) { return read_part(path, nullptr); }
VtuGrid read_vtu(const std::filesystem::path& path, const VtuPart& part) { return read_part(path, &part); }

}  // namespace udar

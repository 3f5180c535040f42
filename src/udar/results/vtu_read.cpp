#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

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

/// What lies behind the `_`: in memory, or in a file of which only the arrays that are wanted are read.
struct AppendedData {
  std::size_t size = 0;
  std::function<std::string(std::size_t at, std::size_t count)> read;  ///< fewer bytes where the data end

  /// An array of so many numbers with its header: how many blocks, how long each is, the blocks.
  [[nodiscard]] std::string array(std::size_t at, std::size_t numbers) const {
    constexpr std::size_t word = sizeof(std::uint64_t);
    check(at <= size, "an array has no data");
    const std::string head = read(at, 3 * word);
    const std::uint64_t block_count = DataReader{head}.number();
    check(block_count <= (size - at) / word, "more blocks than bytes");
    // To unpack a block costs as much as a thousand numbers do, and arrays may share their bytes: empty blocks would
    // cost minutes. Writers take blocks of many thousand.
    constexpr std::size_t least_per_block = 64;
    check(block_count <= 1 + numbers / least_per_block, "more blocks than its numbers fill");
    const std::string words = read(at + 3 * word, block_count * word);
    std::size_t bytes = 3 * word + words.size();
    for (DataReader sizes{words}; !sizes.data.empty();) {
      const std::uint64_t block = sizes.number();
      check(block <= size, "data ends early");
      bytes = std::min(bytes + block, size);
    }
    return read(at, bytes);
  }
};

struct GridReader {
  AppendedData data;
  std::size_t point_count = 0;
  std::size_t cell_count = 0;
  /// Numbers that may still be unpacked. zlib packs up to 1032 to 1 and arrays may share their bytes: without a limit
  /// on the whole, 1 MB of lies costs many GB. Frames of Udar unpack to some ten times their size.
  std::size_t budget = (std::size_t{1} << 23) + 8 * data.size;
  VtuGrid grid{};
  const VtuPart* part = nullptr;  ///< none: everything

  [[nodiscard]] bool wants_field(const XmlTag& tag) const {
    return part == nullptr ||
           std::find(part->fields.begin(), part->fields.end(), tag.attribute("Name")) != part->fields.end();
  }
  [[nodiscard]] bool wants_cells() const { return part == nullptr || part->cells; }

  VtuArray read_array(const XmlTag& tag, std::size_t tuples) {
    const std::size_t offset = tag.count("offset").value_or(data.size + 1);
    const std::size_t components =
        tag.attributes.contains("NumberOfComponents") ? tag.count("NumberOfComponents").value_or(0) : std::size_t{1};
    check(tag.attribute("format") == "appended" && offset <= data.size, "an array has no data");
    check(components >= 1 && components <= 9, "an array has an impossible number of components");
    check(tuples <= budget / components, "a count is larger than the data can hold");
    budget -= tuples * components;
    return {tag.attribute("Name"), static_cast<int>(components),
            read_values(tag.attribute("type"), data.array(offset, tuples * components), tuples * components)};
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
    if (section == "Points" && (part == nullptr || part->places)) read_points(tag);
    if (section == "Cells" && wants_cells()) read_cells(tag);
  }

  XmlTag connectivity{};
};

/// The beginning of a file, long enough to hold all XML that Udar writes.
constexpr std::size_t head_bytes = std::size_t{1} << 15;

/// Where the appended data begin, and where in the text before them the XML ends.
struct Layout {
  std::size_t xml_end = 0;
  std::size_t data_begin = 0;
};

Layout layout_of(std::string_view begin) {
  const std::size_t appended = begin.substr(0, head_bytes).find("<AppendedData encoding=\"raw\">");
  const std::size_t start = begin.find('_', appended);
  check(appended != std::string_view::npos && start != std::string_view::npos, "there is no appended raw data");
  return {appended, start + 1};
}

VtuGrid read_grid(std::string_view xml, AppendedData data, const VtuPart* part) {
  GridReader reader{.data = std::move(data)};
  reader.part = part;
  XmlScanner scanner(xml);
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
  check(pieces == 1, "there is not one piece");
  const bool has_places = reader.grid.points.size() == reader.point_count;
  check(has_places || (part != nullptr && !part->places), "points are missing");
  if (reader.wants_cells()) reader.read_connectivity();
  return std::move(reader.grid);
}

VtuGrid read_part(const std::filesystem::path& path, const VtuPart* part) {
  const PartReader file(path);
  try {
    const std::string head = file.read(0, head_bytes);
    const Layout layout = layout_of(head);
    const auto read = [&](std::size_t at, std::size_t count) { return file.read(layout.data_begin + at, count); };
    return read_grid(std::string_view(head).substr(0, layout.xml_end), {file.size() - layout.data_begin, read}, part);
  } catch (const OutputError& error) {
    throw OutputError(fmt::format("cannot read {}: {}", path.string(), error.what()));
  }
}

}  // namespace

VtuGrid parse_vtu(std::string_view bytes) {
  const Layout layout = layout_of(bytes);
  const std::string_view data = bytes.substr(layout.data_begin);
  const auto read = [&](std::size_t at, std::size_t count) {
    return std::string(data.substr(std::min(at, data.size()), count));
  };
  return read_grid(bytes.substr(0, layout.xml_end), {data.size(), read}, nullptr);
}

VtuGrid read_vtu(const std::filesystem::path& path) { return read_part(path, nullptr); }
std::vector<std::string> vtu_fields(const std::filesystem::path& path) {
  const std::string head = PartReader(path).read(0, head_bytes);
  std::vector<std::string> names;
  std::string section;
  XmlScanner scanner(std::string_view(head).substr(0, layout_of(head).xml_end));
  while (const std::optional<XmlTag> tag = scanner.next()) {
    if (tag->name != "DataArray") section = tag->closing ? "" : tag->name;
    const bool field = tag->name == "DataArray" && (section == "PointData" || section == "CellData");
    if (field) names.push_back(tag->attribute("Name"));
  }
  return names;
}

VtuGrid read_vtu(const std::filesystem::path& path, const VtuPart& part) { return read_part(path, &part); }

}  // namespace udar

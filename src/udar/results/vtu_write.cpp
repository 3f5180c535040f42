#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

#include "udar/base/error.hpp"
#include "udar/results/file.hpp"
#include "udar/results/vtu.hpp"
#include "udar/results/xml.hpp"
#include "udar/results/zlib_stream.hpp"

namespace udar {
namespace {

static_assert(std::endian::native == std::endian::little, "VTU files are written as little-endian");

/// A whole number of vectors of any kind of number, so that no vector is cut.
constexpr std::size_t block_bytes = 98304;
static_assert(block_bytes % (3 * sizeof(double)) == 0);

template <class Number>
constexpr std::string_view name_of_type(const VtuSource<Number>&) {
  if constexpr (std::is_same_v<Number, double>) return "Float64";
  if constexpr (std::is_same_v<Number, float>) return "Float32";
  if constexpr (std::is_same_v<Number, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<Number, std::uint8_t>) return "UInt8";
}

template <class Number>
std::string_view bytes_of(std::span<const Number> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

void check_length(const VtuField& field, std::size_t count) {
  if (field.components >= 1 && field.size == count * static_cast<std::size_t>(field.components)) return;
  throw OutputError(fmt::format("cannot write field `{}`: it has {} values where {} x {} are needed", field.name,
                                field.size, count, field.components));
}

std::size_t size_of_number(const VtuField& field) {
  return std::visit([]<class Number>(const VtuSource<Number>&) { return sizeof(Number); }, field.source);
}

/// Asks for the numbers of one block and packs them into its place. Runs beside others.
void pack_block(const VtuField& field, std::size_t block, VtuBytes& out) {
  const std::span<char> room(out.room.data() + block * out.room_per_block, out.room_per_block);
  const auto pack = [&]<class Number>(const VtuSource<Number>& source) {
    constexpr std::size_t per_block = block_bytes / sizeof(Number);
    alignas(64) std::array<Number, per_block> numbers;  // not zeroed first
    const std::size_t first = block * per_block;
    const std::span<Number> piece(numbers.data(), std::min(per_block, field.size - first));
    source(first, piece);
    const std::string_view bytes = bytes_of<Number>(piece);
    return field.constant ? pack_tightly(bytes, room) : pack_quickly(bytes, room);
  };
  out.head[3 + block] = std::visit(pack, field.source);
}

/// Makes room for an array, and all of its head but the packed sizes. As VTK's zlib compressor lays it out: number of
/// blocks, their size, size of a shorter last block or 0, packed size of each; then the blocks.
void lay_out(const VtuField& field, VtuBytes& out) {
  const std::size_t bytes = field.size * size_of_number(field);
  const std::size_t blocks = (bytes + block_bytes - 1) / block_bytes;
  const std::size_t largest = std::min(bytes, block_bytes);
  out.room_per_block = field.constant ? tight_bound(largest) : quick_bound(largest);
  out.room.resize(blocks * out.room_per_block);
  out.head.assign(3 + blocks, 0);
  out.head[0] = blocks;
  out.head[1] = block_bytes;
  out.head[2] = bytes % block_bytes;
}

/// All arrays of a frame as they come in the file, behind the time.
std::vector<const VtuField*> arrays_of(const VtuFrame& frame) {
  std::vector<const VtuField*> all;
  for (const VtuField& field : frame.point_fields) all.push_back(&field);
  for (const VtuField& field : frame.cell_fields) all.push_back(&field);
  for (const VtuField* field : {&frame.places, &frame.corners, &frame.ends, &frame.kinds}) all.push_back(field);
  return all;
}

VtuField plain(const char* name, double value) {
  return {name, 1, 1, VtuSource<double>([=](std::size_t, std::span<double> out) { out[0] = value; })};
}

std::string tag(const VtuField& field, std::uint64_t offset) {
  const auto type = std::visit([](const auto& source) { return name_of_type(source); }, field.source);
  return fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)"
                     "\n",
                     type, escape_xml(field.name), field.components, offset);
}

/// What comes before the data. `offsets` tell where each array begins there, the time first.
std::string xml(const VtuFrame& frame, std::span<const std::uint64_t> offsets) {
  std::size_t array = 0;
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
      "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n<FieldData>\n";
  // Twice under the names that programs look for: TimeValue in ParaView and VTK, TIME in VisIt.
  for (const char* name : {"TimeValue", "TIME"}) {
    text += fmt::format(R"(<DataArray type="Float64" Name="{}" NumberOfTuples="1" format="appended" offset="{}"/>)"
                        "\n",
                        name, offsets[array]);
  }
  ++array;
  text += fmt::format("</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>\n", frame.points,
                      frame.cells);
  for (const VtuField& field : frame.point_fields) text += tag(field, offsets[array++]);
  text += "</PointData>\n<CellData>\n";
  for (const VtuField& field : frame.cell_fields) text += tag(field, offsets[array++]);
  text += "</CellData>\n<Points>\n";
  text += tag(frame.places, offsets[array++]);
  text += "</Points>\n<Cells>\n";
  for (const VtuField* field : {&frame.corners, &frame.ends, &frame.kinds}) text += tag(*field, offsets[array++]);
  return text + "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
}

/// The numbers of a vector, which must stay where it is.
template <class Number>
VtuField field_over(const std::string& name, int components, const std::vector<Number>& values) {
  return {name, components, values.size(), VtuSource<Number>([&values](std::size_t first, std::span<Number> out) {
            std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(first), out.size(), out.begin());
          })};
}

VtuField field_of(const VtuArray& array) {
  return std::visit([&](const auto& values) { return field_over(array.name, array.components, values); }, array.values);
}

VtuFrame frame_of(const VtuGrid& grid) {
  VtuFrame frame{.time = grid.time,
                 .points = grid.points.size(),
                 .cells = grid.kinds.size(),
                 .places = vectors<double>("Points", grid.points.size(), [&](std::size_t i) { return grid.points[i]; }),
                 .corners = field_over("connectivity", 1, grid.corners),
                 .ends = field_over("offsets", 1, grid.ends),
                 .kinds = field_over("types", 1, grid.kinds),
                 .point_fields = {},
                 .cell_fields = {}};
  for (const VtuArray& array : grid.point_fields) frame.point_fields.push_back(field_of(array));
  for (const VtuArray& array : grid.cell_fields) frame.cell_fields.push_back(field_of(array));
  return frame;
}

}  // namespace

std::size_t VtuBytes::size() const {
  return head.size() * sizeof(std::uint64_t) + std::accumulate(head.begin() + 3, head.end(), std::size_t{0});
}

void PackedVtu::for_each_piece(const std::function<void(std::string_view)>& f) const {
  f(xml_);
  for (const VtuBytes* array : arrays_) {
    f(bytes_of<std::uint64_t>(array->head));
    for (std::size_t block = 0; block < array->head[0]; ++block) {
      f({array->room.data() + block * array->room_per_block, array->head[3 + block]});
    }
  }
  f("\n</AppendedData>\n</VTKFile>\n");
}

std::size_t PackedVtu::size() const {
  std::size_t sum = 0;
  for_each_piece([&](std::string_view piece) { sum += piece.size(); });
  return sum;
}

std::size_t PackedVtu::memory() const {
  std::size_t sum = 0;
  for (const VtuBytes& array : own_) sum += array.room.size();
  return sum;
}

void VtuPacker::pack(const VtuFrame& frame, PackedVtu& out) {
  for (const VtuField& field : frame.point_fields) check_length(field, frame.points);
  for (const VtuField& field : frame.cell_fields) check_length(field, frame.cells);
  const VtuField time = plain("TimeValue", frame.time);
  std::vector<const VtuField*> arrays = arrays_of(frame);
  arrays.insert(arrays.begin(), &time);
  constants_.resize(arrays.size());
  out.own_.resize(arrays.size());
  out.arrays_.clear();

  struct Job {
    const VtuField* field;
    std::size_t block;
    VtuBytes* out;
  };
  std::vector<Job> jobs;
  for (std::size_t k = 0; k < arrays.size(); ++k) {
    VtuBytes& bytes = arrays[k]->constant ? constants_[k] : out.own_[k];
    out.arrays_.push_back(&bytes);
    if (arrays[k]->constant && !bytes.head.empty()) continue;  // packed for an earlier frame
    lay_out(*arrays[k], bytes);
    for (std::size_t block = 0; block < bytes.head[0]; ++block) jobs.push_back({arrays[k], block, &bytes});
  }
  for_each_(jobs.size(), [&](std::size_t k) { pack_block(*jobs[k].field, jobs[k].block, *jobs[k].out); });

  std::vector<std::uint64_t> offsets;
  std::uint64_t offset = 0;
  for (const VtuBytes* array : out.arrays_) {
    offsets.push_back(offset);
    offset += array->size();
  }
  out.xml_ = xml(frame, offsets);
}

void VtuPacker::pack(const VtuGrid& grid, PackedVtu& out) { pack(frame_of(grid), out); }

std::string to_vtu(const VtuGrid& grid) {
  std::string text;
  PackedVtu packed;
  VtuPacker packer;
  packer.pack(grid, packed);
  packed.for_each_piece([&](std::string_view piece) { text += piece; });
  return text;
}

void write_vtu(FileReplacement& file, const PackedVtu& frame) {
  std::vector<std::string_view> pieces;
  frame.for_each_piece([&](std::string_view piece) { pieces.push_back(piece); });
  file.write(pieces);
}

void write_vtu(const std::filesystem::path& path, const VtuFrame& frame) {
  PackedVtu packed;
  VtuPacker packer;
  packer.pack(frame, packed);
  FileReplacement file(path);
  write_vtu(file, packed);
  file.commit();
}

void write_vtu(const std::filesystem::path& path, const VtuGrid& grid) { write_vtu(path, frame_of(grid)); }

}  // namespace udar

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <new>

#include "udar/base/error.hpp"
#include "udar/results/file.hpp"
#include "udar/results/vtu.hpp"
#include "udar/results/xml.hpp"

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

/// Compresses blocks one after the other with one and the same memory: zlib takes and clears 260 KB for a start.
class Packer {
 public:
  Packer() {
    // Level 1: the higher ones cost the solver several times the time for a tenth of the size.
    if (::deflateInit(&stream_, 1) != Z_OK) throw std::bad_alloc();
    packed_.resize(::deflateBound(&stream_, block_bytes));
  }
  ~Packer() { ::deflateEnd(&stream_); }
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;

  /// `bytes` compressed, until the next call.
  std::string_view pack(std::string_view bytes) {
    ::deflateReset(&stream_);
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // which zlib only reads
    stream_.avail_in = static_cast<uInt>(bytes.size());
    stream_.next_out = packed_.data();
    stream_.avail_out = static_cast<uInt>(packed_.size());
    if (::deflate(&stream_, Z_FINISH) != Z_STREAM_END) throw std::bad_alloc();
    return {reinterpret_cast<const char*>(packed_.data()), packed_.size() - stream_.avail_out};
  }

 private:
  z_stream stream_{};
  std::vector<Bytef> packed_;
};

/// Where a file goes: to its end, or over bytes that are there.
struct Output {
  std::function<void(std::string_view)> append;
  std::function<void(std::size_t at, std::string_view)> overwrite;
};

void check_length(const VtuField& field, std::size_t count) {
  if (field.components >= 1 && field.size == count * static_cast<std::size_t>(field.components)) return;
  throw OutputError(fmt::format("cannot write field `{}`: it has {} values where {} x {} are needed", field.name,
                                field.size, count, field.components));
}

/// Writes a frame as it goes along. The XML comes first in the file and tells where each array begins behind it, which
/// is known when all are compressed: room is left for it, and filled at the end.
class Writer {
 public:
  Writer(const VtuFrame& frame, const Output& output)
      : frame_(frame), output_(output), time_(plain("TimeValue", frame.time)) {
    for (const VtuField& field : frame.point_fields) check_length(field, frame.points);
    for (const VtuField& field : frame.cell_fields) check_length(field, frame.cells);
  }

  void write() {
    offsets_.assign(5 + frame_.point_fields.size() + frame_.cell_fields.size(),
                    std::numeric_limits<std::uint64_t>::max());
    const std::size_t room = xml().size();
    append(xml() + data_begin_tag);
    data_begin_ = position_;
    offsets_.clear();
    append_array(time_);
    for (const VtuField& field : frame_.point_fields) append_array(field);
    for (const VtuField& field : frame_.cell_fields) append_array(field);
    for (const VtuField* field : {&frame_.places, &frame_.corners, &frame_.ends, &frame_.kinds}) append_array(*field);
    append("\n</AppendedData>\n</VTKFile>\n");
    std::string text = xml();
    text.resize(room, ' ');
    output_.overwrite(0, text);
  }

 private:
  static constexpr const char* data_begin_tag = "\n<AppendedData encoding=\"raw\">\n_";

  static VtuField plain(const char* name, double value) {
    return {name, 1, 1, VtuSource<double>([=](std::size_t, std::span<double> out) { out[0] = value; })};
  }

  void append(std::string_view bytes) {
    output_.append(bytes);
    position_ += bytes.size();
  }

  /// As VTK's zlib compressor lays it out: number of blocks, their size, size of a shorter last block or 0, compressed
  /// size of each; then the blocks.
  void append_array(const VtuField& field) {
    offsets_.push_back(position_ - data_begin_);
    std::visit([&](const auto& source) { append_numbers(field.size, source); }, field.source);
  }
  template <class Number>
  void append_numbers(std::size_t size, const VtuSource<Number>& source) {
    constexpr std::size_t per_block = block_bytes / sizeof(Number);
    const std::size_t blocks = (size + per_block - 1) / per_block;
    std::vector<std::uint64_t> head(3 + blocks);
    head[0] = blocks;
    head[1] = block_bytes;
    head[2] = size % per_block * sizeof(Number);
    const std::size_t head_at = position_;
    append(bytes_of<std::uint64_t>(head));
    std::vector<Number> numbers(per_block);
    for (std::size_t first = 0, block = 3; first < size; first += per_block, ++block) {
      const std::span<Number> piece(numbers.data(), std::min(per_block, size - first));
      source(first, piece);
      const std::string_view packed = packer_.pack(bytes_of<Number>(piece));
      head[block] = packed.size();
      append(packed);
    }
    output_.overwrite(head_at, bytes_of<std::uint64_t>(head));
  }

  [[nodiscard]] std::string xml() const {
    std::size_t array = 0;
    std::string text =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
        "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n<FieldData>\n";
    // Twice under the names that programs look for: TimeValue in ParaView and VTK, TIME in VisIt.
    for (const char* name : {"TimeValue", "TIME"}) {
      text += fmt::format(R"(<DataArray type="Float64" Name="{}" NumberOfTuples="1" format="appended" offset="{}"/>)"
                          "\n",
                          name, offsets_[array]);
    }
    ++array;
    text += fmt::format("</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>\n",
                        frame_.points, frame_.cells);
    for (const VtuField& field : frame_.point_fields) text += tag(field, offsets_[array++]);
    text += "</PointData>\n<CellData>\n";
    for (const VtuField& field : frame_.cell_fields) text += tag(field, offsets_[array++]);
    text += "</CellData>\n<Points>\n";
    text += tag(frame_.places, offsets_[array++]);
    text += "</Points>\n<Cells>\n";
    for (const VtuField* field : {&frame_.corners, &frame_.ends, &frame_.kinds}) text += tag(*field, offsets_[array++]);
    return text + "</Cells>\n</Piece>\n</UnstructuredGrid>";
  }
  static std::string tag(const VtuField& field, std::uint64_t offset) {
    const auto type = std::visit([](const auto& source) { return name_of_type(source); }, field.source);
    return fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)"
                       "\n",
                       type, escape_xml(field.name), field.components, offset);
  }

  const VtuFrame& frame_;
  const Output& output_;
  VtuField time_;
  Packer packer_;
  std::vector<std::uint64_t> offsets_;  ///< of the arrays in the data
  std::size_t position_ = 0;
  std::size_t data_begin_ = 0;
};

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

std::string to_vtu(const VtuGrid& grid) {
  std::string text;
  const Output output{[&](std::string_view bytes) { text += bytes; },
                      [&](std::size_t at, std::string_view bytes) { text.replace(at, bytes.size(), bytes); }};
  const VtuFrame frame = frame_of(grid);
  Writer(frame, output).write();
  return text;
}

void write_vtu(const std::filesystem::path& path, const VtuFrame& frame) {
  FileReplacement file(path);
  const Output output{[&](std::string_view bytes) { file.write(bytes); },
                      [&](std::size_t at, std::string_view bytes) { file.overwrite(at, bytes); }};
  Writer(frame, output).write();
  file.commit();
}

void write_vtu(const std::filesystem::path& path, const VtuGrid& grid) { write_vtu(path, frame_of(grid)); }

}  // namespace udar

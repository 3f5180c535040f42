#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "udar/base/vec2.hpp"

namespace udar {

class FileReplacement;

/// Numbers of one kind, as they lie in the file.
using VtuValues =
    std::variant<std::vector<double>, std::vector<float>, std::vector<std::int32_t>, std::vector<std::uint8_t>>;

/// A field: `components` numbers for each point or cell, one after another.
struct VtuArray {
  std::string name;
  int components = 1;
  VtuValues values;

  friend bool operator==(const VtuArray&, const VtuArray&) = default;
};

/// What a cell is, numbered as VTK does.
enum class VtuCell : std::uint8_t { line = 3, polyline = 4, triangle = 5, polygon = 7 };

/// One frame: an unstructured grid in the plane with fields on its points and cells.
struct VtuGrid {
  double time = 0;                    ///< s
  std::vector<Vec2> points;           ///< m
  std::vector<std::int32_t> corners;  ///< point numbers of all cells, one cell after another
  std::vector<std::int32_t> ends;     ///< for each cell: one past its last place in `corners`
  std::vector<std::uint8_t> kinds;    ///< for each cell: a VtuCell
  std::vector<VtuArray> point_fields;
  std::vector<VtuArray> cell_fields;

  /// Adds a cell over `points_of_cell`.
  void add_cell(VtuCell kind, std::span<const std::int32_t> points_of_cell);
  /// Adds a closed polygon with its own points: an obstacle.
  void add_polygon(std::span<const Vec2> outline);

  friend bool operator==(const VtuGrid&, const VtuGrid&) = default;
};

/// Fills `out` with numbers of an array from the `first` one on; both are whole vectors of up to three components.
template <class Number>
using VtuSource = std::function<void(std::size_t first, std::span<Number> out)>;

/// A field whose numbers are asked for while it is packed, a few thousand at a time: nothing of its size is held but
/// what it packs to.
struct VtuField {
  std::string name;
  int components = 1;
  std::size_t size = 0;  ///< numbers, of all components
  std::variant<VtuSource<double>, VtuSource<float>, VtuSource<std::int32_t>, VtuSource<std::uint8_t>> source;
  bool constant = false;  ///< the same in all frames that a VtuPacker packs
};

/// One frame, to be packed piece by piece. The arrays that VtuGrid has as vectors are fields here.
struct VtuFrame {
  double time = 0;  ///< s
  std::size_t points = 0;
  std::size_t cells = 0;
  VtuField places;   ///< m, three components
  VtuField corners;  ///< point numbers of all cells, one cell after another
  VtuField ends;
  VtuField kinds;
  std::vector<VtuField> point_fields;
  std::vector<VtuField> cell_fields;
};

/// The nearest of 32 bits; a number beyond them becomes the largest.
inline float as_float(double value) {
  constexpr double largest = std::numeric_limits<float>::max();
  const double not_below = value < -largest ? -largest : value;
  return static_cast<float>(not_below > largest ? largest : not_below);
}

/// A field with the vector value(i) for i from 0 to `count` - 1; z = 0 since VTK knows only three components.
template <class Number, class Value>
VtuField vectors(std::string name, std::size_t count, Value value) {
  const auto convert = [](double x) {
    if constexpr (std::is_same_v<Number, float>) {
      return as_float(x);
    } else {
      return x;
    }
  };
  return {std::move(name), 3, 3 * count, VtuSource<Number>([=](std::size_t first, std::span<Number> out) {
            for (std::size_t k = 0; k < out.size(); k += 3) {
              const Vec2 v = value((first + k) / 3);
              out[k] = convert(v.x);
              out[k + 1] = convert(v.y);
              out[k + 2] = 0;
            }
          })};
}

/// A grid of triangles.
VtuGrid triangle_grid(double time, std::vector<Vec2> points, std::span<const std::array<std::int32_t, 3>> triangles);

/// "velocity", "m/s" -> "velocity_m_per_s": letters, digits and `_` only, so that ParaView's calculator takes it.
std::string field_name(std::string_view quantity, std::string_view unit);

/// A field of numbers for pictures: 32 bits each.
VtuArray scalar_field(std::string_view quantity, std::string_view unit, std::span<const double> values);
/// A field of vectors, with z = 0 since VTK knows only three components.
VtuArray vector_field(std::string_view quantity, std::string_view unit, std::span<const Vec2> values);
/// Whole numbers: body, original node or element number.
VtuArray number_field(std::string_view name, std::span<const std::int32_t> values);
/// Yes or no, as 1 or 0.
VtuArray flag_field(std::string_view name, std::span<const std::uint8_t> values);

/// An array as it lies in a file: its head, then its blocks, each packed by itself into a place of its own.
struct VtuBytes {
  std::vector<std::uint64_t> head;  ///< number of blocks, their size, size of a shorter last one, packed sizes
  std::size_t room_per_block = 0;
  std::vector<char> room;

  [[nodiscard]] std::size_t size() const;  ///< in the file
};

/// A frame as it lies in a file. The next one may be packed into the same memory. Uses what its packer holds.
class PackedVtu {
 public:
  PackedVtu() = default;
  PackedVtu(const PackedVtu&) = delete;
  PackedVtu& operator=(const PackedVtu&) = delete;

  /// Calls f with one piece of the file after another.
  void for_each_piece(const std::function<void(std::string_view)>& f) const;
  [[nodiscard]] std::size_t size() const;    ///< bytes of the file
  [[nodiscard]] std::size_t memory() const;  ///< bytes that are held, whatever is in them

 private:
  friend class VtuPacker;
  std::string xml_;
  std::vector<const VtuBytes*> arrays_;
  std::vector<VtuBytes> own_;  ///< of the arrays that change
};

/// Packs frames with the same fields, one after another: what never changes is packed once, and tightly; the rest in a
/// hurry (zlib_stream.hpp), since the solver waits for it.
class VtuPacker {
 public:
  /// Calls job(0), job(1), ... job(jobs - 1), each once, in any order and at the same time as it can.
  using ForEach = std::function<void(std::size_t jobs, const std::function<void(std::size_t)>& job)>;

  VtuPacker()
      : VtuPacker([](std::size_t jobs, const std::function<void(std::size_t)>& job) {
          for (std::size_t k = 0; k < jobs; ++k) job(k);
        }) {}
  explicit VtuPacker(ForEach for_each) : for_each_(std::move(for_each)) {}
  VtuPacker(const VtuPacker&) = delete;
  VtuPacker& operator=(const VtuPacker&) = delete;

  /// Packs into `out`, whose earlier frame is lost. Throws OutputError for a field whose length does not fit.
  void pack(const VtuFrame& frame, PackedVtu& out);
  void pack(const VtuGrid& grid, PackedVtu& out);

 private:
  ForEach for_each_;
  std::vector<VtuBytes> constants_;
};

/// Writes `grid` as VTU (appended raw data, zlib blocks) all or nothing; ParaView and VTK read it. Throws OutputError,
/// also for a field whose length does not fit.
void write_vtu(const std::filesystem::path& path, const VtuGrid& grid);
void write_vtu(const std::filesystem::path& path, const VtuFrame& frame);
/// Writes a packed frame; `commit` is left to the caller.
void write_vtu(FileReplacement& file, const PackedVtu& frame);
std::string to_vtu(const VtuGrid& grid);

/// Reads what `write_vtu` wrote; other programs' VTU only as far as they write the same way. Every count and number is
/// checked against the bytes there are before memory is taken. Throws OutputError.
VtuGrid read_vtu(const std::filesystem::path& path);
VtuGrid parse_vtu(std::string_view bytes);

/// What of a frame is wanted beside its time; nothing else is read.
struct VtuPart {
  std::vector<std::string> fields;  ///< names, on points or cells; those that are not there are passed over
  bool places = true;               ///< the points
  bool cells = false;               ///< corners, ends and kinds; with the points only
};

VtuGrid read_vtu(const std::filesystem::path& path, const VtuPart& part);
/// Names of the fields that a frame has, on points first. Throws OutputError.
std::vector<std::string> vtu_fields(const std::filesystem::path& path);

}  // namespace udar

#include "udar/results/checkpoint_file.hpp"

#include <fmt/core.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cstring>

#include "udar/base/error.hpp"

namespace udar {
namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are written as little-endian");

constexpr std::string_view first_words = "udar checkpoint ";
constexpr std::string_view first_line = "udar checkpoint 1\n";
constexpr std::string_view end_name = "end";
constexpr std::size_t longest_name = 64;

/// What comes before a part.
struct Head {
  std::uint32_t name_length = 0;
  std::uint32_t checksum = 0;
  std::uint64_t length = 0;
};
static_assert(sizeof(Head) == 16);

/// Of everything but the checksum itself.
std::uint32_t checksum_of(std::string_view name, std::string_view bytes) {
  const std::array<std::uint64_t, 2> lengths{name.size(), bytes.size()};
  uLong sum = ::crc32_z(0, nullptr, 0);
  for (const std::string_view piece :
       {std::string_view(reinterpret_cast<const char*>(lengths.data()), sizeof lengths), name, bytes}) {
    if (piece.empty()) continue;  // zlib takes no bytes for a new beginning
    sum = ::crc32_z(sum, reinterpret_cast<const Bytef*>(piece.data()), piece.size());
  }
  return static_cast<std::uint32_t>(sum);
}

std::string_view cut(std::string_view& rest, std::uint64_t count) {
  if (count > rest.size()) throw OutputError("it was cut off");
  const std::string_view piece = rest.substr(0, count);
  rest.remove_prefix(count);
  return piece;
}

}  // namespace

CheckpointWriter::CheckpointWriter(const std::filesystem::path& path) : file_(path) { file_.write(first_line); }

void CheckpointWriter::add(std::string_view name, std::string_view bytes) {
  const Head head{static_cast<std::uint32_t>(name.size()), checksum_of(name, bytes), bytes.size()};
  const std::array<std::string_view, 3> pieces{{{reinterpret_cast<const char*>(&head), sizeof head}, name, bytes}};
  file_.write(pieces);
  ++parts_;
}

void CheckpointWriter::commit() {
  const std::uint64_t count = parts_;
  add(end_name, {reinterpret_cast<const char*>(&count), sizeof count});
  file_.commit();
}

CheckpointFile::CheckpointFile(std::string bytes) : bytes_(std::make_unique<const std::string>(std::move(bytes))) {
  std::string_view rest = *bytes_;
  if (!rest.starts_with(first_words)) throw OutputError("it is not a checkpoint");
  if (!rest.starts_with(first_line)) throw OutputError("it is of another version of Udar");
  rest.remove_prefix(first_line.size());
  for (;;) {
    Head head;
    std::memcpy(&head, cut(rest, sizeof head).data(), sizeof head);
    if (head.name_length > longest_name) throw OutputError("it is damaged");
    const std::string_view name = cut(rest, head.name_length);
    const std::string_view content = cut(rest, head.length);
    if (checksum_of(name, content) != head.checksum) throw OutputError("it is damaged: a checksum is wrong");
    if (name == end_name) {
      std::uint64_t count = 0;
      if (content.size() == sizeof count) std::memcpy(&count, content.data(), sizeof count);
      if (count != parts_.size() || !rest.empty()) throw OutputError("it is damaged: parts are missing");
      return;
    }
    if (!parts_.emplace(name, content).second) throw OutputError("it is damaged: a part is there twice");
  }
}

void CheckpointFile::clear() {
  parts_.clear();
  bytes_.reset();
}

std::string_view CheckpointFile::part(std::string_view name) const {
  const auto found = parts_.find(name);
  if (found == parts_.end()) throw OutputError(fmt::format("its part `{}` is missing", name));
  return found->second;
}

}  // namespace udar

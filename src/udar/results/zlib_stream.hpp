#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace udar {

/// Room that `pack_quickly` may need for so many bytes.
constexpr std::size_t quick_bound(std::size_t bytes) { return bytes + 5 * (bytes / 65535) + 64; }

/// Packs `bytes` as a zlib stream (RFC 1950 and 1951), which everyone reads, and returns its length. Made for the
/// numbers of a frame, whose low bits hardly compress: repeats of 32 bytes and more that begin on a number become
/// references, all else is copied. It costs less than the copy to the disk does, where zlib's level 1 costs twenty
/// times as much; zeros, what is at rest and mirror images shrink, most else does not. `out` has room for
/// `quick_bound`.
std::size_t pack_quickly(std::string_view bytes, std::span<char> out);

/// Packs `bytes` as small as pays for what is packed once and written often. `out` has room for `tight_bound`.
std::size_t pack_tightly(std::string_view bytes, std::span<char> out);
std::size_t tight_bound(std::size_t bytes);

/// The checksum of zlib streams (RFC 1950), computed for many bytes at once.
std::uint32_t adler32_of(std::string_view bytes);

}  // namespace udar

// The last bytes of a pack, which say where its scene and its table are.
#pragma once

#include <cstdint>

#include "packs/format/bytes.h"

namespace delray::packs::internal {

struct Section {
  std::uint64_t offset = 0, bytes = 0;
  std::uint64_t checksum = 0;  // XXH3-64
};
struct Trailer {
  Section scene, table;
};
inline constexpr std::size_t kHeaderBytes = 16, kTrailerBytes = 2 * 24 + 8 + 8;

// Followed by their checksum and the magic bytes.
void write_trailer(const Trailer& trailer, ByteWriter& to);
// Throws FileError (input) where the sections do not lie, one behind the other, between header and
// trailer of a file of so many bytes. REQUIRES: kTrailerBytes bytes.
Trailer read_trailer(ByteReader from, std::span<const char> bytes, std::uint64_t file_bytes);

}  // namespace delray::packs::internal

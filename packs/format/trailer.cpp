// A file that was cut short has other bytes where its trailer should be.
#include "packs/format/trailer.h"

#include <xxhash.h>

#include <algorithm>
#include <iterator>

#include "packs/pack_writer.h"

namespace delray::packs::internal {
namespace {

constexpr std::size_t kSectionsBytes = 2 * sizeof(Section);

}  // namespace

void write_trailer(const Trailer& trailer, ByteWriter& to) {
  ByteWriter sections;
  sections.value(trailer.scene);
  sections.value(trailer.table);
  const std::vector<char>& bytes = sections.bytes();
  to.raw(bytes.data(), bytes.size());
  to.value(static_cast<std::uint64_t>(XXH3_64bits(bytes.data(), bytes.size())));
  to.raw(kMagic, sizeof kMagic);
}

Trailer read_trailer(ByteReader from, std::span<const char> bytes, std::uint64_t file_bytes) {
  Trailer trailer;
  std::uint64_t checksum = 0;
  from.value(trailer.scene);
  from.value(trailer.table);
  from.value(checksum);
  const std::span<const char> magic = from.take(sizeof kMagic);
  if (!std::equal(magic.begin(), magic.end(), std::begin(kMagic)))
    from.fail("the pack is cut short: its end is missing");
  if (checksum != XXH3_64bits(bytes.data(), kSectionsBytes))
    from.fail("the pack is damaged: its end has another checksum");
  std::uint64_t at = trailer.scene.offset;
  if (at < kHeaderBytes) from.fail("its scene is not behind its beginning");
  for (const Section* section : {&trailer.scene, &trailer.table}) {
    if (section->offset != at || at > file_bytes || section->bytes > file_bytes - at)
      from.fail("its parts do not follow each other: the pack is cut short or damaged");
    at += section->bytes;
  }
  if (at != file_bytes - kTrailerBytes) from.fail("its parts do not fill the file");
  return trailer;
}

}  // namespace delray::packs::internal

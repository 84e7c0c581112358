// The bytes of a page with their checksum, counts and bounds.
#include "packs/build/encoded_page.h"

#include <xxhash.h>

#include "packs/build/cut_pages.h"
#include "packs/format/page_bytes.h"

namespace delray::packs::internal {

EncodedPage encode_page(const Page& page, PageRow row) {
  EncodedPage result{row, encode(page)};
  PageRow& made = result.row;
  made.checksum = XXH3_64bits(result.bytes.data(), result.bytes.size());
  made.bytes = static_cast<std::uint32_t>(result.bytes.size());
  made.triangles = static_cast<std::uint16_t>(page.mesh.triangles.size());
  made.vertices = static_cast<std::uint16_t>(page.mesh.positions.size());
  made.references = static_cast<std::uint16_t>(page.vertices.size());
  made.clusters = static_cast<std::uint8_t>(page.clusters.size());
  made.box = box_of(page);
  made.cone = cone_of(page);
  return result;
}

}  // namespace delray::packs::internal

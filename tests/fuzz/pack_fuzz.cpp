// The first byte chooses what is read: a table, a scene, or a page, whose counts come next.
// Checksums and the file around them are looked at before, and by tests.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "files/error.h"
#include "packs/format/page_bytes.h"
#include "packs/format/scene_bytes.h"
#include "packs/format/trailer.h"

namespace {

using namespace delray::packs;

void read_page(std::span<const char> bytes) {
  constexpr std::size_t kCounts = 4 * 2 + 1;
  if (bytes.size() < kCounts) return;
  PageRow row;
  std::memcpy(&row.triangles, bytes.data(), 2);
  std::memcpy(&row.vertices, bytes.data() + 2, 2);
  std::memcpy(&row.references, bytes.data() + 4, 2);
  row.clusters = static_cast<std::uint8_t>(bytes[6] & 7);
  row.box = {glm::vec3(-1), glm::vec3(1)};
  MeshRow mesh;
  const auto flags = static_cast<std::uint8_t>(bytes[7]);
  mesh.attributes = {(flags & 1) != 0, (flags & 2) != 0, (flags & 4) != 0, (flags & 8) != 0,
                     (flags & 16) != 0};
  static thread_local Page page;  // whose memory is used again
  internal::decode(bytes.subspan(kCounts), row, mesh, "fuzz", "page", page);
  for (const glm::uvec3& t : page.mesh.triangles) {
    for (int k = 0; k < 3; ++k)
      if (t[k] >= page.mesh.positions.size()) __builtin_trap();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span<const char> bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  internal::ByteReader from(bytes, "fuzz", "");
  const delray::files::MemoryBudget memory(std::uint64_t{1} << 30);
  try {
    if (data[0] % 4 == 0) {
      internal::Table table;
      internal::read_table(from, 1 << 20, table);
    } else if (data[0] % 4 == 1) {
      delray::scenes::Scene scene;
      internal::read_scene(from, 3, memory, "fuzz", scene);
    } else if (data[0] % 4 == 2) {
      read_page(bytes);
    } else if (bytes.size() == internal::kTrailerBytes) {
      internal::read_trailer(from, bytes, 1 << 20);
    }
  } catch (const delray::files::FileError&) {
  }
  return 0;
}

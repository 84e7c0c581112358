#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "comm/bad_message.h"
#include "raytrace/distributed/pack_messages.h"

// Whatever the bytes, as many rays come out as the header says, or tiles that there are, or the
// message is refused.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace delray;
  const comm::Buffer message = comm::Buffer::of(std::as_bytes(std::span(data, size)));
  try {
    const raytrace::MessageHeader header = raytrace::header_of(message);
    if (header.kind == raytrace::MessageKind::tiles) {
      constexpr std::uint32_t kAll = 1000;
      for (const std::uint32_t tile : raytrace::unpack_tiles(message, kAll))
        if (tile >= kAll) std::abort();
      return 0;
    }
    const raytrace::RayQueue found = raytrace::unpack_rays(message, header);
    if (found.rays.size() != header.rays || found.shadows.size() != header.shadows) std::abort();
    const comm::Buffer again = raytrace::pack(header.kind, found.rays, found.shadows);
    if (again.size() != message.size()) std::abort();
  } catch (const comm::BadMessage&) {
  }
  return 0;
}

// Hashes the pixels in memory order as one piece; depth is not part of them.
#include "image/hash.h"

#include <fmt/format.h>
#include <xxhash.h>

namespace delray::image {

std::string hash(const Image8& image) {
  const XXH128_hash_t value = XXH3_128bits(image.colour.data(), image.pixels() * sizeof(Rgba8));
  return fmt::format("{:016x}{:016x}", value.high64, value.low64);
}

}  // namespace delray::image

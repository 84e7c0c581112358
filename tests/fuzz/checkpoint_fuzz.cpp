#include "raytrace/checkpoint.h"

#include <xxhash.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "files/error.h"

// The bytes are what stands between the magic and the checksum, which is made right: nobody
// who wants to do harm would leave it wrong.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace delray;
  raytrace::Rendering rendering;
  rendering.scene = std::string(32, 'a');
  rendering.window = {0, 0, 20, 17};
  rendering.samples = 40;
  rendering.any_samples = true;
  std::string content = "delray film 2\n" + std::string(reinterpret_cast<const char*>(data), size);
  const XXH128_hash_t checksum = XXH3_128bits(content.data(), content.size());
  content.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  try {
    const raytrace::Film film = raytrace::parse_checkpoint(content, "fuzz", rendering);
    raytrace::mean(film);
    raytrace::noise(film);
    raytrace::unfinished(film, 40, 0.01F);
  } catch (const files::FileError&) {
  }
  return 0;
}

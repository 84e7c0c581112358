#include "raytrace/checkpoint.h"

#include <xxhash.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "files/error.h"

// The bytes are what stands between the fingerprint and the checksum, which is made right: nobody
// who wants to do harm would leave it wrong.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace delray;
  const std::string mark(32, 'a');
  std::string content =
      "delray film 1\n" + mark + std::string(reinterpret_cast<const char*>(data), size);
  const XXH128_hash_t checksum = XXH3_128bits(content.data(), content.size());
  content.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  try {
    const raytrace::Film film =
        raytrace::parse_checkpoint(content, "fuzz", {mark, {0, 0, 20, 17}, 40});
    raytrace::mean(film);
    raytrace::noise(film);
    raytrace::unfinished(film, 40, 0.01F);
  } catch (const files::FileError&) {
  }
  return 0;
}

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "files/error.h"
#include "image/io.h"

// Larger pictures are refused before they are decoded: OpenImageIO's readers take their time.
constexpr std::size_t kMostBytes = std::size_t{1} << 16;

// Whatever the bytes, a picture has as many texels as its header says, or is refused.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace delray;
  if (size > kMostBytes) return 0;
  try {
    const image::Texels picture =
        image::decode_image8(std::as_bytes(std::span(data, size)), "fuzz");
    if (picture.width < 1 || picture.height < 1) std::abort();
    if (picture.texels.size() !=
        static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height)) {
      std::abort();
    }
  } catch (const files::FileError&) {
  }
  return 0;
}

#include "scenes/files/read_mtl.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "files/error.h"

// Whatever the bytes, materials are finite and name textures that are there.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace delray::scenes;
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> warnings;
  std::vector<Texture> textures;
  const internal::Source source{"/nowhere/fuzz.mtl", content, warnings};
  internal::TextureFiles files(source, textures);
  try {
    for (const Material& m : internal::read_mtl(content, files)) {
      for (const float value :
           {m.base_colour.x, m.base_colour.y, m.base_colour.z, m.base_colour.w, m.emission.x,
            m.emission.y, m.emission.z, m.roughness, m.metallic, m.ior, m.transmission}) {
        if (!std::isfinite(value)) std::abort();
      }
      for (const std::uint32_t texture : {m.base_colour_texture, m.emission_texture}) {
        if (texture != kNone && texture >= textures.size()) std::abort();
      }
    }
  } catch (const delray::files::FileError&) {
  }
  return 0;
}

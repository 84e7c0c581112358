#include "scenes/internal/texture_files.h"

#include <algorithm>

#include "image/io.h"

namespace delray::scenes::internal {

template <class Decode>
std::uint32_t TextureFiles::add(const std::string& name, const TextureUse& use, Decode&& decode) {
  const auto [entry, is_new] = numbers_.try_emplace({name, use}, kNone);
  if (!is_new) return entry->second;
  try {
    image::Texels texels = decode();
    entry->second = static_cast<std::uint32_t>(textures_.size());
    textures_.push_back({name, texels.width, texels.height, std::move(texels.texels), use.srgb,
                         use.wrap_u, use.wrap_v});
  } catch (const files::FileError& e) {
    source_.warn("texture left out: " + std::string(e.what()));
  }
  return entry->second;
}

std::uint32_t TextureFiles::from_file(const std::string& name, const TextureUse& use) {
  return add(name, use, [&] {
    std::string portable = name;
    std::replace(portable.begin(), portable.end(), '\\', '/');
    return image::read_texels(source_.path.parent_path() / portable);
  });
}

std::uint32_t TextureFiles::from_memory(const std::string& name, std::span<const std::byte> bytes,
                                        const TextureUse& use) {
  return add(name, use, [&] { return image::decode_image8(bytes, name); });
}

}  // namespace delray::scenes::internal

// Remembers textures by name, and by a hash of their bytes, so that a picture under several names
// is decoded once. A texture that cannot be read becomes a warning, unless there was no memory for
// it.
#include "scenes/files/texture_files.h"

#include <xxhash.h>

#include "files/read_file.h"
#include "image/io.h"

namespace delray::scenes::internal {
namespace {

TextureFiles::Digest digest_of(std::span<const std::byte> bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.high64, hash.low64, bytes.size()};
}

}  // namespace

template <class Read>
std::uint32_t TextureFiles::add(const std::string& name, const TextureUse& use, Read&& read) {
  const auto [entry, is_new] = numbers_.try_emplace({name, use}, kNone);
  if (!is_new) return entry->second;
  try {
    entry->second = read();
  } catch (const files::FileError& e) {
    if (e.cause() == files::Cause::memory) throw;
    source_.warn("texture left out: " + std::string(e.what()));
  }
  return entry->second;
}

template <class Decode>
std::uint32_t TextureFiles::add_picture(const std::string& name, const TextureUse& use,
                                        const Digest& digest, Decode&& decode) {
  if (const auto known = pictures_.find({digest, use}); known != pictures_.end()) {
    return known->second;
  }
  image::Texels texels = decode();
  const auto number = static_cast<std::uint32_t>(textures_.size());
  textures_.push_back({name, texels.width, texels.height, std::move(texels.texels), use.srgb,
                       use.wrap_u, use.wrap_v, use.set});
  pictures_.emplace(std::pair(digest, use), number);
  return number;
}

std::uint32_t TextureFiles::from_file(const std::string& name, const TextureUse& use) {
  return add(name, use, [&] {
    const std::filesystem::path path = source_.resolve(name);
    const Digest digest = [&] {
      const std::string bytes = files::read_file(path, source_.memory);
      return digest_of(std::as_bytes(std::span(bytes)));
    }();
    return add_picture(name, use, digest, [&] { return image::read_texels(path, source_.memory); });
  });
}

std::uint32_t TextureFiles::from_memory(const std::string& name, std::span<const std::byte> bytes,
                                        const TextureUse& use) {
  return add(name, use, [&] {
    return add_picture(name, use, digest_of(bytes),
                       [&] { return image::decode_image8(bytes, name, source_.memory); });
  });
}

}  // namespace delray::scenes::internal

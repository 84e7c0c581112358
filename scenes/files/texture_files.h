// The textures of a scene file, equal ones read once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenes/files/source.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// The use of a texture; one picture used in two ways becomes two textures.
struct TextureUse {
  bool srgb = true;
  Texture::Wrap wrap_u = Texture::Wrap::repeat, wrap_v = Texture::Wrap::repeat;
  std::uint8_t set = 0;
  auto operator<=>(const TextureUse&) const = default;
};

class TextureFiles {
 public:
  TextureFiles(const Source& source, std::vector<Texture>& textures)
      : source_(source), textures_(textures) {}

  // The number of the texture in a file (relative to the scene's folder, with / or \ between
  // names), or kNone, with a warning, if it is missing, damaged or outside of that folder. Throws
  // FileError (memory) only. Files with the same bytes are one texture, that of the first name.
  std::uint32_t from_file(const std::string& name, const TextureUse& use);
  // Adds an encoded picture in memory. `name` tells pictures apart.
  std::uint32_t from_memory(const std::string& name, std::span<const std::byte> bytes,
                            const TextureUse& use);

  // A file that the scene names, though it may not be read.
  void note_named(const std::string& name) const { source_.note_named(name); }

  using Digest = std::array<std::uint64_t, 3>;  // of the bytes of a file

 private:
  template <class Read>
  std::uint32_t add(const std::string& name, const TextureUse& use, Read&& read);
  template <class Decode>
  std::uint32_t add_picture(const std::string& name, const TextureUse& use, const Digest& digest,
                            Decode&& decode);

  const Source& source_;
  std::vector<Texture>& textures_;
  std::map<std::pair<std::string, TextureUse>, std::uint32_t> numbers_;
  std::map<std::pair<Digest, TextureUse>, std::uint32_t> pictures_;
};

}  // namespace delray::scenes::internal

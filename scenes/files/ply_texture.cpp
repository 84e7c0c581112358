// Comments "TextureFile NAME", as MeshLab writes them.
#include "scenes/files/ply_texture.h"

#include <string>

#include "scenes/files/texture_files.h"

namespace delray::scenes::internal {

void add_ply_texture(const Source& source, const PlyHeader& header, Scene& scene) {
  if (header.textures.empty()) return;
  if (header.textures.size() > 1) source.warn("of its textures only the first is read");
  TextureFiles textures(source, scene.textures);
  const std::uint32_t texture =
      textures.from_file(std::string(header.textures[0]), TextureUse{true});
  scene.materials[0].base_colour_texture = texture;
  if (texture != kNone) scene.materials[0].base_colour = glm::vec4(1);
}

}  // namespace delray::scenes::internal

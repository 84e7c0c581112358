// Materials of glTF.
#pragma once

#include <glm/glm.hpp>
#include <string_view>
#include <vector>

#include "scenes/files/texture_files.h"
#include "scenes/gltf/gltf_document.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// Which texture coordinates a texture uses, and how: uv = transform * (u, v, 1).
struct UvUse {
  std::uint64_t set = 0;  // TEXCOORD_<set>
  glm::dmat3x2 transform{1.0};
  bool operator==(const UvUse&) const = default;
};

struct GltfMaterial {
  Material material;
  std::vector<UvUse> uvs;  // what Mesh::uvs are made by, and uvs2: at most two
  bool lacks_uvs = false;  // a mesh was found that does not have them
};

// Whether an extension is one of materials that is read.
bool is_material_extension(std::string_view name);

// All materials in the order of the file. Textures of one material may use two different
// coordinates, of different sets or transformed differently; set 0 are those of its first texture
// (in the order of Material::textures). What uses others uses those, with a warning. What other
// extensions say of a material is left out with a warning.
std::vector<GltfMaterial> read_materials(const GltfDocument& document, TextureFiles& textures);

}  // namespace delray::scenes::internal

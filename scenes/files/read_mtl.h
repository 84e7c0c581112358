// Materials of OBJ files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/files/texture_files.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// The materials of an MTL file: Kd, Ks and Ns, Ke, d or Tr, Ni, Pm and Pr and their maps, as
// metallic-roughness materials. Kd is taken as sRGB, as programs that made MTL files showed it; a
// Phong exponent n becomes the roughness of equal width, alpha^2 = 2 / (n + 2) (Walter et al. 2007)
// with alpha = roughness^2. What is no number is passed over.
std::vector<Material> read_mtl(std::string_view content, TextureFiles& textures);

}  // namespace delray::scenes::internal

// Materials of formats older than metallic-roughness.
#pragma once

#include "scenes/internal/texture_files.h"
#include "scenes/scene.h"

struct aiMaterial;

namespace delray::scenes::internal {

// Kd, Ks and Ns, Ke, d or Tr, Ni, Pm and Pr and their maps, as a metallic-roughness material. Kd is
// taken as sRGB, as programs that made MTL files showed it; a Phong exponent n becomes the
// roughness of equal width, alpha^2 = 2 / (n + 2) (Walter et al. 2007) with alpha = roughness^2.
Material mtl_material(const aiMaterial& from, TextureFiles& textures);

}  // namespace delray::scenes::internal

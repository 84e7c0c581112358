// Materials as JSON of glTF, for writing.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "scenes/gltf/gltf_extras.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

inline Json json_of(const glm::vec3& v) { return {v.x, v.y, v.z}; }
inline Json json_of(const glm::vec4& v) { return {v.x, v.y, v.z, v.w}; }

// The least power of two that is not less: dividing by it keeps all bits of a colour.
inline float power_of_two_above(float x) { return std::exp2(std::ceil(std::log2(x))); }

// Names an extension in the document once, in the order of first use.
void use_extension(const char* name, Json& document);

// A material of the scene, whose extensions are named in the document.
Json write_material(const Material& material, const Scene& scene, Json& document);

}  // namespace delray::scenes::internal

// glTF 2.0 (Khronos Group 2021), as JSON with files beside it or as one binary file.
#pragma once

#include "scenes/files/source.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// Meshes, nodes, materials, textures, punctual lights and perspective cameras of the default scene,
// with the extensions KHR_materials_clearcoat, _emissive_strength, _ior, _sheen, _specular,
// _transmission, _unlit, _volume and _pbrSpecularGlossiness (its reflections left out),
// KHR_lights_punctual, KHR_texture_transform, KHR_mesh_quantization and KHR_draco_mesh_compression.
// Animations of nodes and of weights, skins and morph targets; the scene is at rest. Every number
// of the file is checked before it is used.
Scene load_gltf(const Source& source);

}  // namespace delray::scenes::internal

// Scenes to binary glTF 2.0.
#pragma once

#include <filesystem>

#include "scenes/scene.h"

namespace delray::scenes {

// Writes meshes, instances (as nodes; each mesh once), materials (with KHR_materials_transmission,
// _ior), textures (PNG), punctual lights (KHR_lights_punctual), cameras, and how instances move and
// meshes bend; lights and cameras stay where they are. Scene::origin becomes a node above all
// others. Whole or not at all; throws files::FileError.
void write_glb(const std::filesystem::path& path, const Scene& scene);

}  // namespace delray::scenes

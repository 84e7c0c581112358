// Scenes from files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "parallel/progress.h"
#include "scenes/scene.h"

namespace delray::scenes {

// Loads OBJ+MTL, PLY, STL, glTF/GLB or OFF. Bad geometry (indices out of range, NaN or infinite
// vertices, degenerate triangles) never reaches the scene: an index or coordinate that is wrong is
// bad input (files::FileError); triangles with two equal vertex indices are dropped and told in
// `warnings`.
Scene load(const std::filesystem::path& path, std::vector<std::string>& warnings,
           parallel::Progress* progress = nullptr);

}  // namespace delray::scenes

// A part of a scene, as ranks have it that share one out.
#pragma once

#include <cstdint>

#include "scenes/scene.h"

namespace delray::scenes {

// A run of the triangles of a whole scene, in their order there, with vertices of its own and all
// that is no geometry.
struct ScenePart {
  Scene scene;                                // one mesh, placed once
  std::uint32_t first_triangle = 0;           // of the whole mesh
  std::uint64_t triangles = 0, vertices = 0;  // of the whole scene
};

}  // namespace delray::scenes

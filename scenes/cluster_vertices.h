// Scenes that look alike from afar, with fewer triangles.
#pragma once

#include <cstddef>
#include <optional>

#include "scenes/scene.h"

namespace delray::scenes {

// The scene by vertex clustering (Rossignac and Borrel 1993): where it was, with its cameras and
// lights, with colours of vertices in place of textures, without animations. Its meshes have no
// more than `most` triangles, and those of points and segments no more than `most` each, evenly
// over their order. Nothing where nothing is left to see.
//
// Only what is left takes memory, and a few passes over the triangles time: O(triangles), parallel.
// The same for every number of threads. Corners of triangles are vertices; all else may be as files
// have it.
std::optional<Scene> cluster_vertices(const Scene& scene, std::size_t most);

}  // namespace delray::scenes

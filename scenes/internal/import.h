// Scenes through Assimp.
#pragma once

#include "scenes/internal/source.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// What a format means where Assimp does not say.
struct ImportRules {
  const char* suffix;         // by which Assimp knows the format, without the dot
  bool keep_normals = true;   // STL has those of its facets only
  bool keep_vertices = true;  // false: vertices are repeated for every face; equal ones are joined
};

// Reads a file that its check has passed. Triangles keep the order they have in the file within a
// material; polygons are cut into triangles.
Scene import(const Source& source, const ImportRules& rules);

}  // namespace delray::scenes::internal

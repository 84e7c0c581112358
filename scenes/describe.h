// A description of a scene: counts, names and bounds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/box.h"
#include "scenes/scene.h"

namespace delray::scenes {

// Size and kind of a texture.
struct TextureDescription {
  std::string name;
  int width = 0, height = 0;
  bool srgb = true;
};

// The contents of a scene: counts, names and bounds.
struct Description {
  std::uint64_t meshes = 0, instances = 0;
  std::uint64_t triangles = 0, vertices = 0;                // of all instances
  std::uint64_t stored_triangles = 0, stored_vertices = 0;  // of each mesh once
  std::vector<std::string> materials;                       // names
  std::vector<TextureDescription> textures;
  std::uint64_t point_lights = 0, directional_lights = 0, area_lights = 0;
  std::vector<std::string> cameras;                                // names
  bool has_normals = false, has_uvs = false, has_colours = false;  // any mesh
  bool has_second_uvs = false;
  bool z_up = false;
  geometry::Box3 bounds;    // empty for an empty scene
  std::uint64_t bytes = 0;  // of vertices, triangles and texels in memory
};

// O(vertices of all instances), for the bounds; parallel.
Description describe(const Scene& scene);

}  // namespace delray::scenes

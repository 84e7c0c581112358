// Points of a tile's triangles at their pixels, for shading by vectors: what point_at does, sixteen
// pixels at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raster/shading/pixel_triangles.h"
#include "raster/shading/world_vertices.h"
#include "shading/points.h"

namespace delray::raster {

// Attributes of the tile's triangles as planes, by triangle. Those that no triangle has are empty.
struct PointPlanes {
  std::vector<PixelTriangle> position;  // and 1
  std::vector<ValuePlanes> normal;      // and 0
  std::vector<glm::vec4> geometric;     // unit normal; w: handedness of the tangents
  std::vector<ValuePlanes> uv;          // of both sets
  std::vector<ValuePlanes> tangent;     // and 0
  std::vector<ValuePlanes> colour;
  int texture_sets = 0;  // that are looked at
};

// Vertices of a cluster: four numbers each.
struct VertexRows {
  alignas(64) float row[kClusterVertices + 16][4];
};

// Texture coordinates of a vertex, those of set 1 last; 0 where the mesh has none.
inline glm::vec4 uv_row(const scenes::Mesh& mesh, std::uint32_t vertex) {
  return {mesh.uvs.empty() ? glm::vec2(0.0F) : mesh.uvs[vertex],
          mesh.uvs2.empty() ? glm::vec2(0.0F) : mesh.uvs2[vertex]};
}

// Positions and normals of `count` triangles from number `first` on, whose barycentrics are set,
// and perhaps of some more, up to the next multiple of 16. `handedness`: -1 where the draw mirrors.
//
// REQUIRES: there is room; corners are padded.
void set_up_points(const WorldVertices& vertices, std::size_t vertex_count,
                   const CornerNumbers& corners, std::size_t count, float handedness,
                   const TrianglePlanes& barycentrics, std::size_t first, PointPlanes& planes);
// As above, for any four values.
void set_up_values(const VertexRows& vertices, const CornerNumbers& corners, std::size_t count,
                   const TrianglePlanes& barycentrics, std::size_t first, ValuePlanes* planes);

// Pixels of a block, and their triangles.
struct PixelBlock {
  std::uint16_t triangle[shading::kBlockPoints];
  float x[shading::kBlockPoints], y[shading::kBlockPoints];
};
// Colours of vertices stay as they are if planes.colour is empty.
void set_points(const PointPlanes& planes, const PixelBlock& block, shading::Points& points);

// Planes of texture coordinates, and the sets of them that are looked at. May be empty.
struct UvPlanes {
  std::span<const ValuePlanes> planes;
  int sets = 0;
};
// As above, for any three values beside 1 and the points' uvs.
void set_values(std::span<const PixelTriangle> values, const UvPlanes& uvs, const PixelBlock& block,
                shading::Vectors16& results, shading::Points& points);

}  // namespace delray::raster

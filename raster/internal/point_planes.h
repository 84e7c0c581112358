// Points of a tile's triangles at their pixels, for shading by vectors: what point_at does, sixteen
// pixels at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raster/internal/pixel_triangles.h"
#include "raster/internal/world_vertices.h"
#include "shading/points.h"

namespace delray::raster {

// Attributes of the tile's triangles as planes, by triangle. Those that no triangle has are empty.
struct PointPlanes {
  std::vector<PixelTriangle> position;   // and 1
  std::vector<ValuePlanes> normal;       // and 0
  std::vector<glm::vec4> geometric;      // unit normal; w: handedness of the tangents
  std::vector<ValuePlanes> uv, tangent;  // and 0
  std::vector<ValuePlanes> colour;
};

// Vertices of a cluster: four numbers each.
struct VertexRows {
  alignas(64) float row[kClusterVertices + 16][4];
};

// Positions and normals of `count` triangles from number `first` on, whose barycentrics are set,
// and perhaps of some more, up to the next multiple of 16. `handedness`: -1 where the draw mirrors.
//
// REQUIRES: there is room; corners are padded.
void set_up_points(const WorldVertices& vertices, std::size_t vertex_count,
                   const CornerNumbers& corners, std::size_t count, float handedness,
                   const TrianglePlanes& barycentrics, std::size_t first, PointPlanes& planes);
// The same of any four values.
void set_up_values(const VertexRows& vertices, const CornerNumbers& corners, std::size_t count,
                   const TrianglePlanes& barycentrics, std::size_t first, ValuePlanes* planes);

// Pixels of a block, and their triangles.
struct PixelBlock {
  std::uint16_t triangle[shading::kBlockPoints];
  float x[shading::kBlockPoints], y[shading::kBlockPoints];
};
// Colours of vertices stay as they are if planes.colour is empty.
void set_points(const PointPlanes& planes, const PixelBlock& block, shading::Points& points);

// The same of any three values beside 1, and of uv and footprints unless there are no uvs.
void set_values(std::span<const PixelTriangle> values, std::span<const ValuePlanes> uvs,
                const PixelBlock& block, shading::Vectors16& results, shading::Points& points);

}  // namespace delray::raster

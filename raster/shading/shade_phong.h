// Phong shading of a tile's visible pixels: the material's model at every one, sixteen at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raster/shading/point_planes.h"
#include "raster/shading/tile_triangles.h"

namespace delray::raster {

// Memory for a tile. One per thread.
class PhongTile {
 public:
  // As shade_tile does it, without asking `seen` but for triangles that something may be seen
  // through, or whose barycentrics are not proper.
  template <class Colour>
  std::uint64_t shade(const FrameShading& frame, SeenTriangles& seen, const VisibilityTile& tile,
                      const geometry::Rect& rect, const Window<Colour>& window);

  // As colour_at gives them, premultiplied.
  void colours(const FrameShading& frame, SeenTriangles& seen, std::span<const SurfaceAt> surfaces,
               image::RgbaF* colours);

 private:
  void make_room(const FrameShading& frame);
  void set_up_group(const FrameShading& frame, const ClusterMembers& members);
  template <class Row>
  void set_up_values(const ClusterMembers& members, std::vector<ValuePlanes>& planes,
                     const Row& row);
  // The lanes of `shown`.
  void shade_block(const FrameShading& frame, shading::LaneMask shown);

  TileTriangles triangles_;
  PointPlanes planes_;
  // Of triangles: 4 * material, 2 more if something may be seen through it, 1 more with colours of
  // vertices.
  std::vector<std::uint32_t> kinds_;
  PixelBlock block_;
  WorldVertices world_vertices_;
  VertexRows rows_;
  shading::Points points_;
  shading::Shaded shaded_;
};

}  // namespace delray::raster

// Gouraud shading of a tile's visible pixels: distinct triangles, their distinct vertices lit, and
// the pixels between them, all by vectors.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "image/image.h"
#include "raster/shading/shade_row.h"
#include "raster/shading/tile_triangles.h"
#include "raster/shading/world_vertices.h"

namespace delray::raster {

// Memory for a tile. One per thread. Vertices are lit together with those of other clusters.
class GouraudTile {
 public:
  // As shade_tile does it, without asking `seen` but for triangles with a texture, with a vertex
  // that has no normal, or whose barycentrics are not proper.
  template <class Colour>
  std::uint64_t shade(const FrameShading& frame, SeenTriangles& seen, const VisibilityTile& tile,
                      const geometry::Rect& rect, const Window<Colour>& window);

  // As colour_at gives them, premultiplied.
  void colours(const FrameShading& frame, SeenTriangles& seen, std::span<const SurfaceAt> surfaces,
               image::RgbaF* colours);

  // Of at most kTilePixels triangles of the frame's list, each once: the radiance of corner k of
  // triangle i, without any texture, is radiances[corners[i][k]]. There are no others. Until the
  // next call.
  struct LitCorners {
    std::span<const glm::uvec3> corners;
    std::span<const glm::vec3> radiances;
  };
  LitCorners light_corners(const FrameShading& frame, std::span<const std::uint32_t> numbers);

 private:
  // Vertices of one material that wait to be lit together.
  struct VertexBlock {
    int count = 0;
    shading::Points points;
    std::uint32_t vertices[kBlockSize];
  };

  // Values that a pixel's colour depends on besides the light.
  struct Surface {
    std::uint32_t material = 0, texture = scenes::kNone;
    bool blended = false;
    bool operator==(const Surface&) const = default;
  };

  void set_up_triangles(const FrameShading& frame);
  void set_up_textures(const FrameShading& frame, const ClusterMembers& members);
  void shade_special(const FrameShading& frame, shading::LaneMask lanes);
  void set_up_group(const FrameShading& frame, const ClusterMembers& members);
  void turn_normals(const Draw& draw, const ClusterMembers& members, std::size_t member,
                    std::uint32_t triangle, bool front, std::uint32_t first_vertex);
  std::uint32_t turned(std::uint32_t used, std::size_t used_count);
  void add_vertices(const FrameShading& frame, const scenes::Mesh& mesh,
                    const ClusterMembers& members, std::uint32_t first_vertex);
  VertexBlock& block_of(std::size_t number, bool coloured);
  void light(const FrameShading& frame, std::size_t block);
  void leave_triangles_without_normals();

  TileTriangles triangles_;             // their corners: into radiances_
  std::vector<PixelTriangle> colours_;  // of the triangles
  // By triangle: uvs_ if any draw has a texture, surfaces_ if any has one or is blended.
  std::vector<ValuePlanes> uvs_;
  std::vector<Surface> surfaces_;
  bool any_special_ = false;  // in the tile
  VertexRows uv_rows_ = {};
  PixelBlock block_;
  shading::Vectors16 block_colours_;
  shading::Floats16 block_alpha_;
  shading::Points points_;
  shading::Shaded texels_;
  // For the group at hand: used vertices whose normals are turned, a sparse set (Briggs & Torczon
  // 1993): v is in it if turned_[turned_number_[v]] == v, so that it needs no clearing.
  std::uint8_t turned_number_[kClusterVertices];
  std::uint32_t turned_[kClusterVertices + 1];
  std::size_t turned_count_ = 0;
  WorldVertices world_vertices_;

  // By vertex: linear light, and 1, or 0 where it has no normal. The first is nobody's.
  std::vector<glm::vec4> radiances_;
  bool all_have_normals_ = true;
  // By material, without and with colours of vertices; null where none was needed.
  std::vector<std::unique_ptr<VertexBlock>> blocks_;
  std::vector<std::size_t> open_blocks_;  // all with vertices in them, and others

  // For light_corners.
  std::unique_ptr<SeenTriangles> seen_;
  std::vector<std::uint32_t> lit_of_vertex_;
  std::vector<glm::uvec3> lit_corners_;
  std::vector<glm::vec3> lit_radiances_;
};

}  // namespace delray::raster

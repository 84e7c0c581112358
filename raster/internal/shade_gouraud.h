// Gouraud shading of a tile's visible pixels: distinct triangles, their distinct vertices lit, and
// the pixels between them, all by vectors.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "image/image.h"
#include "raster/internal/pixel_triangles.h"
#include "raster/internal/shade_tile.h"
#include "raster/internal/tile_groups.h"
#include "raster/internal/tile_runs.h"
#include "raster/internal/world_vertices.h"

namespace delray::raster {

inline constexpr int kBlockSize = 16;

// Stores the colours of pixels x .. x + count - 1 of row y. Where a run of pixels starts there is a
// bit of `starts`, the first one for the first pixel; run i shows triangle runs[i], or transparent
// black where that is kNoTriangle. `pixels` may be changed up to the next multiple of kBlockSize.
//
// REQUIRES: count <= kTileSize; no run starts after the last pixel.
void shade_row(std::span<const PixelTriangle> triangles, std::uint64_t starts,
               const std::uint16_t* runs, int x, int y, int count, image::Rgba8* pixels);
void shade_row(std::span<const PixelTriangle> triangles, std::uint64_t starts,
               const std::uint16_t* runs, int x, int y, int count, image::RgbaF* pixels);

// The depths of `count` keys, or the distances that they stand for if `near` is not 0, infinity
// where nothing is seen. `depths` may be changed up to the next multiple of kBlockSize.
void store_depths(const std::int64_t* keys, int count, float near, float* depths);

// Memory for a tile. One per thread.
//
// The triangles that are seen are looked up cluster by cluster: their vertices have small numbers
// there, are transformed together, and lit together with those of other clusters.
class GouraudTile {
 public:
  // As shade_tile does it, without asking `seen` but for triangles with a texture, with a vertex
  // that has no normal, or whose barycentrics are not proper.
  template <class Colour>
  std::uint64_t shade(const FrameShading& frame, SeenTriangles& seen, const VisibilityTile& tile,
                      const geometry::Rect& rect, const Window<Colour>& window);

  // Of at most kTilePixels triangles of the frame's list, each once: the radiance of corner k of
  // triangle i, without any texture, is radiances[corners[i][k]]. There are no others. Until the
  // next call.
  struct LitCorners {
    std::span<const glm::uvec3> corners;
    std::span<const glm::vec3> radiances;
  };
  LitCorners light_corners(const FrameShading& frame, std::span<const std::uint32_t> numbers);

 private:
  using Group = TileGroups::Group;

  // What a group uses.
  struct Members {
    const Group* group = nullptr;
    CornerNumbers corners;                    // of its triangles, numbers of `vertices`
    std::span<const std::uint32_t> vertices;  // of the mesh
    // For groups that use but a part of the cluster's vertices.
    std::uint32_t chosen_vertices[kClusterVertices] = {};
    std::uint8_t used[kClusterVertices] = {};    // by vertex of the cluster: 1, 0 between groups
    std::uint8_t number[kClusterVertices] = {};  // of those used
  };
  // Vertices of one material that wait to be lit together.
  struct VertexBlock {
    int count = 0;
    shading::Points points;
    std::uint32_t vertices[kBlockSize];
  };

  void set_up_triangles(const FrameShading& frame);
  bool shaded_here(const FrameShading& frame, const Group& group) const;
  void ask_for(const FrameShading& frame);
  static void number_vertices(std::span<const std::uint32_t> vertices, Members& members);
  void collect(const FrameShading& frame, const Group& group, Members& members);
  void set_up_group(const FrameShading& frame, Members& members);
  void set_up_clipped(const FrameShading& frame, const Group& group, std::size_t member,
                      ClusterFacing& facing);
  void turn_normals(const Draw& draw, const Members& members, std::size_t member,
                    std::uint32_t triangle, bool front, std::uint32_t first_vertex);
  std::uint32_t turned(std::uint32_t used, std::size_t used_count);
  void add_vertices(const FrameShading& frame, const scenes::Mesh& mesh, const Members& members,
                    std::uint32_t first_vertex);
  VertexBlock& block_of(std::size_t number, bool coloured);
  void light(const FrameShading& frame, std::size_t block);
  void leave_triangles_without_normals();
  void set_colours();
  void shade_one_by_one(std::size_t triangle) {
    one_by_one_[triangle] = 1;
    any_one_by_one_ = true;
  }

  TileRuns runs_;
  TileGroups groups_;
  RunTriangles run_triangles_;
  // By triangle that is seen.
  TrianglePlanes planes_;  // corners: into radiances_
  std::vector<PixelTriangle> triangles_;
  std::vector<std::uint8_t> one_by_one_;
  bool any_one_by_one_ = false;
  bool without_textures_ = false;

  Members members_[2];  // of a group and the next
  // Of the group at hand: used vertices whose normals are turned, a sparse set (Briggs & Torczon
  // 1993): v is in it if turned_[turned_number_[v]] == v, so that it needs no clearing.
  std::uint8_t turned_number_[kClusterVertices];
  std::uint32_t turned_[kClusterVertices + 1];
  std::size_t turned_count_ = 0;
  ScreenVertices screen_vertices_;
  WorldVertices world_vertices_;

  // By vertex: linear light, and 1, or 0 where it has no normal. The first is nobody's.
  std::vector<glm::vec4> radiances_;
  bool all_have_normals_ = true;
  // By material, without and with colours of vertices; null where none was needed.
  std::vector<std::unique_ptr<VertexBlock>> blocks_;
  std::vector<std::size_t> open_blocks_;  // all with vertices in them, and others

  // For light_corners.
  std::vector<std::uint16_t> groups_of_lit_;
  std::unique_ptr<SeenTriangles> seen_;
  std::vector<std::uint32_t> lit_of_vertex_;
  std::vector<glm::uvec3> lit_corners_;
  std::vector<glm::vec3> lit_radiances_;
};

}  // namespace delray::raster

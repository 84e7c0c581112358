// Gouraud shading of a tile's visible pixels: distinct triangles, their distinct vertices lit, and
// the pixels between them, all by vectors.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "image/image.h"
#include "raster/internal/shade_tile.h"
#include "raster/internal/tile_runs.h"
#include "raster/internal/world_vertices.h"

namespace delray::raster {

inline constexpr int kBlockSize = 16;

// What the pixels of a triangle look up: barycentrics, and the colour of corner k as red, green,
// blue. Vectors of four are loaded from each of them; a, b and c are padded with 0.
struct alignas(32) PixelTriangle {
  float a[4], b[4], c[4];
  float x, y;
  float colour[3][3];
  float padding;
};
static_assert(sizeof(PixelTriangle) == 96);

// Index of a pixel that shows no triangle, or none that is shaded here.
inline constexpr std::uint16_t kNoTriangle = 0xFFFFU;

// Stores the colours of pixels x .. x + count - 1 of row y, pixel x + i of which shows triangle
// index[i], or transparent black where that is kNoTriangle. `pixels` may be changed up to the next
// multiple of kBlockSize, and `index` read one further.
void shade_row(std::span<const PixelTriangle> triangles, const std::uint16_t* index, int x, int y,
               int count, image::Rgba8* pixels);
void shade_row(std::span<const PixelTriangle> triangles, const std::uint16_t* index, int x, int y,
               int count, image::RgbaF* pixels);

// The depths of `count` keys, or the distances that they stand for if `near` is not 0, infinity
// where nothing is seen. `depths` may be changed up to the next multiple of kBlockSize.
void store_depths(const std::int64_t* keys, int count, float near, float* depths);

// Memory for a tile. One per thread.
//
// The triangles that are seen are looked up cluster by cluster: their vertices have small numbers
// there, are transformed together, and lit together with those of other clusters.
class GouraudTile {
 public:
  GouraudTile();

  // As shade_tile does it, without asking `seen` but for triangles with a texture, or with a vertex
  // that has no normal.
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
  static constexpr std::uint32_t kSlots = 2 * kTilePixels;
  static constexpr std::uint16_t kNone = 0xFFFFU;

  // The triangles of a cluster that are seen: a list through next_. What they refer to is scattered
  // in memory: it is asked for some time before it is needed.
  struct Group {
    std::uint32_t cluster;
    std::uint16_t head;
    const ClusterBlock* block = nullptr;
    const MeshCluster* part = nullptr;
  };
  // A triangle of the group at hand, with its corners in the cluster.
  struct Member {
    std::uint16_t triangle;
    std::uint8_t place;
    std::uint8_t corner[3];
  };
  // What a group uses.
  struct Members {
    Member triangles[kClusterTriangles];
    std::size_t triangle_count = 0;
    std::uint8_t used[kClusterVertices] = {};    // by vertex of the cluster: 1, 0 between groups
    std::uint8_t number[kClusterVertices] = {};  // of those used
    std::uint32_t mesh_vertices[kClusterVertices] = {};  // by number
    std::size_t used_count = 0;
  };
  // Vertices of one material that wait to be lit together.
  struct VertexBlock {
    int count = 0;
    shading::Points points;
    std::uint32_t vertices[kBlockSize];
  };

  void begin();
  std::uint64_t find_triangles(const VisibilityTile& tile, const geometry::Rect& rect);
  std::uint16_t index_of(std::uint32_t number);
  std::uint16_t add_triangle(std::uint32_t number);
  std::size_t group_of(std::uint32_t cluster);
  void set_up_triangles(const FrameShading& frame);
  void set_up_groups(const FrameShading& frame);
  void look_up(const FrameShading& frame, Group& group);
  void collect(const FrameShading& frame, const Group& group, Members& members);
  void set_up_group(const FrameShading& frame, const Group& group, const Members& members);
  void set_up_member(const FrameShading& frame, const Cluster& cluster, const MeshCluster& part,
                     const Members& members, const Member& member, std::uint32_t first_vertex);
  std::uint32_t turned(std::uint32_t used, std::size_t used_count);
  void add_vertices(const FrameShading& frame, const scenes::Mesh& mesh, const Members& members,
                    std::uint32_t first_vertex);
  void light(const FrameShading& frame, std::size_t block);
  void set_colours();
  void shade_one_by_one(std::uint16_t triangle) {
    one_by_one_[triangle] = 1;
    any_one_by_one_ = true;
  }

  TileRuns runs_;
  std::uint16_t index_[kTilePixels + 2 * kBlockSize];  // by pixel of the tile
  // By triangle that is seen.
  std::vector<std::uint32_t> numbers_;
  std::vector<std::uint16_t> next_;
  std::vector<PixelTriangle> triangles_;
  std::vector<glm::uvec3> corners_;  // into radiances_
  std::vector<std::uint8_t> one_by_one_;
  bool any_one_by_one_ = false;
  bool without_textures_ = false;

  // Hash tables of indices into numbers_ and groups_, kNone where free.
  std::uint16_t triangle_slots_[kSlots], group_slots_[kSlots];
  std::vector<Group> groups_;
  std::uint32_t last_cluster_ = kNothing;  // that a triangle was found of
  std::size_t last_group_ = 0;

  Members members_[2];  // of a group and the next
  // Of the group at hand: used vertices whose normals are turned, a sparse set (Briggs & Torczon
  // 1993): v is in it if turned_[turned_number_[v]] == v, so that it needs no clearing.
  std::uint8_t turned_number_[kClusterVertices];
  std::uint32_t turned_[kClusterVertices + 1];
  std::size_t turned_count_ = 0;
  ScreenVertices screen_vertices_;
  WorldVertices world_vertices_;

  // By vertex: linear light, and 1, or 0 where it has no normal.
  std::vector<glm::vec4> radiances_;
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

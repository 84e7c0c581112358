// Gouraud shading of a tile's visible pixels: distinct triangles, their distinct vertices lit, and
// the pixels between them, all by vectors.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "image/image.h"
#include "raster/internal/shade_tile.h"
#include "raster/internal/triangle_block.h"

namespace delray::raster {

// What the pixels of a triangle look up: barycentrics, and the colour of corner k as red, green,
// blue. Padded to vectors of four; the padding of a, b and c is 0.
struct PixelTriangle {
  float a[4], b[4], c[4];
  float colour[3][4];
  float x, y, padding[2];
};
inline constexpr int kPixelTriangleFloats = 28;
static_assert(sizeof(PixelTriangle) == kPixelTriangleFloats * sizeof(float));

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
class GouraudTile {
 public:
  GouraudTile();

  // As shade_tile does it, without asking `seen` but for triangles with a texture.
  template <class Colour>
  std::uint64_t shade(const FrameShading& frame, SeenTriangles& seen, const VisibilityTile& tile,
                      const geometry::Rect& rect, const Window<Colour>& window);

  // Of triangles of the frame's list, each once: the radiance of corner k of triangle i, without
  // any texture, is radiances[corners[i][k]]. Until the next call.
  struct LitCorners {
    std::span<const glm::uvec3> corners;
    std::span<const glm::vec3> radiances;
  };
  LitCorners light_corners(const FrameShading& frame, std::span<const std::uint32_t> numbers);

 private:
  static constexpr std::uint32_t kTriangleSlots = 2 * kTilePixels;
  static constexpr std::uint64_t kNoVertex = ~std::uint64_t{0};

  // Vertices of one material that wait to be lit together.
  struct VertexBlock {
    int count = 0;
    shading::Points points;
    std::uint32_t vertices[kBlockSize];
  };
  struct VertexSlot {
    std::uint64_t key = kNoVertex;
    std::uint32_t vertex = 0;
  };

  // Where a triangle comes from.
  struct SeenIn {
    std::uint32_t draw, triangle;
    glm::uvec3 corners;
  };

  std::uint64_t find_triangles(const VisibilityTile& tile, const geometry::Rect& rect);
  void look_up_triangles(const DrawList& list);
  void look_up_corners(const DrawList& list, std::size_t first);
  void set_up_triangles(const FrameShading& frame);
  void set_up_block(const FrameShading& frame, std::size_t first, int count);
  void add_corners(const FrameShading& frame, int i, std::size_t triangle);
  std::uint32_t vertex_of(std::uint32_t draw, std::uint32_t vertex, std::uint32_t side,
                          bool& is_new);
  std::uint32_t remember_vertex(std::size_t slot, std::uint64_t key);
  void add_vertex(const FrameShading& frame, std::uint32_t material, int i, int k,
                  const scenes::Mesh& mesh, std::uint32_t mesh_vertex, std::uint32_t vertex);
  void light(const FrameShading& frame, std::size_t block);

  std::uint16_t index_[kTilePixels + 1];  // by pixel of the tile
  std::vector<std::uint32_t> numbers_;    // distinct triangles
  std::vector<PixelTriangle> triangles_;
  std::vector<SeenIn> seen_in_;
  std::vector<glm::uvec3> corners_;  // of triangles: into radiances_
  std::vector<std::uint8_t> textured_;
  bool any_textured_ = false;
  bool without_textures_ = false;

  struct TriangleSlot {
    std::uint32_t number = kNothing;
    std::uint32_t index = 0;
  };
  std::vector<TriangleSlot> triangle_slots_;
  std::vector<std::uint32_t> used_triangle_slots_;
  std::vector<VertexSlot> vertex_slots_;  // a power of two of them
  int vertex_slot_shift_ = 0;
  std::vector<std::uint32_t> used_vertex_slots_;

  TriangleBlock block_;
  TriangleGeometry geometry_;
  std::uint32_t draw_of_lane_[kBlockSize];

  std::vector<glm::vec3> radiances_;
  // By material, without and with colours of vertices; null where none was needed.
  std::vector<std::unique_ptr<VertexBlock>> blocks_;
  std::vector<std::size_t> open_blocks_;  // those with vertices in them
};

}  // namespace delray::raster

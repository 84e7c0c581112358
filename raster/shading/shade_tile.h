// Colours of a tile's visible pixels (deferred shading: Deering et al. 1988).
#pragma once

#include <span>
#include <vector>

#include "image/image.h"
#include "raster/pipeline/prepared_draw.h"
#include "raster/pipeline/visibility.h"
#include "raster/pipeline/window.h"
#include "raster/render.h"
#include "raster/shading/seen_triangle.h"
#include "shading/batch.h"

namespace delray::raster {

// Values of a frame that all its tiles look up.
struct FrameShading {
  const Screen& screen;
  const shading::Shader& shader;
  const DrawList& list;
  std::vector<ShadedDraw> draws;             // of the list's draws
  shading::BatchShader batch;                // the shader for many points at a time
  std::vector<scenes::Material> untextured;  // the shader's materials without textures; for gouraud
  shading::BatchShader untextured_batch;     // the same, for many vertices at a time
  // Whether any draw so far has colours of vertices, a material with a normal map, or may be seen
  // through, and the most sets of texture coordinates that a material looks at.
  bool any_colours = false, any_normal_maps = false, any_blended = false;
  int texture_sets = 0;
  bool all_plain = true;  // is_plain(), of all draws
  Lighting lighting;
  // Images get distances along the view axis rather than -near / distance.
  bool distances;

  float shown_depth(std::int64_t key) const {
    const float depth = depth_of(key);
    const float distance = distance_of(depth, screen.view);
    return distances && depth < 0 ? distance : depth;
  }
};
FrameShading make_frame_shading(const Screen& screen, const shading::Shader& shader,
                                const DrawList& list, Lighting lighting, bool distances);
// Looks up the draws that the list has been given since.
void add_draws(FrameShading& frame);

// Triangles seen lately, and their lit vertices; neighbouring pixels mostly show the same few. One
// per thread.
class SeenTriangles {
 public:
  // Forgets all: another frame may give the same numbers to other triangles.
  void clear();
  const SeenTriangle& get(const FrameShading& frame, std::uint32_t number);

 private:
  static constexpr int kSlotBits = 7;
  static constexpr int kVertexSlotBits = 9;
  static constexpr std::uint64_t kNoVertex = ~std::uint64_t{0};

  void light_vertices(const FrameShading& frame, std::uint32_t draw, const glm::uvec3& corners,
                      SeenTriangle& triangle);

  std::uint32_t numbers_[1 << kSlotBits];
  SeenTriangle triangles_[1 << kSlotBits];
  std::uint64_t vertices_[1 << kVertexSlotBits];
  glm::vec3 radiances_[1 << kVertexSlotBits];
};

// Whether alpha leaves anything of the triangle at a pixel.
bool alpha_test(const FrameShading& frame, SeenTriangles& seen, std::uint32_t number, int x, int y);

// The point of a triangle at a pixel that is shaded, here or on another rank.
struct SeenPoint {
  std::uint32_t material = 0;  // of the shader's
  std::uint32_t blended = 0;   // whether what is behind may be seen
  shading::Point point;
};
inline bool is_opaque(const SeenPoint& seen) { return seen.blended == 0; }
SeenPoint point_seen(const FrameShading& frame, SeenTriangles& seen, std::uint32_t number, int x,
                     int y);
inline image::RgbaF premultiplied(const glm::vec3& colour, float alpha) {
  return {colour.x * alpha, colour.y * alpha, colour.z * alpha, alpha};
}
// Its colour by phong, premultiplied.
image::RgbaF shade(const FrameShading& frame, const SeenPoint& point);

// The colour of one pixel that shows the triangle, premultiplied.
image::RgbaF colour_at(const FrameShading& frame, SeenTriangles& seen, std::uint32_t number, int x,
                       int y);
template <class Colour>
void shade_pixel(const FrameShading& frame, SeenTriangles& seen, std::uint32_t number, int x, int y,
                 Colour& pixel);

// Writes colour and depth of the pixels of `rect` (of the frame, within the tile) to the window.
// Returns how many of them show something. One by one: shade_gouraud.h and
// shade_phong.h have faster ways to the same colours.
template <class Colour>
std::uint64_t shade_tile(const FrameShading& frame, SeenTriangles& seen, const VisibilityTile& tile,
                         const geometry::Rect& rect, const Window<Colour>& window);

// Writes pixels that show nothing.
template <class Colour>
void clear_pixels(const geometry::Rect& rect, const Window<Colour>& window);

}  // namespace delray::raster

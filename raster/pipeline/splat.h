// Points and segments on the screen: splats (Westover 1990; Zwicker et al. 2001, without the
// blending).
//
// A spot covers the pixel that its centre lies in and those whose centres are nearer than its
// radius; its depth is the centre's. Discs, spheres and segments with round ends are met by the ray
// through a pixel's centre, which gives coverage and depth at once; segments as wide as some pixels
// are stripes on the screen, as deep as the segment is where it is nearest.
#pragma once

#include <glm/glm.hpp>

#include "raster/pipeline/draws.h"
#include "raster/pipeline/transform.h"
#include "raster/pipeline/visibility.h"

namespace delray::raster {

// What the splats of a draw have in common. Kind triangle: it has none.
struct SplatDraw {
  scenes::Shape::Kind kind = scenes::Shape::Kind::triangle;
  bool in_samples = false;  // the radius is in samples of the screen, else in the world's units
  float radius = 0;
  ToView to_view;
  glm::mat3 normal_to_view{1.0F};  // up to a positive factor

  bool any() const { return kind != scenes::Shape::Kind::triangle; }
  bool is_spot() const { return kind == scenes::Shape::Kind::point; }
};
SplatDraw make_splat_draw(const Screen& screen, const Draw& draw);

// The largest radius in samples; larger ones are cut down to it.
inline constexpr float kLargestSplat = 16384;

struct Splat {
  scenes::Shape::Kind kind = scenes::Shape::Kind::point;
  std::uint32_t number = 0;
  geometry::Rect pixels;  // of the frame, that it may cover; empty: none
  // Of a spot: its centre, and its radius in subpixels.
  ScreenVertex centre;
  std::int32_t subpixels = 0;
  // Of the others, in view coordinates: the point, or the ends of the segment.
  glm::vec3 a{0.0F}, b{0.0F};
  // Of a segment whose radius is in samples: the ends on the screen, in pixels of the frame, of
  // what is not before the near plane.
  bool on_screen = false;
  glm::vec2 screen_a{0.0F}, screen_b{0.0F};
  glm::vec3 normal{0.0F};  // of a disc; 0: it faces the viewer
  float radius = 0;
  float nearest = -1;  // no depth of it is less
};

// Of primitive t of the draw's mesh, which pages may have replaced. Spots whose centres are before
// the near plane or outside of the guard band are empty, as is what is not finite.
Splat make_splat(const Screen& screen, const SplatDraw& draw, const scenes::Mesh& mesh,
                 std::uint32_t t, std::uint32_t number);

// Where the ray through a pixel's centre meets a splat that is no spot, in view coordinates.
struct SplatHit {
  glm::vec3 position{0.0F};
  glm::vec3 normal{0.0F};  // not of unit length; 0: towards the viewer
  float along = 0;         // of a segment: 0 at a, 1 at b
};
bool meets(const Screen& screen, const Splat& splat, int x, int y, SplatHit& hit);

// The depth at a distance along the view axis.
inline float depth_at_distance(const scenes::View& view, float distance) {
  const float depth =
      view.orthographic ? (distance - view.far) / (view.far - view.near) : -view.near / distance;
  return std::min(depth, kDeepest);
}

// Whether the splat covers the centre of a pixel of the frame, and its depth there.
inline bool covers(const Screen& screen, const Splat& splat, int x, int y, float& depth) {
  if (splat.kind != scenes::Shape::Kind::point) {
    SplatHit hit;
    if (!meets(screen, splat, x, y, hit)) return false;
    depth = depth_at_distance(screen.view, hit.position.z);
    return true;
  }
  depth = splat.centre.depth;
  const std::int64_t i = x - screen.centre_x, j = y - screen.centre_y;
  if (i == splat.centre.x >> kSubpixelBits && j == splat.centre.y >> kSubpixelBits) return true;
  const std::int64_t dx = i * kSubpixels + kHalfPixel - splat.centre.x;
  const std::int64_t dy = j * kSubpixels + kHalfPixel - splat.centre.y;
  return dx * dx + dy * dy < std::int64_t{splat.subpixels} * splat.subpixels;
}

// Calls f(i, j, key) for every pixel of `rect`, at (i, j) of its tile, that the splat covers.
template <class F>
void for_each_covered(const Screen& screen, const geometry::Rect& rect, const Splat& splat, F&& f) {
  const int tile_x = rect.x0 / kTileSize * kTileSize;
  const int tile_y = rect.y0 / kTileSize * kTileSize;
  const geometry::Rect pixels = geometry::intersection(splat.pixels, rect);
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x) {
      float depth;
      if (covers(screen, splat, x, y, depth))
        f(x - tile_x, y - tile_y, key_of(depth, splat.number));
    }
  }
}

// Leaves at every pixel of `rect` the least (depth, number) of what was there and of the splats
// that `entries` name.
void rasterize_splats(const Screen& screen, const geometry::Rect& rect,
                      std::span<const Splat> splats, std::span<const std::uint32_t> entries,
                      VisibilityTile& tile);
// The same, and shade(number, x, y) is called whenever a pixel comes to show another one. Returns
// how often.
std::uint64_t draw_and_shade(const Screen& screen, const geometry::Rect& rect,
                             std::span<const Splat> splats, std::span<const std::uint32_t> entries,
                             parallel::FunctionRef<void(std::uint32_t, int, int)> shade,
                             VisibilityTile& tile);

}  // namespace delray::raster

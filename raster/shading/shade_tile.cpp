// Shades a tile's pixels one by one (deferred shading: Deering et al. 1988), and the triangles and
// vertices that were seen lately are kept in hash tables of a thread. The faster functions for
// tiles give the same colours.
//
// Degenerate: for a point at the viewer's own place the view axis stands in.
#include "raster/shading/shade_tile.h"

#include <algorithm>
#include <cmath>

#include "composite/fragment.h"
#include "parallel/parallel_for.h"
#include "raster/shading/shade_splats.h"
#include "shading/shade.h"

namespace delray::raster {
namespace {

// Multipliers of Fibonacci hashing (Knuth 1973, 6.4).
constexpr std::uint32_t kGoldenRatio32 = 0x9E3779B9U;
constexpr std::uint64_t kGoldenRatio64 = 0x9E3779B97F4A7C15U;

// Pixels are shaded in squares of this side: a triangle's pixels lie close together in time too.
constexpr int kSquare = 8;

glm::vec3 to_viewer(const FrameShading& frame, const glm::vec3& position) {
  const glm::vec3 way = frame.screen.view.viewpoint - position;
  const float squared = glm::dot(way, way);
  return squared > 0 ? way * (1.0F / std::sqrt(squared)) : -frame.screen.view.forward;
}

// Without shadows: every light arrives.
glm::vec3 radiance(const FrameShading& frame, const scenes::Material& material,
                   const shading::Point& point) {
  const glm::vec3 view = to_viewer(frame, point.position);
  const shading::Surface surface = shading::evaluate(frame.shader, material, point, view);
  return shading::shade(frame.shader, surface, view,
                        [](std::size_t, const shading::Incident&) { return 1.0F; });
}

glm::vec3 gouraud(const FrameShading& frame, const SeenTriangle& triangle, int x, int y) {
  const Barycentrics& t = triangle.barycentrics;
  const std::uint32_t texture = triangle.material->base_colour_texture;
  const int set = texture == scenes::kNone ? 0 : frame.shader.textures[texture].set;
  glm::vec3 lit;
  shading::TexturePoint at;
  if (t.proper) {
    const auto dx = static_cast<float>(x - t.x), dy = static_cast<float>(y - t.y);
    const glm::vec4 sums = sums_at(triangle.radiance_planes, dx, dy);
    const float share = 1 / sums.w;
    lit = glm::vec3(sums) * share;
    if (texture != scenes::kNone && (set == 0 ? triangle.has_uv : triangle.has_uv2))
      at = texture_point(triangle.uv_planes, set, triangle.radiance_planes, {dx, dy, share});
  } else {
    const Weights w = weights_at(t, x, y);
    lit = interpolate(w, triangle.radiance);
    at = bounded_texture_point(triangle, set, w);
  }
  if (texture == scenes::kNone) return lit;
  return lit * glm::vec3(shading::sample(frame.shader.textures[texture], at.uv, at.footprint));
}

float alpha_at(const FrameShading& frame, const SeenPoint& seen) {
  return seen.blended == 0
             ? 1.0F
             : shading::coverage(frame.shader, frame.shader.materials[seen.material], seen.point);
}

}  // namespace

FrameShading make_frame_shading(const Screen& screen, const shading::Shader& shader,
                                const DrawList& list, Lighting lighting, bool distances) {
  FrameShading frame{screen, shader, list,  {}, {},   {},       {},
                     false,  false,  false, 0,  true, lighting, distances};
  add_draws(frame);
  frame.batch = shading::make_batch_shader(shader);
  if (lighting == Lighting::gouraud) {
    frame.untextured = shader.materials;
    for (scenes::Material& material : frame.untextured) {
      for (std::uint32_t* const texture : material.textures()) *texture = scenes::kNone;
    }
    frame.untextured_batch = shading::make_batch_shader(shader, frame.untextured);
  }
  return frame;
}

void add_draws(FrameShading& frame) {
  constexpr std::size_t kAtOnce = 256;
  const std::size_t first = frame.draws.size();
  frame.draws.resize(frame.list.draws.size());
  parallel::parallel_for(first, frame.draws.size(), kAtOnce, [&](std::size_t i) {
    const Draw& draw = frame.list.draws[i];
    frame.draws[i] = make_shaded_draw(frame.screen.view, draw);
    frame.draws[i].blended = is_blended(frame.shader, *draw.mesh);
    frame.draws[i].splats = make_splat_draw(frame.screen, draw);
  });
  for (std::size_t i = first; i < frame.draws.size(); ++i) {
    const Draw& draw = frame.list.draws[i];
    frame.all_plain &= is_plain(frame.shader, draw);
    const scenes::Material& material = shading::material(frame.shader, draw.mesh->material);
    frame.any_blended |= frame.draws[i].blended;
    frame.any_colours |= !draw.mesh->colours.empty();
    frame.any_normal_maps |= material.normal_texture != scenes::kNone;
    frame.texture_sets =
        std::max(frame.texture_sets, shading::texture_sets(frame.shader, material));
  }
}

void SeenTriangles::clear() {
  std::fill(std::begin(numbers_), std::end(numbers_), kNothing);
  std::fill(std::begin(vertices_), std::end(vertices_), kNoVertex);
}

const SeenTriangle& SeenTriangles::get(const FrameShading& frame, std::uint32_t number) {
  const std::uint32_t slot = (number * kGoldenRatio32) >> (32 - kSlotBits);
  SeenTriangle& triangle = triangles_[slot];
  if (numbers_[slot] == number) return triangle;
  numbers_[slot] = number;
  const std::uint32_t draw = frame.list.cluster_of(number).draw;
  const std::uint32_t t = frame.list.triangle_of(number);
  triangle =
      make_seen_triangle(frame.screen, frame.shader, frame.list.draws[draw], frame.draws[draw], t);
  if (frame.lighting == Lighting::gouraud) {
    light_vertices(frame, draw, frame.list.draws[draw].mesh->triangles[t], triangle);
    const auto& radiance = triangle.radiance;
    triangle.radiance_planes = make_value_planes(
        triangle.barycentrics, {{radiance[0], 1}, {radiance[1], 1}, {radiance[2], 1}});
  }
  return triangle;
}

void SeenTriangles::light_vertices(const FrameShading& frame, std::uint32_t draw,
                                   const glm::uvec3& corners, SeenTriangle& triangle) {
  if (const auto* const radiances = frame.list.draws[draw].radiances) {
    for (int k = 0; k < 3; ++k) triangle.radiance[k] = (*radiances)[corners[k]];
    return;
  }
  const auto number = triangle.material - frame.shader.materials.data();
  const scenes::Material& material = frame.untextured[number];
  for (int k = 0; k < 3; ++k) {
    shading::Point point = corner(triangle, k);
    // A vertex without a normal of its own is lit as its triangle is.
    if (!triangle.own_normal[k]) {
      triangle.radiance[k] = radiance(frame, material, point);
      continue;
    }
    // The same vertex is lit on the other side where a neighbour faces away. Its normal says which
    // side: a geometric one of zero leaves it as it is.
    const bool turned = triangle.front != triangle.agrees[k];
    if (turned) point.normal = -point.normal;
    point.geometric_normal = glm::vec3(0.0F);
    const std::uint64_t key = (std::uint64_t{draw} << 33) | (std::uint64_t{corners[k]} << 1) |
                              static_cast<std::uint64_t>(turned);
    const std::uint64_t slot = (key * kGoldenRatio64) >> (64 - kVertexSlotBits);
    if (vertices_[slot] != key) {
      vertices_[slot] = key;
      radiances_[slot] = radiance(frame, material, point);
    }
    triangle.radiance[k] = radiances_[slot];
  }
}

bool alpha_test(const FrameShading& frame, SeenTriangles& seen, std::uint32_t number, int x,
                int y) {
  const SeenTriangle& triangle = seen.get(frame, number);
  const shading::Point point = point_at(triangle, x, y);
  return shading::coverage(frame.shader, *triangle.material, point) > 0;
}

SeenPoint point_seen(const FrameShading& frame, SeenTriangles& seen, std::uint32_t number, int x,
                     int y) {
  if (is_splat(frame, number)) return splat_point(frame, number, x, y);
  const SeenTriangle& triangle = seen.get(frame, number);
  return {static_cast<std::uint32_t>(triangle.material - frame.shader.materials.data()),
          triangle.blended ? 1U : 0U, point_at(triangle, x, y)};
}

image::RgbaF shade(const FrameShading& frame, const SeenPoint& seen) {
  return premultiplied(radiance(frame, frame.shader.materials[seen.material], seen.point),
                       alpha_at(frame, seen));
}

image::RgbaF colour_at(const FrameShading& frame, SeenTriangles& seen, std::uint32_t number, int x,
                       int y) {
  if (frame.lighting == Lighting::phong || is_splat(frame, number))
    return shade(frame, point_seen(frame, seen, number, x, y));
  const SeenTriangle& triangle = seen.get(frame, number);
  const float alpha = triangle.blended ? alpha_at(frame, point_seen(frame, seen, number, x, y)) : 1;
  return premultiplied(gouraud(frame, triangle, x, y), alpha);
}

template <class Colour>
void shade_pixel(const FrameShading& frame, SeenTriangles& seen, std::uint32_t number, int x, int y,
                 Colour& pixel) {
  composite::store(colour_at(frame, seen, number, x, y), pixel);
}

template <class Colour>
std::uint64_t shade_tile(const FrameShading& frame, SeenTriangles& seen, const VisibilityTile& tile,
                         const geometry::Rect& rect, const Window<Colour>& window) {
  const int tile_x = rect.x0 / kTileSize * kTileSize;
  const int tile_y = rect.y0 / kTileSize * kTileSize;
  const auto shade_one = [&](int x, int y) -> bool {
    const int i = (y - tile_y) * kTileSize + (x - tile_x);
    const std::uint32_t number = number_of(tile.key[i]);
    const std::size_t pixel = window.at(x, y);
    window.depth[pixel] = frame.shown_depth(tile.key[i]);
    if (number == kNothing) {
      window.colour[pixel] = {};
      return false;
    }
    shade_pixel(frame, seen, number, x, y, window.colour[pixel]);
    return true;
  };
  std::uint64_t shaded = 0;
  for (int y0 = rect.y0; y0 < rect.y1; y0 += kSquare) {
    for (int x0 = rect.x0; x0 < rect.x1; x0 += kSquare) {
      for (int y = y0; y < std::min(y0 + kSquare, rect.y1); ++y)
        for (int x = x0; x < std::min(x0 + kSquare, rect.x1); ++x) shaded += shade_one(x, y);
    }
  }
  return shaded;
}

template <class Colour>
void clear_pixels(const geometry::Rect& rect, const Window<Colour>& window) {
  for (int y = rect.y0; y < rect.y1; ++y) {
    std::fill_n(window.colour + window.at(rect.x0, y), rect.width(), Colour());
    std::fill_n(window.depth + window.at(rect.x0, y), rect.width(), image::kEmptyDepth);
  }
}

template void shade_pixel(const FrameShading&, SeenTriangles&, std::uint32_t, int, int,
                          image::Rgba8&);
template void shade_pixel(const FrameShading&, SeenTriangles&, std::uint32_t, int, int,
                          image::RgbaF&);
template void clear_pixels(const geometry::Rect&, const Window<image::Rgba8>&);
template void clear_pixels(const geometry::Rect&, const Window<image::RgbaF>&);
template std::uint64_t shade_tile(const FrameShading&, SeenTriangles&, const VisibilityTile&,
                                  const geometry::Rect&, const Window<image::Rgba8>&);
template std::uint64_t shade_tile(const FrameShading&, SeenTriangles&, const VisibilityTile&,
                                  const geometry::Rect&, const Window<image::RgbaF>&);

}  // namespace delray::raster

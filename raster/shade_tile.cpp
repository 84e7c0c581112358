#include "raster/internal/shade_tile.h"

#include <cmath>

#include "image/srgb.h"
#include "shading/shade.h"

namespace delray::raster {
namespace {

glm::vec3 to_viewer(const FrameShading& frame, const glm::vec3& position) {
  const glm::vec3 way = frame.screen.view.eye - position;
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
  const Weights w = weights_at(triangle.barycentrics, x, y);
  const glm::vec3 lit = interpolate(w, triangle.radiance);
  const std::uint32_t texture = triangle.material->base_colour_texture;
  if (texture == scenes::kNone) return lit;
  const glm::vec2 uv = interpolate(w, triangle.uv);
  const shading::Footprint footprint{derivative(w, triangle.barycentrics.a, triangle.uv, uv),
                                     derivative(w, triangle.barycentrics.b, triangle.uv, uv)};
  return lit * glm::vec3(shading::sample(frame.shader.textures[texture], uv, footprint));
}

void store(const glm::vec3& colour, image::RgbaF& pixel) {
  pixel = {colour.x, colour.y, colour.z, 1.0F};
}
void store(const glm::vec3& colour, image::Rgba8& pixel) {
  pixel = {image::encode_srgb(colour.x), image::encode_srgb(colour.y), image::encode_srgb(colour.z),
           255};
}

}  // namespace

FrameShading make_frame_shading(const Screen& screen, const shading::Shader& shader,
                                const DrawList& list, Lighting lighting) {
  FrameShading frame{screen, shader, list, {}, {}, lighting};
  frame.draws.reserve(list.draws.size());
  for (const Draw& draw : list.draws) frame.draws.push_back(make_shaded_draw(screen.view, draw));
  if (lighting == Lighting::gouraud) {
    frame.untextured = shader.materials;
    for (scenes::Material& material : frame.untextured) {
      material.base_colour_texture = scenes::kNone;
      material.metallic_roughness_texture = scenes::kNone;
      material.normal_texture = scenes::kNone;
      material.emission_texture = scenes::kNone;
    }
  }
  return frame;
}

void SeenTriangles::clear() { std::fill_n(numbers_, kSlots, kNothing); }

const SeenTriangle& SeenTriangles::get(const FrameShading& frame, std::uint32_t number) {
  const std::uint32_t slot = number % kSlots;
  SeenTriangle& triangle = triangles_[slot];
  if (numbers_[slot] == number) return triangle;
  numbers_[slot] = number;
  const std::uint32_t draw = frame.list.cluster_of(number).draw;
  triangle = make_seen_triangle(frame.screen, frame.shader, frame.list.draws[draw],
                                frame.draws[draw], frame.list.triangle_of(number));
  if (frame.lighting == Lighting::gouraud) {
    const auto material = triangle.material - frame.shader.materials.data();
    for (int k = 0; k < 3; ++k)
      triangle.radiance[k] = radiance(frame, frame.untextured[material], corner(triangle, k));
  }
  return triangle;
}

bool solid(const FrameShading& frame, SeenTriangles& seen, std::uint32_t number, int x, int y) {
  const SeenTriangle& triangle = seen.get(frame, number);
  const shading::Point point = point_at(triangle, x, y);
  return shading::coverage(frame.shader, *triangle.material, point.uv, point.footprint,
                           point.colour.w) > 0;
}

template <class Colour>
std::uint64_t shade_tile(const FrameShading& frame, SeenTriangles& seen, const VisibilityTile& tile,
                         const geometry::Rect& rect, image::BasicImage<Colour>& image) {
  const int tile_x = rect.x0 / kTileSize * kTileSize;
  const int tile_y = rect.y0 / kTileSize * kTileSize;
  std::uint64_t shaded = 0;
  for (int y = rect.y0; y < rect.y1; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
    for (int x = rect.x0; x < rect.x1; ++x) {
      const int i = (y - tile_y) * kTileSize + (x - tile_x);
      const std::uint32_t number = tile.number[i];
      const std::size_t pixel = row + static_cast<std::size_t>(x);
      image.depth[pixel] = tile.depth[i];
      if (number == kNothing) {
        image.colour[pixel] = {};
        continue;
      }
      ++shaded;
      const SeenTriangle& triangle = seen.get(frame, number);
      store(frame.lighting == Lighting::gouraud
                ? gouraud(frame, triangle, x, y)
                : radiance(frame, *triangle.material, point_at(triangle, x, y)),
            image.colour[pixel]);
    }
  }
  return shaded;
}

template std::uint64_t shade_tile(const FrameShading&, SeenTriangles&, const VisibilityTile&,
                                  const geometry::Rect&, image::Image8&);
template std::uint64_t shade_tile(const FrameShading&, SeenTriangles&, const VisibilityTile&,
                                  const geometry::Rect&, image::ImageF&);

}  // namespace delray::raster

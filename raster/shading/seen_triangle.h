// Triangles that are seen: what shading looks up at their pixels.
#pragma once

#include <vector>

#include "raster/pipeline/draws.h"
#include "raster/pipeline/splat.h"
#include "raster/pipeline/transform.h"
#include "raster/shading/interpolate.h"
#include "shading/shader.h"
#include "shading/surface.h"

namespace delray::raster {

// The values of a draw that shading needs.
struct ShadedDraw {
  ToView to_view;
  glm::mat3 normal_to_world{1.0F};
  float handedness = 1;  // -1 where the transform mirrors
  bool blended = false;  // what is behind may be seen
  SplatDraw splats;      // of points or segments
};
ShadedDraw make_shaded_draw(const scenes::View& view, const Draw& draw);

// A vertex's tangent in the world, with the handedness there.
glm::vec4 tangent_in_world(const Draw& draw, const ShadedDraw& shaded, std::uint32_t vertex);

// A triangle with its vertices' attributes in the world.
struct SeenTriangle {
  Barycentrics barycentrics;  // from the screen where they can be
  const scenes::Material* material = nullptr;
  bool has_uv = false, has_uv2 = false, has_tangent = false, has_colour = false, blended = false;
  bool front = false;                       // the viewer sees the mesh's counter-clockwise side
  bool own_normal[3] = {}, agrees[3] = {};  // of corner k: there is one; see normal_agrees()
  glm::vec3 geometric_normal{0, 0, 1};
  glm::vec3 position[3], normal[3];
  glm::vec4 tangent[3], colour[3];
  glm::vec2 uv[3], uv2[3];
  glm::vec3 radiance[3];  // of the vertices, for Gouraud shading
  // Where the barycentrics are proper: of these, with a fourth value of 1 for positions and
  // radiances, else 0. Those of uv have uv2 beside them.
  ValuePlanes position_planes, normal_planes, tangent_planes, colour_planes, uv_planes;
  ValuePlanes radiance_planes;
};

// Barycentrics of a triangle of a mesh, from its vertices on the screen if all of them are inside.
Barycentrics make_screen_barycentrics(const Screen& screen, const ToView& to_view,
                                      std::span<const glm::vec3> positions,
                                      const glm::uvec3& corners);

// How far a pixel is from the planes' origin, and one over the value of `ones` there.
struct PixelShare {
  float dx = 0, dy = 0, share = 0;
};

// Everything but `radiance` and its planes. `t` is a triangle of the draw's mesh.
SeenTriangle make_seen_triangle(const Screen& screen, const shading::Shader& shader,
                                const Draw& draw, const ShadedDraw& shaded, std::uint32_t t);

// Where a pixel lies in the textures of a set. `ones` are planes with a fourth value of 1.
shading::TexturePoint texture_point(const ValuePlanes& uvs, int set, const ValuePlanes& ones,
                                    const PixelShare& at);
// As texture_point, of a triangle whose shares have to be bounded.
shading::TexturePoint bounded_texture_point(const SeenTriangle& triangle, int set,
                                            const Weights& weights);

// The point of the triangle at a pixel, or its corner k.
shading::Point point_at(const SeenTriangle& triangle, int x, int y);
shading::Point corner(const SeenTriangle& triangle, int k);

}  // namespace delray::raster

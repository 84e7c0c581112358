// Decides for a draw what set-up needs to know: whether alpha cuts holes or blends, which side is
// hidden, and whether cones of normals hold where it is placed. Degenerate: a transform that is
// skew or scales unevenly has no cones, nor has an orthographic view.
#include "raster/pipeline/prepared_draw.h"

#include <algorithm>

#include "shading/surface.h"

namespace delray::raster {
namespace {

// Whether alpha may not be the same all over the mesh.
bool alpha_varies(const shading::Shader& shader, const scenes::Material& material,
                  const scenes::Mesh& mesh) {
  return !mesh.colours.empty() || (material.base_colour_texture != scenes::kNone &&
                                   !shader.textures[material.base_colour_texture].opaque);
}

// Whether alpha may leave nothing of some pixels.
bool may_have_holes(const shading::Shader& shader, const scenes::Material& material,
                    const scenes::Mesh& mesh) {
  if (material.alpha != scenes::Material::Alpha::mask) return false;
  return alpha_varies(shader, material, mesh) || material.base_colour.w < material.alpha_cutoff;
}

// Angles must be the same in the mesh and in the world, or nearly: then cones are used.
void prepare_cones(const scenes::View& view, const glm::mat4x3& transform, PreparedDraw& prepared) {
  if (view.orthographic) return;  // they are for an eye at some distance
  const glm::dmat3 axes{glm::mat3(transform)};
  const double lengths[3] = {glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])};
  const double least = std::min({lengths[0], lengths[1], lengths[2]});
  const double largest = std::max({lengths[0], lengths[1], lengths[2]});
  const double skew =
      std::max({std::abs(glm::dot(axes[0], axes[1])), std::abs(glm::dot(axes[1], axes[2])),
                std::abs(glm::dot(axes[2], axes[0]))});
  if (!(least > 0) || largest > 1.01 * least || skew > 0.01 * least * least) return;
  prepared.cones = true;
  prepared.eye = glm::inverse(axes) * (glm::dvec3(view.eye) - glm::dvec3(transform[3]));
  prepared.scale = static_cast<float>(least);
}

}  // namespace

bool is_blended(const shading::Shader& shader, const scenes::Mesh& mesh) {
  const scenes::Material& material = shading::material(shader, mesh.material);
  if (material.alpha != scenes::Material::Alpha::blend || !mesh.has_triangles()) return false;
  return alpha_varies(shader, material, mesh) || !(material.base_colour.w >= 1.0F);
}

double mean_opacity(const shading::Shader& shader, const scenes::Mesh& mesh) {
  if (!is_blended(shader, mesh)) return 1;
  const scenes::Material& material = shading::material(shader, mesh.material);
  double opacity = std::clamp(static_cast<double>(material.base_colour.w), 0.0, 1.0);
  if (material.base_colour_texture != scenes::kNone) {
    const shading::Texture& texture = shader.textures[material.base_colour_texture];
    opacity *= texture.texels[texture.levels.back().first].a / 255.0;
  }
  return opacity;
}

PreparedDraw prepare_draw(const Screen& screen, const Draw& draw, const shading::Shader& shader,
                          bool cull_single_sided) {
  const scenes::Material& material = shading::material(shader, draw.mesh->material);
  PreparedDraw prepared;
  prepared.draw = &draw;
  prepared.to_view = to_view(screen.view, *draw.transform);
  if (!draw.mesh->has_triangles()) {
    prepared.splats = make_splat_draw(screen, draw);
    return prepared;
  }
  prepared.masked = may_have_holes(shader, material, *draw.mesh);
  prepared.blended = is_blended(shader, *draw.mesh);
  if (!cull_single_sided || material.double_sided) return prepared;
  // Counter-clockwise in the world is a negative area on the screen, where y grows downwards,
  // unless the transform mirrors.
  prepared.hidden_side = glm::determinant(glm::mat3(*draw.transform)) < 0 ? -1 : 1;
  prepare_cones(screen.view, *draw.transform, prepared);
  return prepared;
}

std::vector<PreparedDraw> prepare_draws(const Screen& screen, const DrawList& list,
                                        const shading::Shader& shader, bool cull_single_sided) {
  std::vector<PreparedDraw> draws;
  draws.reserve(list.draws.size());
  for (const Draw& draw : list.draws)
    draws.push_back(prepare_draw(screen, draw, shader, cull_single_sided));
  return draws;
}

}  // namespace delray::raster

// A draw with what setup needs of it.
#pragma once

#include <vector>

#include "raster/pipeline/draws.h"
#include "raster/pipeline/splat.h"
#include "raster/pipeline/transform.h"
#include "shading/shader.h"

namespace delray::raster {

struct PreparedDraw {
  const Draw* draw = nullptr;
  ToView to_view;
  bool masked = false;   // holes are cut by alpha
  bool blended = false;  // what lies behind may shine through
  int hidden_side = 0;   // sign of the area that is not drawn; 0: both are
  // Clusters that show nothing but hidden sides can be told by their cones: in the mesh's
  // coordinates, where the eye is, and how much longer things are in the world.
  bool cones = false;
  glm::vec3 eye{0};
  float scale = 1;
  SplatDraw splats;  // of points or segments; these are neither masked nor blended
};

// Whether what lies behind a mesh of the material may shine through it somewhere.
bool is_blended(const shading::Shader& shader, const scenes::Mesh& mesh);

// How much of what lies behind the mesh it hides, on average over its texture, in [0, 1]; 1 unless
// it is blended. An estimate.
double mean_opacity(const shading::Shader& shader, const scenes::Mesh& mesh);

// Refers to the draw.
PreparedDraw prepare_draw(const Screen& screen, const Draw& draw, const shading::Shader& shader,
                          bool cull_single_sided);
// Element i is draw i of the list, which it refers to. O(draws).
std::vector<PreparedDraw> prepare_draws(const Screen& screen, const DrawList& list,
                                        const shading::Shader& shader, bool cull_single_sided);

}  // namespace delray::raster

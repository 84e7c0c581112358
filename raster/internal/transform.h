// Vertices from a mesh to the screen.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <span>

#include "raster/internal/screen_triangle.h"

namespace delray::raster {

// Rows of the map from a mesh to view coordinates (right, up, forward); the last column is added.
struct ToView {
  glm::vec4 row[3];

  // In this order of operations everywhere, scalar and vector, so that a vertex has one position.
  glm::vec3 operator()(const glm::vec3& p) const {
    glm::vec3 v;
    for (int k = 0; k < 3; ++k)
      v[k] = ((row[k].x * p.x + row[k].y * p.y) + row[k].z * p.z) + row[k].w;
    return v;
  }
};

// Composed in double: eye and origin of a mesh may be far from the world's origin.
ToView to_view(const scenes::View& view, const glm::mat4x3& transform);

// The deepest depth: keeps depth away from 0, whose sign vector units treat differently.
inline constexpr float kDeepest = -std::numeric_limits<float>::min();

// Transforms, projects and snaps to 1/256 pixel. Same size. Runs in the calling thread.
void transform(const ToView& to_view, const Screen& screen, std::span<const glm::vec3> positions,
               std::span<ScreenVertex> vertices);

}  // namespace delray::raster

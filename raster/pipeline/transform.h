// Vertices from a mesh to the screen.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <span>

#include "raster/pipeline/mesh_clusters.h"
#include "raster/pipeline/screen_triangle.h"

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

// The vertices of a cluster, on the screen.
struct ScreenVertices {
  static constexpr std::size_t kPadding = 16;  // vectors may be stored past the end

  alignas(64) std::int32_t x[kClusterVertices + kPadding];
  alignas(64) std::int32_t y[kClusterVertices + kPadding];
  alignas(64) float depth[kClusterVertices + kPadding];
  bool any_outside = false;
  // The least and largest coordinates, if none is outside.
  std::int32_t low_x = 0, high_x = 0, low_y = 0, high_y = 0;
  float farthest = 0;

  ScreenVertex operator[](std::size_t i) const { return {x[i], y[i], depth[i]}; }
};

// Transforms, projects and snaps to 1/256 pixel: element i of the result is positions[which[i]].
// Runs in the calling thread.
//
// REQUIRES: 1 <= which.size() <= kClusterVertices.
void transform(const ToView& to_view, const Screen& screen, std::span<const glm::vec3> positions,
               std::span<const std::uint32_t> which, ScreenVertices& vertices);
// As transform, of all of so many positions.
void transform(const ToView& to_view, const Screen& screen, std::span<const glm::vec3> positions,
               ScreenVertices& vertices);

}  // namespace delray::raster

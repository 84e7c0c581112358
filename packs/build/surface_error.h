// How far two surfaces are apart.
#pragma once

#include <span>
#include <vector>

#include "scenes/scene.h"

namespace delray::packs::internal {

// What simplifying a mesh cost.
struct SurfaceErrors {
  float largest = 0;
  std::vector<float>
      triangles;  // of the simplified mesh: the errors of places on, or nearest to, each
};

// How far places on either mesh are from the nearest one on the other, measured from corners and
// middles of edges and triangles of both, and what lies beneath: `before`
// has, for each triangle of the fine mesh, how far it is from what it was itself made of; empty:
// nothing. Attributes count as further dimensions: where normals, colours or texture coordinates
// there differ by 1, that is as far as `attribute_scale`. O(n log n) for meshes that are much
// alike. The meshes have the same attributes.
SurfaceErrors surface_errors(const scenes::Mesh& fine, std::span<const float> before,
                             const scenes::Mesh& simplified, float attribute_scale);

// The largest error, measured from corners and middles of both.
float surface_error(const scenes::Mesh& a, const scenes::Mesh& b, float attribute_scale);

// The mean length of a mesh's edges.
float mean_edge(const scenes::Mesh& mesh);

}  // namespace delray::packs::internal

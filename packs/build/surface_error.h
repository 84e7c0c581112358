// How far two surfaces are apart.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "scenes/scene.h"

namespace delray::packs::internal {

// A surface that others are measured against.
struct FineSurface {
  const scenes::Mesh& mesh;
  // By triangle: how far it is from what it was itself made of; none: it was not made of anything.
  std::span<const float> before = {};
  // By vertex: whether distances are measured from there, too; none: from all. Others belong to
  // what is beside the simplified surface.
  std::span<const std::uint8_t> measured = {};
};

// How far a simplified mesh is from it.
struct SurfaceErrors {
  float largest = 0;
  std::vector<float>
      triangles;  // of the simplified mesh: the errors of places on, or nearest to, each
  std::vector<std::uint32_t> nearest;  // by vertex that is measured: the triangle that is nearest
  // For each middle of the simplified mesh: its triangle, and the nearest one of the fine mesh.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> beneath;
};

// How far places on either mesh are from the nearest one on the other, and what lies beneath:
// measured from the vertices of the fine mesh, as distances to a triangle are convex, and from the
// middles of edges and triangles of the simplified one, whose vertices are some of the fine ones.
// Attributes count as further dimensions: where normals, colours or texture coordinates there
// differ by 1, that is as far as `attribute_scale`. O(n log n) for meshes that are much alike. The
// meshes have the same attributes.
SurfaceErrors surface_errors(const FineSurface& fine, const scenes::Mesh& simplified,
                             float attribute_scale);

// The largest distance, measured from corners and middles of edges and triangles of both.
float surface_error(const scenes::Mesh& a, const scenes::Mesh& b, float attribute_scale);

// The mean length of a mesh's edges.
float mean_edge(const scenes::Mesh& mesh);

}  // namespace delray::packs::internal

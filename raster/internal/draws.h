// What a rank renders: runs of triangles of meshes placed in the world.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scenes/scene.h"

namespace delray::raster {

// Triangles first .. first + count - 1 of a mesh placed by `transform`; the first has the global
// primitive number `primitive` (scenes::first_primitives), the others follow. Mesh and transform
// are the scene's, or came in a message.
struct Piece {
  const scenes::Mesh* mesh = nullptr;
  const glm::mat4x3* transform = nullptr;
  std::uint32_t first = 0, count = 0;
  std::uint64_t primitive = 0;
};

// The pieces of primitives [begin, end) of the scene, one per instance that has any.
// `first_primitives` is scenes::first_primitives(scene).
std::vector<Piece> pieces_of(const scenes::Scene& scene,
                             std::span<const std::uint64_t> first_primitives, std::uint64_t begin,
                             std::uint64_t end);

// A mesh at a place, and the vertices that its pieces use.
struct Draw {
  const scenes::Mesh* mesh = nullptr;
  const glm::mat4x3* transform = nullptr;
  std::uint32_t first_vertex = 0, vertices = 0;
};

// At most kClusterTriangles consecutive triangles of a draw.
inline constexpr std::uint32_t kClusterBits = 10;
inline constexpr std::uint32_t kClusterTriangles = 1U << kClusterBits;
struct Cluster {
  std::uint32_t draw = 0, first = 0, count = 0;
};

// Draws and clusters in ascending order of primitives. A triangle's number within the list is
// cluster << kClusterBits | place in the cluster: it ascends as primitive numbers do, so that ties
// of depth resolve as they would over the whole scene, and it leads back to the triangle.
struct DrawList {
  std::vector<Draw> draws;
  std::vector<Cluster> clusters;
  std::uint64_t triangles = 0;

  const Cluster& cluster_of(std::uint32_t number) const { return clusters[number >> kClusterBits]; }
  std::uint32_t triangle_of(std::uint32_t number) const {
    return cluster_of(number).first + (number & (kClusterTriangles - 1));
  }
};

// Sorts `pieces` by primitive and cuts them into draws and clusters. O(pieces log pieces +
// triangles of meshes that are drawn in part). Throws std::length_error above 2^32 numbers.
//
// REQUIRES: no primitive is in two pieces.
DrawList make_draw_list(std::vector<Piece> pieces);

}  // namespace delray::raster

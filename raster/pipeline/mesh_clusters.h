// Meshes cut into small clusters of triangles that are skipped, transformed and set up together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "geometry/box.h"
#include "scenes/scene.h"

namespace delray::raster {

// A place in a cluster takes so many bits. Vertices are numbered within the cluster by 8 bits.
inline constexpr std::uint32_t kClusterBits = 7;
inline constexpr std::uint32_t kClusterTriangles = 1U << kClusterBits;
inline constexpr std::uint32_t kClusterVertices = 256;
// Corners are stored for a multiple of so many triangles, so that vectors of them may be loaded.
inline constexpr std::uint32_t kCornerPadding = 16;

// At most kClusterTriangles consecutive triangles with at most kClusterVertices vertices.
struct MeshCluster {
  std::uint32_t first = 0, count = 0;            // triangles of the mesh
  std::uint32_t first_vertex = 0, vertices = 0;  // into ClusterBlock::vertices
  std::uint32_t first_corner = 0;                // into ClusterBlock::corners
  geometry::Box3 box;                            // infinite where a position is not finite
  // Every triangle's normal, of the counter-clockwise side, is within the angle of this sine and
  // cosine around `axis`. No cone: cosine = -1.
  glm::vec3 axis{0, 0, 1};
  float cosine = -1;
  float least_height = 0;  // of all triangles: no two opposite parts of one are closer
  // normal_agrees() at every corner of every triangle; false in a mesh without normals.
  bool normals_agree = false;
  // The mesh's number of its first vertex, where vertices follow each other in the mesh as they do
  // in the cluster; otherwise scenes::kNone.
  std::uint32_t first_in_mesh = scenes::kNone;

  bool consecutive() const { return first_in_mesh != scenes::kNone; }
  // The vertex of the point at place 0, where those of the others follow; otherwise scenes::kNone.
  std::uint32_t vertex_of_place_0() const {
    return vertices == count ? first_in_mesh : scenes::kNone;
  }

  // From one corner's array to the next.
  std::uint32_t corner_stride() const {
    return (count + kCornerPadding - 1) / kCornerPadding * kCornerPadding;
  }
};

// Whether a corner's own normal is on the counter-clockwise side of the triangle; `edges` is the
// cross product of two edges. In the mesh's coordinates, so that it is the same wherever the mesh
// is.
inline glm::vec3 cross_of_edges(const scenes::Mesh& mesh, const glm::uvec3& corners) {
  const glm::vec3& p = mesh.positions[corners.x];
  return glm::cross(mesh.positions[corners.y] - p, mesh.positions[corners.z] - p);
}
inline bool normal_agrees(const scenes::Mesh& mesh, std::uint32_t corner, const glm::vec3& edges) {
  return glm::dot(mesh.normals[corner], edges) >= 0;
}

// The first, where each is one more than the one before; otherwise, and of none, scenes::kNone.
std::uint32_t first_of_consecutive(std::span<const std::uint32_t> vertices);

// The clusters of up to kBlockTriangles consecutive triangles of a mesh, ascending.
struct ClusterBlock {
  std::vector<MeshCluster> clusters;
  std::vector<std::uint32_t> vertices;  // of the mesh; in clusters' order
  std::vector<std::uint8_t> corners;    // first corners of a cluster's triangles, second, third
  geometry::Box3 box;

  std::span<const std::uint32_t> vertices_of(const MeshCluster& cluster) const {
    return std::span(vertices).subspan(cluster.first_vertex, cluster.vertices);
  }
};
// Which of the block's clusters has the triangle. REQUIRES: the block has it.
inline std::uint32_t part_with(const ClusterBlock& block, std::uint32_t triangle) {
  const auto after = std::upper_bound(
      block.clusters.begin(), block.clusters.end(), triangle,
      [](std::uint32_t t, const MeshCluster& cluster) { return t < cluster.first; });
  return static_cast<std::uint32_t>(after - block.clusters.begin()) - 1;
}

inline constexpr std::uint32_t kBlockBits = 16;
inline constexpr std::uint32_t kBlockTriangles = 1U << kBlockBits;

// Block k has triangles from k << kBlockBits on; null where it was not asked for yet. Where
// clusters begin depends on the mesh alone.
struct MeshClusters {
  std::vector<std::unique_ptr<ClusterBlock>> blocks;

  // Makes the blocks of triangles [first, first + count) that are missing. O(triangles), parallel.
  void make(const scenes::Mesh& mesh, std::uint32_t first, std::uint32_t count);
};

// Clusters of a scene's meshes, made when they are first needed.
class SceneClusters {
 public:
  explicit SceneClusters(std::span<const scenes::Mesh> meshes)
      : meshes_(meshes), clusters_(meshes.size()) {}

  // Null for meshes that are not the scene's.
  MeshClusters* of(const scenes::Mesh& mesh) {
    const bool known = &mesh >= meshes_.data() && &mesh < meshes_.data() + meshes_.size();
    return known ? &clusters_[static_cast<std::size_t>(&mesh - meshes_.data())] : nullptr;
  }
  // The vertices of mesh number `mesh` have moved: its clusters are made anew when they are needed.
  // Draw lists that have some of them are void.
  void forget(std::uint32_t mesh) { clusters_[mesh].blocks.clear(); }

 private:
  std::span<const scenes::Mesh> meshes_;
  std::vector<MeshClusters> clusters_;
};

}  // namespace delray::raster

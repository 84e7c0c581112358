// The geometry that a rank renders: runs of triangles of meshes placed in the world.
#pragma once

#include <cstdint>
#include <deque>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "raster/pipeline/mesh_clusters.h"
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
  MeshClusters* clusters = nullptr;  // of the mesh, where it is not the scene's
};

// The pieces of primitives [begin, end) of the scene, one per instance that has any.
// `first_primitives` is scenes::first_primitives(scene).
std::vector<Piece> pieces_of(const scenes::Scene& scene,
                             std::span<const std::uint64_t> first_primitives, std::uint64_t begin,
                             std::uint64_t end);

// A mesh at a place.
struct Draw {
  const scenes::Mesh* mesh = nullptr;
  const glm::mat4x3* transform = nullptr;
  MeshClusters* clusters = nullptr;
  // Of the mesh's vertices, where another rank has lit them for gouraud.
  const std::vector<glm::vec3>* radiances = nullptr;
  // What is added to the radius of points that stand for others, in its units.
  float widening = 0;
};

// Places [begin, end) of a cluster of a draw's mesh.
struct Cluster {
  std::uint32_t draw = 0;
  std::uint32_t first = 0;  // triangle of the mesh at place 0
  std::uint32_t part = 0;   // number of the cluster in its block
  std::uint16_t begin = 0, end = 0;
  std::uint64_t primitive = 0;  // global number of the triangle at place 0
  // Of points: MeshCluster::vertex_of_place_0().
  std::uint32_t first_vertex = scenes::kNone;
};

// Keeps the meshes of draws in memory while somebody looks at them, where not all are at all times.
class MeshHolder {
 public:
  virtual ~MeshHolder() = default;
  // Until they are released as often, these draws have their meshes and clusters. Any thread.
  // Throws FileError where they cannot be read.
  virtual void hold(std::span<const std::uint32_t> draws) = 0;
  virtual void release(std::span<const std::uint32_t> draws) = 0;
  // Whether draws that were held once stay in memory to the end of the frame, whether released or
  // not.
  virtual bool keeps_all() const = 0;
  // Nothing that is held now or later will be held again in this frame.
  virtual void need_not_keep() = 0;
};

// Holds draws, each once, for as long as this and the vector live, which is sorted. Without a
// holder nothing happens.
class HeldDraws {
 public:
  HeldDraws(MeshHolder* holder, std::vector<std::uint32_t>& draws);
  ~HeldDraws();
  HeldDraws(const HeldDraws&) = delete;
  HeldDraws& operator=(const HeldDraws&) = delete;

 private:
  MeshHolder* const holder_;
  const std::vector<std::uint32_t>& draws_;
};

// Draws and clusters in ascending order of primitives. A triangle's number within the list is
// cluster << kClusterBits | place in the cluster: it ascends as primitive numbers do, so that ties
// of depth resolve as they would over the whole scene, and it leads back to the triangle.
struct DrawList {
  std::vector<Draw> draws;
  std::vector<Cluster> clusters;
  std::uint64_t triangles = 0;
  std::deque<MeshClusters> own;  // of meshes that came in messages
  // Of draws that have their meshes only while they are held: others have one without triangles, of
  // the same material and attributes. Null: all have theirs.
  MeshHolder* holder = nullptr;

  const Cluster& cluster_of(std::uint32_t number) const { return clusters[number >> kClusterBits]; }
  std::uint32_t triangle_of(std::uint32_t number) const {
    return cluster_of(number).first + (number & (kClusterTriangles - 1));
  }
  std::uint64_t primitive_of(std::uint32_t number) const {
    return cluster_of(number).primitive + (number & (kClusterTriangles - 1));
  }
  const ClusterBlock& block_of(const Cluster& cluster) const {
    return *draws[cluster.draw].clusters->blocks[cluster.first >> kBlockBits];
  }
};

// Sorts `pieces` by primitive and cuts them into draws and clusters; those of meshes that `known`
// does not have are made anew. O(pieces log pieces + clusters) once the meshes' clusters are made.
// Throws std::length_error above 2^32 numbers.
//
// REQUIRES: no primitive is in two pieces.
DrawList make_draw_list(std::vector<Piece> pieces, SceneClusters* known = nullptr);

// The primitives of numbers of the list, as often as they are given, ascending. By counting,
// cluster by cluster: O(clusters + numbers log of those that a cluster has).
std::vector<std::uint64_t> primitives_of(const DrawList& list,
                                         std::span<const std::uint32_t> numbers);

}  // namespace delray::raster

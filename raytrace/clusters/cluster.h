// A cluster: a piece of a scene's geometry that belongs to one rank, may travel whole, and can be
// traced on its own. The unit of scenes that are distributed over ranks (Badouel et al. 1990; Wald
// et al. 2001 call it a voxel).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "comm/buffer.h"
#include "geometry/box.h"
#include "raytrace/scene/embree_scene.h"
#include "raytrace/scene/geometry_instance.h"
#include "raytrace/scene/opaque_triangles.h"

namespace delray::raytrace {

// Triangles of one mesh with the vertices that they use, and what they are in the whole scene.
struct Piece {
  scenes::Mesh mesh;  // positions moved to the world where the mesh is placed once
  std::vector<std::uint32_t> triangles;  // element i: number of triangle i in its mesh
  std::vector<std::uint32_t> instances;  // numbers of the instances that place it
};

// Geometry alone: what travels.
struct ClusterData {
  std::vector<Piece> pieces;
  std::vector<GeometryInstance> instances;  // of all pieces, piece by piece; pointers are not set
  // Where opaque triangles that are placed once count, as other clusters have the rest of those
  // that reach beyond it; empty: everywhere. Does not travel: boxes_of() is all that looks at it.
  geometry::Box3 clip = {};

  std::uint64_t triangles() const;
  std::uint64_t bytes() const;  // of the arrays
};

// Boxes around all that is placed: one for each instance of an instanced piece, and one for each
// few hundred triangles of the others, so that they are tight; a little larger, for what rounding
// does to a ray.
std::vector<geometry::Box3> boxes_of(const ClusterData& cluster);

comm::Buffer pack(const ClusterData& cluster);
ClusterData unpack_cluster(std::span<const std::byte> message);

// Geometry with what rays need to know of it, but no acceleration structure. Immutable.
class Cluster {
 public:
  // `alphas`: least_alphas() of the shader. O(triangles of materials that can be seen through).
  Cluster(ClusterData&& data, const shading::Shader& shader, std::span<const LeastAlpha> alphas);
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  const ClusterData& data() const { return data_; }
  std::span<const GeometryInstance> instances() const { return data_.instances; }
  // Element i: what instance i and its triangles are in the whole scene.
  std::span<const GeometryNumbers> numbers() const { return numbers_; }
  std::uint64_t triangles() const { return data_.triangles(); }
  std::uint64_t bytes() const { return bytes_; }

 private:
  ClusterData data_;
  std::vector<GeometryNumbers> numbers_;
  std::uint64_t bytes_ = 0;
};

// Cuts the triangles [begin, end) of a scene, meshes placed several times counted once, into
// clusters of at most `most` triangles: in halves along the longest side of the box of their
// centres, those of meshes placed several times for themselves. The numbers of the triangles in
// their meshes go up by first_triangle. O(n log n). REQUIRES: most >= 1.
std::vector<ClusterData> cut_clusters(std::span<const GeometryInstance> instances,
                                      std::uint64_t begin, std::uint64_t end, std::uint32_t most,
                                      std::uint32_t first_triangle = 0);

// How many triangles there are in that sense.
std::uint64_t stored_triangles(std::span<const GeometryInstance> instances);

}  // namespace delray::raytrace

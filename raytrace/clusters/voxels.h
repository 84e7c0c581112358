// Space in equal voxels, dealt to ranks at random (Jevans 1989), as units that travel packed (Wald
// et al. 2001).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "comm/communicator.h"
#include "geometry/box.h"
#include "raytrace/clusters/cluster.h"

namespace delray::raytrace {

// Cubes that cover a box, x first. The same on all ranks.
struct VoxelGrid {
  glm::dvec3 low{0.0};
  double side = 1.0;
  glm::ivec3 cells{1};

  std::uint32_t count() const {
    return static_cast<std::uint32_t>(cells.x) * static_cast<std::uint32_t>(cells.y) *
           static_cast<std::uint32_t>(cells.z);
  }
  // The one that a point lies in, or is next to; that of a point that is no number is any.
  glm::ivec3 cell_of(const glm::vec3& point) const;
  std::uint32_t number(const glm::ivec3& cell) const;
  // With what rounding may make of a triangle at its border.
  geometry::Box3 box(std::uint32_t number) const;
};

// Voxels for so many triangles on so many ranks: surfaces take some 64 a rank, but of no fewer than
// 64 triangles on the average. `bounds` may be empty.
VoxelGrid voxel_grid(const geometry::Box3& bounds, std::uint64_t triangles, int ranks);

// Whether a triangle, clipped to the box, has a point left (Sutherland and Hodgman 1974). True in
// doubt.
bool reaches_into(const glm::vec3 (&corners)[3], const geometry::Box3& box);

// A voxel's part of some triangles.
struct Voxel {
  std::uint32_t number = 0;  // in the grid; instanced meshes have numbers behind those
  ClusterData data;
};

// The triangles [begin, end) of a scene, as cut_clusters() counts them. Opaque ones go into each
// voxel that they reach into, and count there as far as they do (ClusterData::clip). What can be
// seen through must not be met twice, and is in the voxel of its centre alone, as are points and
// triangles that are never hit. Meshes placed several times are clusters of at most `most`
// triangles each. O(n log n + voxels of each triangle's box).
std::vector<Voxel> cut_voxels(std::span<const GeometryInstance> instances, std::uint64_t begin,
                              std::uint64_t end, const VoxelGrid& grid, std::uint32_t most,
                              std::uint32_t first_triangle = 0);

// Collective. Each voxel with all that any rank has of it, on a rank that a hash of seed and number
// chooses: those of this rank, by number.
std::vector<ClusterData> deal_voxels(comm::Communicator& communicator, std::vector<Voxel>&& mine,
                                     const VoxelGrid& grid, std::uint64_t seed);

}  // namespace delray::raytrace

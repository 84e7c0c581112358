// Triangles on their way into clusters: what cutting by halves and cutting by voxels have in
// common.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "raytrace/clusters/cluster.h"

namespace delray::raytrace {

struct ClusterItem {
  glm::vec3 centre;
  std::uint32_t instance, triangle;  // triangle: in the instance's mesh as it is at hand
};

// The first instance of each mesh that is placed several times, and where the others are.
using PlacedMeshes = std::unordered_map<std::uint32_t, std::vector<std::uint32_t>>;
PlacedMeshes placed_meshes(std::span<const GeometryInstance> instances);

// The triangles [begin, end) of a scene, meshes placed several times counted once: visit(items,
// instanced) gets all that are placed once together, at last, and those of each other mesh apart.
// The visitor may reorder them.
template <class Visit>
void for_cluster_items(std::span<const GeometryInstance> instances, const PlacedMeshes& placed,
                       std::uint64_t begin, std::uint64_t end, Visit&& visit);

// Items as a cluster, which gets the vertices that its triangles use, renumbered; sorts the items.
// The numbers of the triangles in their meshes go up by first_triangle.
ClusterData cluster_of_items(std::span<ClusterItem> items,
                             std::span<const GeometryInstance> instances,
                             const PlacedMeshes& placed, std::uint32_t first_triangle);

// Whether its triangles count: each mesh that is placed several times counts once.
bool is_stored(std::span<const GeometryInstance> instances, const PlacedMeshes& placed,
               std::uint32_t i);
glm::vec3 centre_of(const GeometryInstance& instance, std::uint32_t triangle);

template <class Visit>
void for_cluster_items(std::span<const GeometryInstance> instances, const PlacedMeshes& placed,
                       std::uint64_t begin, std::uint64_t end, Visit&& visit) {
  std::vector<ClusterItem> once, own;
  std::uint64_t first = 0;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    if (!is_stored(instances, placed, i)) continue;
    const std::uint64_t count = instances[i].mesh->triangles.size();
    std::vector<ClusterItem>& items = instances[i].instanced ? own : once;
    const std::uint64_t low = begin > first ? begin : first;
    const std::uint64_t high = end < first + count ? end : first + count;
    for (std::uint64_t t = low; t < high; ++t) {
      const auto triangle = static_cast<std::uint32_t>(t - first);
      items.push_back({centre_of(instances[i], triangle), i, triangle});
    }
    first += count;
    visit(std::span<ClusterItem>(own), true);
    own.clear();
  }
  visit(std::span<ClusterItem>(once), false);
}

}  // namespace delray::raytrace

// Lines up the instances of clusters, one cluster after the other, and has Embree build over all of
// them. Hits are decided by the numbers that instances and triangles have in the whole scene, so
// that it does not matter which clusters lie in one scene.
#include "raytrace/distributed/cluster_scene.h"

#include <utility>

namespace delray::raytrace {

ClusterScene::ClusterScene(std::vector<std::shared_ptr<const Cluster>> clusters,
                           const BuildOptions& options, const EmbreeDevice& device)
    : clusters_(std::move(clusters)) {
  std::uint32_t meshes = 0;
  std::uint64_t bytes = 0;
  for (const std::shared_ptr<const Cluster>& cluster : clusters_) {
    for (GeometryInstance instance : cluster->instances()) {
      instance.mesh_number += meshes;
      instances_.push_back(std::move(instance));
    }
    numbers_.insert(numbers_.end(), cluster->numbers().begin(), cluster->numbers().end());
    meshes += static_cast<std::uint32_t>(cluster->data().pieces.size());
    triangles_ += cluster->triangles();
    bytes += cluster->bytes();
  }
  large_ = is_large(bytes);
  embree_ = std::make_unique<EmbreeScene>(instances_, options, device, numbers_);
}

}  // namespace delray::raytrace

// Lines up the instances of clusters and has Embree build over all of them. Hits are decided by the
// numbers that instances and triangles have in the whole scene, so that it does not matter which
// clusters lie in one scene, nor in what order.
//
// Clusters that come take the places of instances that have gone. Degenerate: a scene of no
// clusters is met by no ray.
#include "raytrace/distributed/cluster_scene.h"

#include <unordered_set>
#include <utility>

namespace delray::raytrace {

ClusterScene::ClusterScene(std::vector<std::shared_ptr<const Cluster>> clusters,
                           const BuildOptions& options, const EmbreeDevice& device)
    : embree_({}, options, device) {
  change(std::move(clusters));
}

void ClusterScene::change(std::vector<std::shared_ptr<const Cluster>> clusters) {
  std::unordered_set<const Cluster*> wanted, known;
  for (const std::shared_ptr<const Cluster>& cluster : clusters) wanted.insert(cluster.get());
  std::vector<std::uint32_t> changed;
  std::erase_if(parts_, [&](const Part& part) {
    if (wanted.contains(part.cluster.get())) {
      known.insert(part.cluster.get());
      return false;
    }
    for (const std::uint32_t i : part.instances) instances_[i] = {};
    changed.insert(changed.end(), part.instances.begin(), part.instances.end());
    return true;
  });
  free_.insert(free_.end(), changed.begin(), changed.end());
  std::uint64_t bytes = 0;
  for (std::shared_ptr<const Cluster>& cluster : clusters) {
    bytes += cluster->bytes();
    if (known.contains(cluster.get())) continue;
    add(std::move(cluster));
    const std::vector<std::uint32_t>& added = parts_.back().instances;
    changed.insert(changed.end(), added.begin(), added.end());
  }
  large_ = is_large(bytes);
  embree_.change(changed, instances_, numbers_);
}

void ClusterScene::add(std::shared_ptr<const Cluster> cluster) {
  Part& part = parts_.emplace_back();
  const std::span<const GeometryInstance> instances = cluster->instances();
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (free_.empty()) {
      free_.push_back(static_cast<std::uint32_t>(instances_.size()));
      instances_.emplace_back();
      numbers_.emplace_back();
    }
    const std::uint32_t at = free_.back();
    free_.pop_back();
    part.instances.push_back(at);
    instances_[at] = instances[i];
    numbers_[at] = cluster->numbers()[i];
    // Pieces of one mesh are placed by the same instances: it has the number of the first.
    const Piece& piece = cluster->data().pieces[instances[i].mesh_number];
    instances_[at].mesh_number = piece.instances.front();
  }
  part.cluster = std::move(cluster);
}

}  // namespace delray::raytrace
